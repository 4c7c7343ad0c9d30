#include "core/complementarity/require.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace touchstone::require {

namespace {

template <typename Value>
void check(bool holds, std::string_view field, Value value, const std::string& bound) {
  if (!holds) throw std::invalid_argument(fmt::format("{} = {}: must be {}", field, value, bound));
}

}  // namespace

void positive(std::string_view field, double value) {
  check(value > 0.0 && std::isfinite(value), field, value, "> 0 and finite");
}

void not_negative(std::string_view field, double value) {
  check(value >= 0.0 && std::isfinite(value), field, value, ">= 0 and finite");
}

void in_left_open(std::string_view field, double value, double low, double high) {
  check(value > low && value <= high, field, value, fmt::format("in ({}, {}]", low, high));
}

void in_closed(std::string_view field, double value, double low, double high) {
  check(value >= low && value <= high, field, value, fmt::format("in [{}, {}]", low, high));
}

void at_least(std::string_view field, int value, int low) {
  check(value >= low, field, value, fmt::format(">= {}", low));
}

void in_closed(std::string_view field, int value, int low, int high) {
  check(value >= low && value <= high, field, value, fmt::format("in [{}, {}]", low, high));
}

}  // namespace touchstone::require
