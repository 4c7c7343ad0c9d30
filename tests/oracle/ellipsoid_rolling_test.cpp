// Ellipsoids that roll without slip against the nonholonomic ODE: order of the error and of the energy drift.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/harness/contact_view.h"
#include "experiments/harness/method_case.h"
#include "experiments/harness/motion_error.h"
#include "experiments/scenarios/ellipsoid_rolling.h"

namespace touchstone {
namespace {

using harness::CaseRun;

const std::vector<double> kTimes = {0.5, 1, 1.5, 2};  // [s]

struct Rolled {
  double error = 0.0;  ///< largest velocity error of the report times [m/s, rad/s]
  double drift = 0.0;  ///< largest |E(t) - E(0)| [J]
  double slip = 0.0;   ///< largest slip at the contact [m/s]
  double penetration = 0.0;
  double residual = 0.0;
};

/// @param truth  parameters of the ODE, as a rule the same ones as of the scene
Rolled roll(const truth::RollingEllipsoid& rolling, const truth::RollingEllipsoid& truth_parameters,
            const char* method, double h) {
  const Scene<3> scene = ellipsoid_scene(rolling, 1.0);
  const truth::EllipsoidResult expected = truth::roll_ellipsoid(truth_parameters, kTimes);
  const auto motion = [&](double t) -> std::optional<harness::TrueMotion> {
    for (const truth::EllipsoidSample& s : expected.samples) {
      if (s.t == t) return harness::TrueMotion{s.position, s.velocity, s.omega, s.orientation};
    }
    return std::nullopt;
  };
  const CaseRun<3> run = harness::run_beside<3>(scene, {method, {}}, h, kTimes.back());
  EXPECT_EQ(run.status, harness::CaseStatus::ok) << run.reason;
  Rolled rolled;
  rolled.error = harness::largest_velocity_error(harness::reported_errors(run, 0, kTimes, motion));
  rolled.drift = run.largest_drift_J;
  rolled.penetration = run.largest_penetration;
  rolled.residual = run.residual.largest();
  for (std::size_t k = 1; k < run.kept.size(); ++k) {
    const auto contact = harness::strongest_contact(scene, run.kept[k].state, run.kept[k].contacts, 0, 1);
    if (contact) rolled.slip = std::max(rolled.slip, contact->slip);
    EXPECT_TRUE(contact) << "no contact in step " << k;
  }
  return rolled;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

class EllipsoidRolling : public testing::TestWithParam<truth::RollingEllipsoid (*)()> {};

TEST_P(EllipsoidRolling, IsOfFirstOrderAndSoIsItsEnergy) {
  const truth::RollingEllipsoid rolling = GetParam()();
  const Rolled coarse = roll(rolling, rolling, "implicit_ncp", 0.004);
  const Rolled fine = roll(rolling, rolling, "implicit_ncp", 0.002);
  EXPECT_GE(order(coarse.error, fine.error), 0.9);
  EXPECT_LE(order(coarse.error, fine.error), 1.1);
  EXPECT_GE(order(coarse.drift, fine.drift), 0.9);
  EXPECT_LE(order(coarse.drift, fine.drift), 1.1);
}

TEST_P(EllipsoidRolling, NeitherSlipsNorPenetratesAndSolvesThePapersSystem) {
  const truth::RollingEllipsoid rolling = GetParam()();
  const Rolled rolled = roll(rolling, rolling, "implicit_ncp", 0.01);
  EXPECT_LE(rolled.slip, 1e-10);
  EXPECT_LE(rolled.penetration, 1e-10);
  EXPECT_LE(rolled.residual, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EllipsoidRolling,
                         testing::Values(&ellipsoid_on_plane, &ellipsoid_on_ellipsoid,
                                         &ellipsoid_over_its_end));

TEST(EllipsoidRollingControl, TheOrderIsNotFoundAgainstAnotherTruth) {
  // With an inertia that is 5 % off the error ends at that of the truth, however small the step.
  const truth::RollingEllipsoid rolling = ellipsoid_on_plane();
  truth::RollingEllipsoid other = rolling;
  other.inertia *= 1.05;
  const double coarse = roll(rolling, other, "implicit_ncp", 0.004).error;
  const double fine = roll(rolling, other, "implicit_ncp", 0.002).error;
  EXPECT_LT(order(coarse, fine), 0.9);
}

TEST(EllipsoidRollingControl, FrozenGeometrySlipsPenetratesAndMissesThePapersSystem) {
  const truth::RollingEllipsoid rolling = ellipsoid_on_plane();
  const Rolled frozen = roll(rolling, rolling, "stewart_trinkle", 0.01);
  EXPECT_GT(frozen.slip, 1e-4);
  EXPECT_GT(frozen.penetration, 1e-6);
  EXPECT_GT(frozen.residual, 1e-5);
}

TEST(EllipsoidRollingControl, FrozenGeometryIsWorseForABodyThatSpinsFast) {
  const truth::RollingEllipsoid rolling = ellipsoid_spinning();
  EXPECT_GT(roll(rolling, rolling, "stewart_trinkle", 0.01).error,
            roll(rolling, rolling, "implicit_ncp", 0.01).error);
}

TEST(EllipsoidRollingControl, FrozenGeometryIsWorseOverASharpEnd) {
  // In the linear motion over the end, theta ~ sinh(lambda t), the NCP's drift adds up evenly and the frozen
  // step's as cosh(2 lambda t), -1 s <= t <= 1 s: sinh(2 lambda) / (2 lambda) = 4 times as much. Half of it
  // is asked for.
  const truth::RollingEllipsoid rolling = ellipsoid_over_its_end();
  const Rolled frozen = roll(rolling, rolling, "stewart_trinkle", 0.01);
  const Rolled ncp = roll(rolling, rolling, "implicit_ncp", 0.01);
  EXPECT_GT(frozen.error, 2 * ncp.error);
  EXPECT_GT(frozen.drift, 2 * ncp.drift);
}

TEST(EllipsoidRolling, LosesNothingToFrictionByTheLedger) {
  // Only the first step finds slip, with the geometry of its end: an impulse of m g h that stops g h at most.
  const Scene<3> scene = ellipsoid_scene(ellipsoid_on_plane(), 1.0);
  constexpr double h = 0.002;
  const CaseRun<3> run = harness::run_beside<3>(scene, {"implicit_ncp", {}}, h, 2.0);
  EXPECT_LE(std::abs(run.account.friction_loss), std::pow(9.81 * h, 2));
  EXPECT_LE(std::abs(run.account.impact_loss), std::pow(9.81 * h, 2));
  EXPECT_NEAR(run.account.drift, run.final.total() - run.initial.total(), 2 * std::pow(9.81 * h, 2));
  EXPECT_LT(run.account.drift, 0.0) << "the end-of-step geometry damps the rocking";
}

}  // namespace
}  // namespace touchstone
