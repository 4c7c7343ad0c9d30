// Is the slider-crank's one-angle ODE right? Oracles: energy, the joints' geometry, and the
// acceleration from the bodies' own equations with all six constraints and their forces.
#include "experiments/scenarios/truths/slider_crank.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace touchstone::truth {
namespace {

SliderCrank example() {
  SliderCrank m;
  m.crank_mass = 1.3, m.rod_mass = 0.7, m.slider_mass = 2.0;
  m.theta = 0.4, m.theta_rate = 5.0;
  return m;
}

std::vector<double> grid(double end, int intervals) {
  std::vector<double> times;
  for (int i = 0; i <= intervals; ++i) times.push_back(end * i / intervals);
  return times;
}

TEST(SliderCrank, KeepsItsEnergyAndItsJoints) {
  const SliderCrank m = example();
  const auto states = run_slider_crank(m, grid(10.0, 400));
  for (const SliderCrankState& s : states) {
    EXPECT_NEAR(s.energy, states.front().energy, 1e-11);
    const Eigen::Vector2d pin = m.crank_length * Eigen::Vector2d(std::cos(s.theta), std::sin(s.theta));
    EXPECT_NEAR((s.slider - pin).norm(), m.rod_length, 1e-14);
    EXPECT_NEAR(s.slider.y(), 0.0, 1e-15);
    EXPECT_LT((s.rod_center - 0.5 * (pin + s.slider)).norm(), 1e-14);
    EXPECT_LT((s.crank_center - 0.5 * pin).norm(), 1e-15);
    EXPECT_NEAR(std::tan(s.phi), -pin.y() / (s.slider.x() - pin.x()), 1e-13);
  }
}

/// theta'' from seven coordinates (crank x, y, angle; rod x,
/// y, angle; slider x) and six constraints with multipliers.
double acceleration_in_full_coordinates(const SliderCrank& m, const SliderCrankState& s) {
  const double l1 = m.crank_length, l2 = m.rod_length;
  const double ct = std::cos(s.theta), st = std::sin(s.theta), cp = std::cos(s.phi), sp = std::sin(s.phi);
  Eigen::Matrix<double, 6, 7> j = Eigen::Matrix<double, 6, 7>::Zero();
  Eigen::Matrix<double, 6, 1> drift;  // J' q', from the centripetal terms
  const double w = s.theta_rate * s.theta_rate, p = s.phi_rate * s.phi_rate;
  // crank centre - (l1/2) crank direction = 0
  j(0, 0) = 1, j(0, 2) = 0.5 * l1 * st, j(1, 1) = 1, j(1, 2) = -0.5 * l1 * ct;
  drift.segment<2>(0) = 0.5 * l1 * w * Eigen::Vector2d(ct, st);
  // rod centre - (l2/2) rod direction - l1 crank direction = 0
  j(2, 3) = 1, j(2, 5) = 0.5 * l2 * sp, j(2, 2) = l1 * st;
  j(3, 4) = 1, j(3, 5) = -0.5 * l2 * cp, j(3, 2) = -l1 * ct;
  drift.segment<2>(2) = 0.5 * l2 * p * Eigen::Vector2d(cp, sp) + l1 * w * Eigen::Vector2d(ct, st);
  // rod centre + (l2/2) rod direction - (slider, 0) = 0
  j(4, 3) = 1, j(4, 5) = -0.5 * l2 * sp, j(4, 6) = -1, j(5, 4) = 1, j(5, 5) = 0.5 * l2 * cp;
  drift.segment<2>(4) = -0.5 * l2 * p * Eigen::Vector2d(cp, sp);
  Eigen::Matrix<double, 13, 13> kkt = Eigen::Matrix<double, 13, 13>::Zero();
  Eigen::Matrix<double, 7, 1> masses;
  masses << m.crank_mass, m.crank_mass, m.crank_inertia, m.rod_mass, m.rod_mass, m.rod_inertia, m.slider_mass;
  kkt.topLeftCorner<7, 7>() = masses.asDiagonal();
  kkt.topRightCorner<7, 6>() = j.transpose();
  kkt.bottomLeftCorner<6, 7>() = j;
  Eigen::Matrix<double, 13, 1> right = Eigen::Matrix<double, 13, 1>::Zero();
  right[1] = -m.crank_mass * m.gravity, right[4] = -m.rod_mass * m.gravity;
  right.tail<6>() = -drift;
  return kkt.fullPivLu().solve(right)[2];
}

TEST(SliderCrank, AccelerationIsThatOfTheConstrainedBodies) {
  const SliderCrank m = example();
  const double h = 2e-4;
  for (const double t : {0.2, 0.7, 1.3, 2.9}) {
    const auto s = run_slider_crank(m, {t - 2 * h, t - h, t, t + h, t + 2 * h});
    const double slope =
        (8.0 * (s[3].theta_rate - s[1].theta_rate) - (s[4].theta_rate - s[0].theta_rate)) / (12.0 * h);
    EXPECT_NEAR(slope, acceleration_in_full_coordinates(m, s[2]), 1e-7) << t;
    const double velocity =
        (8.0 * (s[3].slider.x() - s[1].slider.x()) - (s[4].slider.x() - s[0].slider.x())) / (12.0 * h);
    EXPECT_NEAR(velocity, s[2].slider_velocity, 1e-7);
  }
}

TEST(SliderCrank, WithoutRodAndSliderIsAPendulum) {
  // Crank hanging down, all else massless: small swings of a bar about its end, T = 2 pi sqrt(2 l / (3 g)).
  SliderCrank m;
  m.rod_mass = m.slider_mass = 1e-12, m.rod_inertia = 0.0;
  m.theta = -0.5 * std::numbers::pi + 1e-4;
  const double period = 2.0 * std::numbers::pi * std::sqrt(2.0 * m.crank_length / (3.0 * 9.81));
  const auto s = run_slider_crank(m, {0.5 * period, period});
  EXPECT_NEAR(s[0].theta, -0.5 * std::numbers::pi - 1e-4, 1e-10);
  EXPECT_NEAR(s[1].theta, m.theta, 1e-10);
}

TEST(SliderCrank, RefusesBadInput) {
  SliderCrank m;
  m.rod_length = 0.2;
  EXPECT_THROW(run_slider_crank(m, {1.0}), std::invalid_argument);
  m = {};
  m.slider_mass = 0.0;
  EXPECT_THROW(run_slider_crank(m, {1.0}), std::invalid_argument);
  m = {};
  m.rod_inertia = -1.0;
  EXPECT_THROW(run_slider_crank(m, {1.0}), std::invalid_argument);
  m = {};
  m.crank_length = 0.0;
  EXPECT_THROW(run_slider_crank(m, {1.0}), std::invalid_argument);
  EXPECT_THROW(run_slider_crank({}, {1.0, 0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::truth
