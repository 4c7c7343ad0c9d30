#pragma once

#include <cmath>

#include "experiments/scenarios/truths/require.h"

/// A sphere that spins in place about the contact normal on a plane, held
/// back by torsional friction alone. With no slip the friction ellipsoid
/// leaves a torsional moment of at most mu p_n e_r, p_n = m g. SI units.
namespace touchstone::truth {

struct SpinningSphere {
  double mass = 1.0;      ///< > 0 [kg]
  double inertia = 0.4;   ///< > 0, about the normal [kg m^2]
  double friction = 0.2;  ///< mu >= 0
  double e_r = 0.4;       ///< >= 0 [m]
  double gravity = 9.81;  ///< > 0 [m/s^2]
  double omega = 1.962;   ///< spin at t = 0, of either sign [rad/s]

  /// Largest torsional moment, mu m g e_r [N m].
  [[nodiscard]] double full_moment() const { return friction * mass * gravity * e_r; }
  /// Rate at which |omega| falls while it is not zero [rad/s^2].
  [[nodiscard]] double deceleration() const { return full_moment() / inertia; }
  /// When the spin stops [s]; infinite without friction.
  [[nodiscard]] double stop_time() const { return std::abs(omega) / deceleration(); }
};

/// Spin about the normal [rad/s] at time t >= 0 [s]: linear to zero, then zero.
inline double spin_at(const SpinningSphere& sphere, double t) {
  const double left = std::abs(sphere.omega) - sphere.deceleration() * t;
  return left > 0.0 ? std::copysign(left, sphere.omega) : 0.0;
}

struct SpinStep {
  double omega = 0.0;   ///< at the end of the step [rad/s]
  double moment = 0.0;  ///< mean torsional moment during the step, p_r / h, about the normal [N m]
};

/// What an implicit step of h [s] gives after step number `step` >= 1, exactly: |omega|
/// falls by mu m g e_r h / I in each step that leaves it positive; the step that would pass
/// zero ends at exactly 0, with only the moment that takes (friction at the end of the step
/// is then inside the ellipsoid), and the moment is zero after that.
/// @throws std::invalid_argument if h <= 0 or step < 1
inline SpinStep spin_after_steps(const SpinningSphere& sphere, double h, int step) {
  require(h > 0.0, "h", h, "> 0");
  require(step >= 1, "step", step, ">= 1");
  const double fall = sphere.deceleration() * h;
  const double before = std::abs(sphere.omega) - fall * (step - 1);
  if (before <= 0.0) return {};
  if (before <= fall) return {0.0, -std::copysign(sphere.inertia * before / h, sphere.omega)};
  return {std::copysign(before - fall, sphere.omega), -std::copysign(sphere.full_moment(), sphere.omega)};
}

}  // namespace touchstone::truth
