#pragma once

#include <span>

#include "baselines/registry.h"

/// The rows that the engines add to the table of methods. To add an engine: its .cpp with a function of rows,
/// its line in engines.cmake, its line in engines.cpp.
namespace touchstone::engines {

/// The methods of one library. A spatial engine's methods run planar scenes too, by extrusion, under the same
/// keys.
struct Rows {
  std::span<const MethodEntry<2>> planar;
  std::span<const MethodEntry<3>> spatial;
};

/// The engines of this build, by name.
std::span<const Rows> all_rows();

// One function an engine; those of an engine that is not installed are not defined.
Rows box2d_rows();
Rows bullet_rows();
Rows chipmunk_rows();
Rows dart_rows();
Rows mujoco_rows();
Rows ode_rows();
Rows siconos_rows();
Rows simbody_rows();

}  // namespace touchstone::engines
