#pragma once

#include <string_view>

namespace touchstone::require {

// Checks of options. Each throws std::invalid_argument "<struct>.<field> = <value>: must be <bound>" unless
// the bound holds; NaN never passes. Defined for the validate() of options aggregates.

void positive(std::string_view field, double value);
void not_negative(std::string_view field, double value);
/// low < value <= high
void in_left_open(std::string_view field, double value, double low, double high);
/// low <= value <= high
void in_closed(std::string_view field, double value, double low, double high);
void at_least(std::string_view field, int value, int low);
void in_closed(std::string_view field, int value, int low, int high);

}  // namespace touchstone::require
