#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/scenarios/truths/gauss_legendre.h"

namespace touchstone::truth {

/// A round body on a horizontal plane that slips in one direction and spins about the vertical, under
/// the friction ellipsoid. SI units. With sigma = sqrt(e_t^2 v^2 + e_r^2 w^2), v slip and w spin,
///   v' = -(1 + 1/b) mu g e_t^2 v / sigma,   w' = -(mu m g e_r^2 / I) w / sigma,
/// so that in the variable s with dt = sigma ds both fall exponentially, and both end at the same time.
struct SpinAndSlide {
  double mass = 1.0;          ///< > 0 [kg]
  double shape_factor = 0.4;  ///< b = I / (m r^2), about a horizontal axis, > 0
  double spin_inertia = 0.4;  ///< about the vertical, > 0 [kg m^2]
  double friction = 0.2;      ///< > 0
  double e_t = 1.0;           ///< > 0
  double e_r = 0.3;           ///< > 0 [m]
  double gravity = 9.81;      ///< > 0 [m/s^2]
  double slip = 1.0;          ///< of the contact point, at t = 0 [m/s]
  double spin = 1.0;          ///< about the vertical, at t = 0 [rad/s]

  struct State {
    double slip = 0.0, spin = 0.0;
  };

  [[nodiscard]] State at_s(double s) const {
    return {slip * std::exp(-slip_rate() * s), spin * std::exp(-spin_rate() * s)};
  }

  /// t(s), by quadrature of sigma.
  [[nodiscard]] double time_at(double s) const {
    const auto sigma_at = [this](double x) { return sigma(at_s(x)); };
    const double fastest = std::max(slip_rate(), spin_rate());
    return quadrature(sigma_at, 0.0, s, 1 + static_cast<int>(fastest * s));
  }

  /// When both are zero [s]. The neglected tail is e^-40 of it.
  [[nodiscard]] double end_time() const { return time_at(40.0 / std::min(slip_rate(), spin_rate())); }

  /// Slip and spin at time t [s], to about 1e-13; zero from end_time() on.
  [[nodiscard]] State at(double t) const {
    if (t >= end_time()) return {};
    double low = 0.0, high = 40.0 / std::min(slip_rate(), spin_rate());
    double s = 0.0;
    // Newton on t(s), whose slope sigma falls: it approaches
    // from below, and bisection is there for the last digits.
    for (int iteration = 0; iteration < 200 && high - low > 4e-16 * high; ++iteration) {
      const double error = time_at(s) - t;
      (error > 0.0 ? high : low) = s;
      const double newton = s - error / sigma(at_s(s));
      if (newton == s) break;
      s = newton > low && newton < high ? newton : 0.5 * (low + high);
    }
    return at_s(s);
  }

 private:
  [[nodiscard]] double slip_rate() const {
    return (1.0 + 1.0 / shape_factor) * friction * gravity * e_t * e_t;
  }
  [[nodiscard]] double spin_rate() const { return friction * mass * gravity * e_r * e_r / spin_inertia; }
  [[nodiscard]] double sigma(const State& state) const {
    return std::hypot(e_t * state.slip, e_r * state.spin);
  }
};

}  // namespace touchstone::truth
