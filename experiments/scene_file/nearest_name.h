#pragma once

#include <span>
#include <string_view>

namespace touchstone::scene_file {

/// The one of `known` that `typed` was most probably meant to be: with the fewest letters inserted, deleted,
/// replaced or swapped with their neighbour, and no more than half of the longer name's. Empty if none is
/// that near.
std::string_view nearest_name(std::string_view typed, std::span<const std::string_view> known);

}  // namespace touchstone::scene_file
