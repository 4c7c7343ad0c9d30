#pragma once

#include <string_view>

namespace touchstone::conformance {

/// How a method moves a free body over a step, exactly.
enum class FreeFlight {
  velocity_first,  ///< v' = v + h g, x' = x + h v'
  position_first,  ///< x' = x + h v, v' = v + h g
  parabola,        ///< x' = x + h v + h^2 g / 2
};

/// What is known of a method and bounds how exactly it can be asked. The defaults are a rigid formulation in
/// double precision; whatever asks for less says why in traits.cpp.
struct Traits {
  FreeFlight free_flight = FreeFlight::velocity_first;
  double rounding = 1e-11;       ///< relative, of velocities and positions without contact
  double contact_speed = 1e-6;   ///< by how much velocities of single contacts may be off [m/s]
  double slip_speed = 2e-6;      ///< as contact_speed, while a contact slips [m/s]
  double contact_depth = 1e-6;   ///< by how far a resting body may settle or rise [m]
  double flat_speed = 1e-5;      ///< as contact_speed, of bodies that rest on more than one point
  double flat_depth = 1e-5;      ///< as contact_depth, of bodies that rest on more than one point
  double settling_speed = 1e-5;  ///< as flat_speed, in the first 0.25 s
  double joint_gap = 1e-6;       ///< by how far a joint's anchors may come apart [m]
  double impulse = 1e-9;         ///< relative error of the momentum balance with the contact impulses
};

/// The traits of the method `key`.
Traits traits_of(std::string_view key);

}  // namespace touchstone::conformance
