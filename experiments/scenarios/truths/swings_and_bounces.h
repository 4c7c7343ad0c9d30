#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/scenarios/truths/gauss_legendre.h"

/// Periods and impact laws in closed form or as one quadrature. SI units.
namespace touchstone::truth {

/// Period [s] of theta'' = -(g / length) sin(theta) with the amplitude
/// theta0 in [0, pi) [rad]: 4 sqrt(length/g) K(sin(theta0/2)). For a physical
/// pendulum length = I_pivot / (m d), d from the pivot to the centre of mass.
inline double pendulum_period(double length, double gravity, double theta0) {
  return 4.0 * std::sqrt(length / gravity) * std::comp_ellint_1(std::sin(0.5 * theta0));
}

/// A round body (shape factor b = I/(m r^2)) that rolls without slip in the plane
/// inside a round bowl; theta is the angle of the centre from the lowest position.
/// (1 + b) (R - r) theta'' = -g sin(theta): a pendulum of length (1 + b)(R - r).
struct Bowl {
  double bowl_radius = 2.0;   ///< R > r [m]
  double ball_radius = 0.5;   ///< r > 0 [m]
  double shape_factor = 0.4;  ///< b > 0
  double gravity = 9.81;

  [[nodiscard]] double period(double theta0) const {
    return pendulum_period((1.0 + shape_factor) * (bowl_radius - ball_radius), gravity, theta0);
  }
  /// Least mu for rolling throughout: largest at the turning point, where the centre has no speed.
  [[nodiscard]] double needed_friction(double theta0) const {
    return shape_factor / (1.0 + shape_factor) * std::tan(theta0);
  }
};

/// An ellipse that rocks without slip on a plane about its long side, 0 < b < a (b is
/// vertical at rest). With the height of the centre H(phi) = sqrt(a^2 sin^2 + b^2 cos^2)
/// and the contact at H' beside it, rolling gives the energy integral
///   phi'^2 = 2 m g (H(phi0) - H(phi)) / (I + m (H^2 + H'^2)).
struct RockingEllipse {
  double a = 2.0, b = 1.0;  ///< semi-axes [m]
  double mass = 1.0;        ///< > 0 [kg]
  double inertia = 1.25;    ///< about the centre [kg m^2]: uniform cylinder m (a^2 + b^2)/4, ellipsoid ... /5
  double gravity = 9.81;    ///< > 0 [m/s^2]

  [[nodiscard]] double height(double phi) const { return std::hypot(a * std::sin(phi), b * std::cos(phi)); }

  /// |phi'| at phi when the amplitude is phi0 >= |phi| [rad/s].
  [[nodiscard]] double speed(double phi, double phi0) const {
    // H(phi0) - H(phi) = (a^2 - b^2)(sin^2 phi0 - sin^2 phi) / (H(phi0) + H(phi)), free of cancellation.
    const double drop =
        (a * a - b * b) * std::sin(phi0 - phi) * std::sin(phi0 + phi) / (height(phi0) + height(phi));
    const double h = height(phi);
    const double offset = (a * a - b * b) * std::sin(phi) * std::cos(phi) / h;
    return std::sqrt(2.0 * mass * gravity * drop / (inertia + mass * (h * h + offset * offset)));
  }

  /// For small amplitudes: omega^2 = m g ((a^2 - b^2)/b) / (I + m b^2).
  [[nodiscard]] double small_period() const {
    const double stiffness = mass * gravity * (a * a - b * b) / b;
    return 2.0 * std::numbers::pi * std::sqrt((inertia + mass * b * b) / stiffness);
  }

  /// For the amplitude phi0 in (0, pi/2): four times the quadrature of d phi / phi', with phi = phi0 sin u.
  [[nodiscard]] double period(double phi0) const {
    const auto slowness = [&](double u) { return phi0 * std::cos(u) / speed(phi0 * std::sin(u), phi0); };
    return 4.0 * quadrature(slowness, 0.0, 0.5 * std::numbers::pi, 8);
  }
};

/// A ball dropped from rest with its gap `height` > 0 above the ground, with restitution e in [0, 1).
struct BouncingBall {
  double height = 1.0;       ///< of the gap [m]
  double restitution = 0.5;  ///< e
  double gravity = 9.81;

  [[nodiscard]] double first_impact() const { return std::sqrt(2.0 * height / gravity); }
  /// Gap at the apex after n impacts: e^(2n) h.
  [[nodiscard]] double apex(int impacts) const { return std::pow(restitution, 2 * impacts) * height; }
  /// Time of impact number n >= 1: t1 (1 + 2 (e + ... + e^(n-1))).
  [[nodiscard]] double impact_time(int n) const {
    const double e = restitution;
    return first_impact() * (1.0 + 2.0 * e * (1.0 - std::pow(e, n - 1)) / (1.0 - e));
  }
  /// All the infinitely many bounces are over: t1 (1 + e)/(1 - e).
  [[nodiscard]] double rest_time() const {
    return first_impact() * (1.0 + restitution) / (1.0 - restitution);
  }

  /// Gap at time t >= 0 [m].
  [[nodiscard]] double gap(double t) const {
    const double t1 = first_impact();
    if (t < t1) return height - 0.5 * gravity * t * t;
    if (t >= rest_time()) return 0.0;
    double start = t1;
    double duration = 2.0 * restitution * t1;  // of the flight after the first impact
    while (t >= start + duration && duration > 0.0) start += duration, duration *= restitution;
    return 0.5 * gravity * (t - start) * (duration - (t - start));
  }
};

/// A uniform block (base b, height h, standing) that rocks from one edge to the
/// other with plastic impacts (Housner). Angular momentum about the new edge is
/// kept: omega+/omega- = 1 - (3/2) sin^2(alpha), tan(alpha) = b/h.
struct RockingBlock {
  double base = 1.0, height = 2.0;  ///< > 0 [m]

  [[nodiscard]] double sin2_alpha() const { return base * base / (base * base + height * height); }
  /// Positive, so that the old edge lifts, iff sin^2(alpha) < 2/3.
  [[nodiscard]] double impact_ratio() const { return 1.0 - 1.5 * sin2_alpha(); }
  /// Least mu for which the impulse at the new edge sticks: (h/b)(1 - r)/(1 + r) = 3 b h / (b^2 + 4 h^2).
  [[nodiscard]] double needed_friction() const {
    return 3.0 * base * height / (base * base + 4.0 * height * height);
  }
};

}  // namespace touchstone::truth
