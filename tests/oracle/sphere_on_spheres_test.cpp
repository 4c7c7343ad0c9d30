// Example 3 of the paper against an event-driven integration of the same laws: order of the error, events,
// and each contact's law. The order test fails for a method with another friction law.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/harness/method_case.h"
#include "experiments/harness/motion_error.h"
#include "experiments/scenarios/ball_history.h"
#include "experiments/scenarios/sphere_on_spheres.h"

namespace touchstone {
namespace {

using harness::CaseRun;
using harness::ReportedErrors;

const std::vector<double> kTimes = {2, 2.5, 3.5, 4};  // [s]
constexpr const char* kStory = "1 slides, 2 rolls; 2 slides; 1 separates; 2 separates";

const truth::SphereOnSpheresResult& event_driven() {
  static const truth::SphereOnSpheresResult result = truth::roll_on_spheres({}, kTimes);
  return result;
}

std::optional<harness::TrueMotion> true_motion(double t) {
  for (const truth::SphereOnSpheresSample& s : event_driven().samples) {
    if (s.t == t) return harness::TrueMotion{s.position, s.velocity, s.omega, s.orientation};
  }
  return std::nullopt;
}

CaseRun<3> roll(BallShape shape, const harness::MethodSpec& method, double h) {
  CaseRun<3> run = harness::run_beside(sphere_on_spheres_scene(shape), method, h, 4.0);
  EXPECT_EQ(run.status, harness::CaseStatus::ok) << run.reason;
  return run;
}

ReportedErrors errors(BallShape shape, const harness::MethodSpec& method, double h) {
  return harness::reported_errors(roll(shape, method, h), 0, kTimes, true_motion);
}

/// Of the velocity error at each report time, from h to h / 2.
std::vector<double> orders(BallShape shape, const harness::MethodSpec& method, double h) {
  const ReportedErrors coarse = errors(shape, method, h);
  const ReportedErrors fine = errors(shape, method, h / 2);
  std::vector<double> orders;
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    orders.push_back(harness::observed_order(coarse[i]->velocity, h, fine[i]->velocity, h / 2));
  }
  return orders;
}

TEST(SphereOnSpheres, ImplicitStepsAreOfFirstOrder) {
  for (const double h : {0.02, 0.01}) {
    for (const double order : orders(BallShape::ellipsoid, {"implicit_ncp", {}}, h)) {
      EXPECT_GE(order, 0.9) << h;
      EXPECT_LE(order, 1.1) << h;
    }
  }
}

TEST(SphereOnSpheresControl, AMethodWithAFrictionPyramidIsNot) {
  // It ends at the solution of another problem: its error does not fall.
  for (const double order : orders(BallShape::sphere, {"stewart_trinkle", {}}, 0.02)) EXPECT_LT(order, 0.5);
}

TEST(SphereOnSpheres, IsTheSameForSpheresAndForEllipsoids) {
  const Twist<3> a = roll(BallShape::ellipsoid, {"implicit_ncp", {}}, 0.02).end[0].velocity;
  const Twist<3> b = roll(BallShape::sphere, {"implicit_ncp", {}}, 0.02).end[0].velocity;
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), 1e-10);
}

class SphereOnSpheresLaws : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(SphereOnSpheresLaws, HoldAtEveryStep) {
  constexpr double h = 0.01;
  const CaseRun<3> run =
      roll(BallShape::ellipsoid,
           {"implicit_ncp", {{"solver", std::get<0>(GetParam())}, {"gap", std::get<1>(GetParam())}}}, h);
  EXPECT_EQ(run.steps, 400);
  EXPECT_LE(run.residual.largest(), 1e-10);
  EXPECT_LE(run.largest_penetration, 1e-10);

  const BallHistory history = ball_history(run, sphere_on_spheres_scene(BallShape::ellipsoid), h);
  const BallLaws laws = ball_laws(history, h);
  EXPECT_LE(laws.rolling_slip, 1e-10);
  EXPECT_LE(laws.sliding_friction_gap, 1e-10);
  ASSERT_TRUE(laws.separation_jump);
  EXPECT_LE(*laws.separation_jump, h);

  const BallEvents found = ball_events(history);
  const BallEvents expected = ball_events(event_driven());
  EXPECT_EQ(found.story, kStory);
  EXPECT_EQ(expected.story, kStory);
  EXPECT_NEAR(*found.slides[1], *expected.slides[1], 2 * h);
  EXPECT_NEAR(*found.separates[0], *expected.separates[0], 2 * h);
  EXPECT_NEAR(*found.separates[1], *expected.separates[1], 2 * h);
}

INSTANTIATE_TEST_SUITE_P(SolversAndGaps, SphereOnSpheresLaws,
                         testing::Combine(testing::Values("path", "semismooth"),
                                          testing::Values("workspace", "distance")));

TEST(SphereOnSpheres, TheLedgerBooksTheFrictionThatTheTruthLoses) {
  const truth::SphereOnSpheres balls;
  const auto energy = [&](const truth::SphereOnSpheresSample& s) {
    return 0.5 * balls.mass * s.velocity.squaredNorm() + 0.5 * balls.inertia * s.omega.squaredNorm() -
           balls.force.dot(s.position - balls.position);
  };
  const double lost = -energy(event_driven().samples.back());  // it starts at rest
  for (const double h : {0.02, 0.005}) {
    const CaseRun<3> run = roll(BallShape::ellipsoid, {"implicit_ncp", {}}, h);
    EXPECT_NEAR(run.account.friction_loss, lost, h * lost) << h;
    EXPECT_NEAR(run.account.impact_loss, 0.0, 1e-6 * lost) << h;
    // Nothing is booked twice or left out: what the account says is the change of energy.
    EXPECT_NEAR(run.final.total() - run.initial.total(),
                run.account.drift - run.account.friction_loss - run.account.impact_loss, 1e-12);
  }
}

}  // namespace
}  // namespace touchstone
