// Are periods and impact laws right? Oracles: the equation of motion integrated
// to its turning points, limits, and impulses worked out from momentum.
#include "experiments/scenarios/truths/swings_and_bounces.h"

#include <gtest/gtest.h>

#include <complex>

#include "experiments/scenarios/truths/ode.h"

namespace touchstone::truth {
namespace {

constexpr double pi = std::numbers::pi;
using Angle = OdeVector<2>;

/// Time from rest at phi0 > 0 to the first crossing of zero, four times: the period of a symmetric swing.
template <class Acceleration>
double integrated_period(double phi0, const Acceleration& acceleration) {
  const auto field = [&](double, const Angle& y) -> Angle { return {y[1], acceleration(y[0], y[1])}; };
  const auto events = [](double, const Angle& y) { return std::array{y[0]}; };
  const auto ignore = [](const DenseStep<2>&, double) {};
  const auto at = integrate<2, 1>(field, 0.0, {phi0, 0.0}, 1e3, events, {true}, ignore);
  EXPECT_EQ(at.status, OdeStatus::event);
  return 4.0 * at.t;
}

TEST(Pendulum, PeriodIsTheIntegratedOne) {
  for (const double theta0 : {0.01, 1.0, 2.5, 3.1}) {
    const double integrated =
        integrated_period(theta0, [](double q, double) { return -9.81 / 0.7 * std::sin(q); });
    EXPECT_NEAR(pendulum_period(0.7, 9.81, theta0), integrated, 1e-12 * integrated);
  }
  EXPECT_NEAR(pendulum_period(1.0, 9.81, 1e-6), 2.0 * pi / std::sqrt(9.81), 1e-11);
}

TEST(Bowl, SmallPeriodsAreTheKnownOnes) {
  const Bowl ball;
  EXPECT_NEAR(ball.period(1e-5), 2.0 * pi * std::sqrt(7.0 * 1.5 / (5.0 * 9.81)), 1e-9);
  const Bowl disc{.shape_factor = 0.5};
  EXPECT_NEAR(disc.period(1e-5), 2.0 * pi * std::sqrt(3.0 * 1.5 / (2.0 * 9.81)), 1e-9);
  EXPECT_NEAR(ball.needed_friction(0.5), 2.0 / 7.0 * std::tan(0.5), 1e-15);
}

TEST(Bowl, EnergyGivesTheSamePeriod) {
  // (1/2)(1 + b) v^2 with v = (R - r) theta', by quadrature with sin(theta/2) = sin(theta0/2) sin(u).
  const Bowl bowl;
  const double theta0 = 1.2, k = std::sin(0.5 * theta0);
  const auto slowness = [&](double u) {
    const double s = k * std::sin(u);
    const double rate = std::sqrt(2.0 * 9.81 / (1.4 * 1.5) * 2.0 * (k * k - s * s));  // theta'
    return 2.0 * k * std::cos(u) / std::sqrt(1.0 - s * s) / rate;
  };
  EXPECT_NEAR(bowl.period(theta0), 4.0 * quadrature(slowness, 0.0, 0.5 * pi, 4), 1e-12);
}

TEST(RockingEllipse, PeriodIsTheIntegratedOne) {
  const RockingEllipse ellipse;
  // Lagrange's equation of M(phi) phi'^2 / 2 + m g H(phi), its derivatives by complex steps.
  using Complex = std::complex<double>;
  const auto height = [](Complex p) {
    return std::sqrt(4.0 * std::sin(p) * std::sin(p) + std::cos(p) * std::cos(p));
  };
  const auto mass = [&](Complex p) {
    const Complex offset = 3.0 * std::sin(p) * std::cos(p) / height(p);
    return 1.25 + height(p) * height(p) + offset * offset;
  };
  const auto slope = [](const auto& f, double p) { return f(Complex(p, 1e-30)).imag() / 1e-30; };
  const auto acceleration = [&](double p, double rate) {
    return -(0.5 * slope(mass, p) * rate * rate + 9.81 * slope(height, p)) / mass(p).real();
  };
  for (const double phi0 : {0.05, 0.4, 1.2}) {
    EXPECT_NEAR(ellipse.period(phi0), integrated_period(phi0, acceleration), 1e-11) << phi0;
  }
}

TEST(RockingEllipse, SmallAmplitudesHaveTheSmallPeriodToSecondOrder) {
  const RockingEllipse ellipse;
  const double coarse = ellipse.period(0.02) / ellipse.small_period() - 1.0;
  const double fine = ellipse.period(0.01) / ellipse.small_period() - 1.0;
  EXPECT_LT(std::abs(fine), 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.05);
}

TEST(BouncingBall, AgreesWithBounceByBounce) {
  const BouncingBall ball{.height = 1.3, .restitution = 0.7};
  double t = ball.first_impact();
  double speed = 9.81 * t;
  for (int n = 1; n < 30; ++n) {
    EXPECT_NEAR(ball.impact_time(n), t, 1e-13);
    EXPECT_NEAR(ball.gap(t), 0.0, 1e-13);
    speed *= 0.7;
    EXPECT_NEAR(ball.apex(n), speed * speed / (2.0 * 9.81), 1e-14);
    EXPECT_NEAR(ball.gap(t + speed / 9.81), ball.apex(n), 1e-13);
    t += 2.0 * speed / 9.81;
  }
  EXPECT_NEAR(ball.rest_time(), ball.impact_time(200), 1e-13);
  EXPECT_EQ(ball.gap(ball.rest_time() + 1.0), 0.0);
  EXPECT_NEAR(ball.gap(0.0), 1.3, 1e-15);
  EXPECT_EQ(BouncingBall{.restitution = 0.0}.gap(5.0), 0.0);
}

TEST(RockingBlock, RatioAndFrictionFollowFromMomentum) {
  const RockingBlock block{.base = 1.0, .height = 3.0};
  const double b = 1.0, h = 3.0, inertia = (b * b + h * h) / 12.0;  // m = 1, edges at (0, 0) and (b, 0)
  // Before: about the old edge (0, 0) clockwise at 1 rad/s; centre at (b/2, h/2) moves with (h/2,
  // -b/2). After: about the new edge (b, 0); centre at (-b/2, h/2) from it moves with (h/2, b/2) omega.
  const double before = inertia + h / 2.0 * h / 2.0 - b / 2.0 * b / 2.0;  // clockwise, about the new edge
  const double after = inertia + (b * b + h * h) / 4.0;
  const double r = before / after;
  EXPECT_NEAR(block.impact_ratio(), r, 1e-15);
  const double impulse_x = h / 2.0 * r - h / 2.0, impulse_y = b / 2.0 * r + b / 2.0;
  EXPECT_NEAR(block.needed_friction(), std::abs(impulse_x) / impulse_y, 1e-15);
  EXPECT_NEAR(RockingBlock({.base = std::sqrt(2.0), .height = 1.0}).impact_ratio(), 0.0, 1e-15);
}

}  // namespace
}  // namespace touchstone::truth
