// Is the spinning sphere's truth the paper's, and the discrete
// one the solution of the step's own optimisation problem?
#include "experiments/scenarios/truths/sphere_spin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace touchstone::truth {
namespace {

TEST(SphereSpin, IsThePaperExample) {
  const SpinningSphere sphere;
  EXPECT_NEAR(sphere.deceleration(), 1.962, 1e-15);
  EXPECT_NEAR(sphere.stop_time(), 1.0, 1e-15);
  EXPECT_NEAR(spin_at(sphere, 0.25), 0.75 * 1.962, 1e-15);
  EXPECT_EQ(spin_at(sphere, 1.5), 0.0);
  EXPECT_EQ(spin_after_steps(sphere, 0.07, 15).omega, 0.0);  // 1.05 s
  EXPECT_GT(spin_after_steps(sphere, 0.07, 14).omega, 0.0);
  EXPECT_NEAR(spin_after_steps(sphere, 0.07, 15).moment, -0.4 * (1.962 - 14 * 1.962 * 0.07) / 0.07, 1e-14);
}

TEST(SphereSpin, LosesExactlyItsAngularMomentum) {
  const SpinningSphere sphere{.inertia = 0.3, .friction = 0.7, .omega = -5.0};
  const double h = 0.013;
  double momentum = sphere.inertia * sphere.omega;
  for (int k = 1; k <= 400; ++k) {
    const SpinStep step = spin_after_steps(sphere, h, k);
    momentum += h * step.moment;
    EXPECT_NEAR(momentum, sphere.inertia * step.omega, 1e-13);
  }
  EXPECT_EQ(spin_after_steps(sphere, h, 400).omega, 0.0);
}

TEST(SphereSpin, StepSolvesMaximumDissipation) {
  // The end-of-step law: omega' minimises I (omega' - omega)^2 / 2 + h
  // M |omega'|. Golden-section search, no case split.
  const SpinningSphere sphere{.omega = 0.9};
  const double h = 0.1;
  double omega = sphere.omega;
  for (int k = 1; k <= 7; ++k) {
    double a = -2.0, b = 2.0;
    const auto cost = [&](double w) {
      return 0.5 * sphere.inertia * (w - omega) * (w - omega) + h * sphere.full_moment() * std::abs(w);
    };
    for (int i = 0; i < 90; ++i) {
      const double left = b - 0.618033988749895 * (b - a), right = a + 0.618033988749895 * (b - a);
      (cost(left) < cost(right) ? b : a) = cost(left) < cost(right) ? right : left;
    }
    omega = 0.5 * (a + b);
    EXPECT_NEAR(spin_after_steps(sphere, h, k).omega, omega, 1e-7) << k;
  }
}

TEST(SphereSpin, StepsAreExactAtTheirEnds) {
  const SpinningSphere
      sphere;  // the fall is linear, so that a step of any size ends on the continuous solution
  for (const double h : {0.07, 0.007}) {
    for (int k = 1; k * h < 2.0; ++k) {
      EXPECT_NEAR(spin_after_steps(sphere, h, k).omega, spin_at(sphere, h * k), 1e-14) << h << ' ' << k;
    }
  }
}

TEST(SphereSpin, WithoutTorsionSpinsOn) {
  const SpinningSphere sphere{.e_r = 0.0};
  EXPECT_EQ(spin_at(sphere, 100.0), 1.962);
  EXPECT_EQ(spin_after_steps(sphere, 0.1, 1000).omega, 1.962);
  EXPECT_EQ(sphere.stop_time(), std::numeric_limits<double>::infinity());
}

TEST(SphereSpin, RefusesBadSteps) {
  EXPECT_THROW((void)spin_after_steps({}, 0.0, 1), std::invalid_argument);
  EXPECT_THROW((void)spin_after_steps({}, 0.1, 0), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::truth
