#pragma once

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace touchstone::truth {

/// @throws std::invalid_argument "<field> = <value>, must be <bound>" unless `holds`
inline void require(bool holds, const char* field, double value, const char* bound) {
  if (holds) return;
  std::ostringstream message;
  message << field << " = " << value << ", must be " << bound;
  throw std::invalid_argument(message.str());
}

/// @throws std::invalid_argument with `message` unless `holds`
inline void require(bool holds, const char* message) {
  if (!holds) throw std::invalid_argument(message);
}

/// @throws std::invalid_argument unless the times to report at, [s], increase from 0 or later
inline void require_increasing(const std::vector<double>& times) {
  require(std::is_sorted(times.begin(), times.end()), "times must increase");
  if (!times.empty()) require(times.front() >= 0.0, "times[0]", times.front(), ">= 0");
}

}  // namespace touchstone::truth
