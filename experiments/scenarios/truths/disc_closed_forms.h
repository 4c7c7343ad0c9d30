#pragma once

#include <cmath>
#include <numbers>

/// The disc that rolls without slip on a plane, and in closed form what two
/// approximations of it lose. SI units. Shorthand: beta = m R^2 / (I + m R^2), the
/// share of the kinetic energy that is translation (2/3 for I = m R^2 / 2).
namespace touchstone::truth {

struct RollingDisc {
  double mass = 1.0;      ///< > 0 [kg]
  double inertia = 0.5;   ///< > 0, about the centre [kg m^2]
  double radius = 1.0;    ///< > 0 [m]
  double gravity = 9.81;  ///< > 0 [m/s^2]
  double omega = 3.0;     ///< at t = 0, of either sign [rad/s]

  [[nodiscard]] double translation_share() const {
    return mass * radius * radius / (inertia + mass * radius * radius);
  }
  /// The disc itself keeps this for ever [J].
  [[nodiscard]] double kinetic_energy() const {
    return 0.5 * (inertia + mass * radius * radius) * omega * omega;
  }
};

/// Kinetic energy [J] at time t [s] of a rigid regular polygon of `edges` vertices
/// on the disc's rim, with the disc's mass and inertia, that sticks at every vertex.
///
/// Each impact scales omega by r = (I + m R^2 cos(2 pi/N)) / (I + m R^2) = 1 - beta (1 - cos(2 pi/N)), and
/// with the swing of gravity within a step averaged out there are N omega / (2 pi) impacts a second. Then
/// 1/omega grows by (1/r - 1)/omega in a time 2 pi / (N omega): LINEARLY in time, at the rate
///   N (1/r - 1) / (2 pi) = pi beta / N + O(N^-3),
/// so that KE = KE0 / (1 + pi beta omega0 t / N)^2, for the paper's disc KE0 / (1 + 2 pi omega0 t / (3 N))^2.
///
/// Conditions: omega0^2 >> (g/R)(pi/N)^2 (far from stopping on an edge), no slip, no
/// lift-off. Error O(N^-2): the impacts are discrete (relative 2 beta pi^2 / N^2
/// each) and gravity swings KE by m g R (1 - cos(pi/N)) within a step.
inline double edge_limited_kinetic_energy(const RollingDisc& disc, int edges, double t) {
  const double slowing = std::numbers::pi * disc.translation_share() * std::abs(disc.omega) * t / edges;
  return disc.kinetic_energy() / ((1.0 + slowing) * (1.0 + slowing));
}

/// Kinetic energy [J] at time t [s] of a disc that is stepped with h [s] and a gap linearised at the start
/// of the step, every point of its rim being a contact candidate (a polygon with 2 pi / N << omega h).
///
/// The point at the angle phi ahead of the lowest one must satisfy psi + h psi' >= 0 with
/// psi = d + R phi^2 / 2 and psi' = -R omega phi (d the height gained, small angles, no
/// vertical velocity). The tightest point is phi = omega h, which lifts the disc by d = R
/// (omega h)^2 / 2 and carries its weight a distance R omega h ahead of the centre: a braking
/// moment m g R omega h. Rolling with that, (I + m R^2) omega' = -m g R omega h, so
///   omega = omega0 exp(-beta g h t / R),  KE = KE0 exp(-2 beta g h t / R);
/// for the paper's disc KE0 exp(-(4/3) g h t / R).
///
/// Conditions: 2 pi / N << omega h << 1, no slip (friction carries the rolling),
/// steady riding height. Relative error of the exponent O((omega h)^2 + g h^2/R).
/// The edge-limited loss is the larger one for omega h < 2 pi / N.
inline double step_limited_kinetic_energy(const RollingDisc& disc, double h, double t) {
  return disc.kinetic_energy() *
         std::exp(-2.0 * disc.translation_share() * disc.gravity * h * t / disc.radius);
}

}  // namespace touchstone::truth
