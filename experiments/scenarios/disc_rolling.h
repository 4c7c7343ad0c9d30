#pragma once

#include "core/model/scene.h"

/// Example 1 of the paper: a uniform disc that rolls on a horizontal support, Eqs. 12-18 and Fig. 1.
namespace touchstone {

/// The paper's values. At t = 0 the disc touches the ground at the origin and rolls without slip.
struct DiscRolling {
  double mass = 1.0;              ///< [kg]
  double inertia = 0.5;           ///< about the centre [kg m^2]; a uniform disc of unit radius
  double radius = 1.0;            ///< [m]
  double mu = 0.4;                ///< nothing slips, so the truth does not depend on it
  double gravity = 9.81;          ///< along -y [m/s^2]
  double angular_velocity = 3.0;  ///< counter-clockwise [rad/s], so the centre moves along -x

  /// (m R^2 + I) omega^2 / 2, for ever [J].
  [[nodiscard]] double kinetic_energy() const {
    return 0.5 * (mass * radius * radius + inertia) * angular_velocity * angular_velocity;
  }
};

/// Bodies "disc" and "ground", a half-space with normal (0, 1) through the origin.
Scene<2> disc_rolling_scene(const DiscRolling& parameters = {});

}  // namespace touchstone
