#pragma once

#include <span>

#include "baselines/registry.h"

/// The rows that the engines add to the table of methods. To add an engine: its .cpp, which defines
/// Rows NAME_rows(), and its row in engines.cmake, from which the list of engines is made.
namespace touchstone::engines {

/// The methods of one library. A spatial engine's methods run planar scenes too, by extrusion, under the same
/// keys.
struct Rows {
  std::span<const MethodEntry<2>> planar;
  std::span<const MethodEntry<3>> spatial;
};

/// The engines of this build.
std::span<const Rows> all_rows();

}  // namespace touchstone::engines
