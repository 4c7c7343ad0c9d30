// Does the extrapolation of two runs at h and h/2 make a first-order method one of second order, where does
// it stop doing so, and is its own estimate of the error to be believed? Truths are high-accuracy
// integrations of the smooth motion and a closed form.
#include <algorithm>
#include <cmath>

#include "tests/order/scenes.h"

namespace touchstone::order {
namespace {

constexpr const char* kExtrapolated = "implicit_ncp_extrapolated";
constexpr const char* kPlain = "implicit_ncp";
constexpr const char* kLcp = "stewart_trinkle";
constexpr const char* kLcpExtrapolated = "stewart_trinkle_extrapolated";

/// Largest error of v [m/s] or omega [rad/s] at the times of the truth's samples.
template <typename Samples>
double largest_velocity_error(const std::vector<BodyState<3>>& states, const Samples& samples) {
  EXPECT_EQ(states.size(), samples.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(states.size(), samples.size()); ++i) {
    largest = std::max(largest, (states[i].velocity.template head<3>() - samples[i].velocity).norm());
    largest = std::max(largest, (states[i].velocity.template tail<3>() - samples[i].omega).norm());
  }
  return largest;
}

// --- the sphere on two spheres: stick, slip from 2.94 s, separations at 3.21 s and 3.70 s

const std::vector<double> kSphereTimes = {2, 2.5, 3.5, 4};

double sphere_error(const char* method, double h) {
  static const auto truth = truth::roll_on_spheres({}, kSphereTimes);
  EXPECT_EQ(truth.status, truth::SphereOnSpheresStatus::completed);
  const double error = largest_velocity_error(
      run(method, scene_of(truth::SphereOnSpheres{}, Balls::spheres), h, kSphereTimes), truth.samples);
  std::printf("%-30s h = %-6g largest velocity error %.2e\n", method, h, error);
  return error;
}

TEST(ExtrapolatedSphereOnSpheres, IsOfSecondOrderThroughStickSlipAndSeparation) {
  const double coarse = sphere_error(kExtrapolated, 0.02);
  const double fine = sphere_error(kExtrapolated, 0.01);
  EXPECT_LE(coarse, 5e-3);
  EXPECT_LE(fine, 5e-3);
  EXPECT_GE(coarse / fine, 3) << "4 in theory";
}

TEST(ExtrapolatedSphereOnSpheres, ThePlainMethodFailsThat) {
  const double coarse = sphere_error(kPlain, 0.02);
  const double fine = sphere_error(kPlain, 0.01);
  EXPECT_GT(fine, 5e-3);
  EXPECT_LT(coarse / fine, 3) << "2 in theory";
}

// What the pyramid does to friction does not depend on h, and what does not fall with h cannot be
// extrapolated away.
TEST(ExtrapolatedSphereOnSpheres, TheLcpFailsItAndGainsNothingFromExtrapolation) {
  for (const double h : {0.02, 0.01}) {
    const double plain = sphere_error(kLcp, h);
    const double extrapolated = sphere_error(kLcpExtrapolated, h);
    EXPECT_GT(plain, 5e-3);
    EXPECT_GT(extrapolated, 5e-3);
    EXPECT_NEAR(extrapolated / plain, 1, 0.1);
  }
}

// --- an ellipsoid that rolls on a plane without slip

double ellipsoid_error(const char* method, double h) {
  const std::vector<double> times = {0.5, 1, 1.5, 2};
  static const auto truth = truth::roll_ellipsoid(rolling_ellipsoid(), times);
  EXPECT_EQ(truth.status, truth::EllipsoidStatus::completed);
  const double error =
      largest_velocity_error(run(method, scene_of(rolling_ellipsoid()), h, times), truth.samples);
  std::printf("%-30s h = %-6g largest velocity error %.2e\n", method, h, error);
  return error;
}

double observed_order(const char* method) {
  return std::log2(ellipsoid_error(method, 0.005) / ellipsoid_error(method, 0.0025));
}

TEST(ExtrapolatedEllipsoid, IsOfSecondOrder) { EXPECT_GE(observed_order(kExtrapolated), 1.8); }

TEST(ExtrapolatedEllipsoid, ThePlainMethodsFailThat) {
  EXPECT_NEAR(observed_order(kPlain), 1, 0.2);
  EXPECT_NEAR(observed_order(kLcp), 1, 0.2);
}

// The frozen geometry is no obstacle where friction is stick alone: the LCP's error is then clean too.
TEST(ExtrapolatedEllipsoid, TheLcpGainsAnOrderToo) { EXPECT_GE(observed_order(kLcpExtrapolated), 1.8); }

// --- where it stops: an impact

/// A solid ball thrown flat onto rough ground: from the impact on it rolls at 5/7 of its speed. Error of how
/// far it gets, the largest over many heights so that the impact falls anywhere in a step [m].
double error_after_impact(const char* method, double h) {
  constexpr double kGravity = 9.81;
  constexpr double kSpeed = 2.0;
  constexpr double kUntil = 1.0;  // all have landed
  constexpr int kHeights = 40;
  double largest = 0;
  for (int i = 0; i < kHeights; ++i) {
    const double height = 0.5 + 0.01 * i;
    Scene<3> scene;
    scene.gravity = {0, 0, -kGravity};
    scene.contact_law.mu = 1.0;
    Body<3> ball{.name = "ball"};
    ball.inertia = 0.4 * Inertia<3>::Identity();
    ball.pose.position = {0, 0, 1 + height};
    ball.velocity[0] = kSpeed;
    ball.shape.geometry = Sphere<3>{1.0};
    Body<3> ground{.name = "ground", .fixed = true};
    ground.shape.geometry = HalfSpace<3>{};
    scene.bodies = {ball, ground};
    const double landing = std::sqrt(2 * height / kGravity);
    const double truth = kSpeed * landing + 5.0 / 7.0 * kSpeed * (kUntil - landing);
    largest = std::max(largest, std::abs(run(method, scene, h, {kUntil}).at(0).pose.position[0] - truth));
  }
  std::printf("%-30s h = %-6g largest error after an impact %.2e m\n", method, h, largest);
  return largest;
}

TEST(ExtrapolationLimits, AfterAnImpactTheOrderIsOneAgain) {
  const double plain = error_after_impact(kPlain, 0.01);
  const double coarse = error_after_impact(kExtrapolated, 0.01);
  const double fine = error_after_impact(kExtrapolated, 0.005);
  EXPECT_LT(std::log2(coarse / fine), 1.5);
  EXPECT_GT(coarse, 0.5 * plain)
      << "two runs that land at other places of their steps have nothing in common";
}

// --- the estimate

TEST(ExtrapolationEstimate, IsTheErrorOfTheFineRunWhereExtrapolationWorks) {
  const double h = 0.01;
  const auto truth = truth::roll_on_spheres({}, kSphereTimes);
  const auto method =
      find_method<3>(kExtrapolated).make(scene_of(truth::SphereOnSpheres{}, Balls::spheres), {});
  long k = 0;
  for (std::size_t i = 0; i < kSphereTimes.size(); ++i) {
    for (; k < std::lround(kSphereTimes[i] / h); ++k) ASSERT_EQ(method->step(h).status, StepStatus::solved);
    const StateError<3>& estimate = method->error_estimate()[0];
    const BodyState<3>& combined = method->state()[0];
    const auto& t = truth.samples[i];
    // x_f = x - (x_f - x_c): what the fine run has.
    const auto check = [&](const Vector<3>& value, const Vector<3>& error, const Vector<3>& exact) {
      const double actual = (value - error - exact).norm();
      EXPECT_NEAR(error.norm() / actual, 1, 0.1) << "t = " << t.t;
      EXPECT_LT((value - exact).norm(), error.norm()) << "a cautious bound of the combination's; t = " << t.t;
    };
    check(combined.velocity.head<3>(), estimate.velocity.head<3>(), t.velocity);
    check(combined.velocity.tail<3>(), estimate.velocity.tail<3>(), t.omega);
    check(combined.pose.position, estimate.position, t.position);
    const Eigen::AngleAxisd off(combined.pose.rotation.quaternion() * t.orientation.conjugate());
    EXPECT_LT(std::abs(off.angle()), 0.1 * estimate.turn.norm()) << "t = " << t.t;
  }
}

}  // namespace
}  // namespace touchstone::order
