#pragma once

#include <Eigen/Dense>
#include <vector>

namespace touchstone::truth {

/// A slider-crank in a vertical plane, x to the right, y up, gravity along -y, no friction. SI units.
///
/// The crank turns about the origin at the angle theta from +x; its pin is at l1 (cos theta, sin
/// theta). The rod joins the pin to the slider, which moves on the x axis: at x = l1 cos theta + l2 cos
/// phi, where l1 sin theta + l2 sin phi = 0 and phi, the rod's angle as seen from the pin to the
/// slider, is in (-pi/2, pi/2). Centres of mass are at the middles of crank and rod.
struct SliderCrank {
  double crank_length = 0.3, rod_length = 1.0;  ///< 0 < l1 < l2 [m]
  double crank_mass = 1.0, rod_mass = 1.0, slider_mass = 1.0;
  double crank_inertia = 0.3 * 0.3 / 12.0,
         rod_inertia = 1.0 / 12.0;  ///< about the centres; uniform bars [kg m^2]
  double gravity = 9.81;
  double theta = 0.0, theta_rate = 0.0;  ///< at t = 0 [rad], [rad/s]

  /// @throws std::invalid_argument naming the field and the bound
  void validate() const;
};

struct SliderCrankState {
  double t = 0.0;
  double theta = 0.0, theta_rate = 0.0;  ///< [rad] (not wrapped), [rad/s]
  double phi = 0.0, phi_rate = 0.0;      ///< of the rod
  Eigen::Vector2d crank_center, rod_center, slider;
  double slider_velocity = 0.0;
  double energy = 0.0;  ///< kinetic + potential [J]: constant
};

/// The motion at `times` ([s], increasing, >= 0), from the ODE in the one angle,
///   J(theta) theta'' + J'(theta) theta'^2 / 2 + V'(theta) = 0,
/// where J theta'^2 / 2 is the kinetic energy of all three bodies and V the potential energy. To 1e-12.
std::vector<SliderCrankState> run_slider_crank(const SliderCrank& mechanism,
                                               const std::vector<double>& times);

}  // namespace touchstone::truth
