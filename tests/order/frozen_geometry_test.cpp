// What freezing the contact's geometry at the start of a step costs a smooth body that rolls: the negative
// control of the implicit step's own claims, that bodies touch and do not slip at the END of every step,
// whatever its size.
#include <algorithm>
#include <cmath>

#include "core/contact/closest_points.h"
#include "experiments/harness/judge.h"
#include "tests/order/scenes.h"

namespace touchstone::order {
namespace {

constexpr double kUntil = 2.0;

/// Largest over all steps of a run, and errors at its end.
struct Account {
  double gap = 0.0;       ///< |psi| at the end of a step [m]
  double slip = 0.0;      ///< of the material points in contact [m/s]
  double energy = 0.0;    ///< |E(t) - E(0)| [J]
  double velocity = 0.0;  ///< error of v at kUntil [m/s]
  double position = 0.0;  ///< error of x at kUntil [m]
};

Account roll(const char* key, const truth::RollingEllipsoid& truth, double h) {
  const truth::EllipsoidResult exact = truth::roll_ellipsoid(truth, {kUntil});
  EXPECT_EQ(exact.status, truth::EllipsoidStatus::completed);
  const auto method = find_method<3>(key).make(scene_of(truth), {});
  const Judge<3> judge(method->scene());
  const auto surface = make_surface(method->scene().bodies[0].shape);
  const auto support = make_surface(method->scene().bodies[1].shape);
  const double start = judge.energy(method->state()).total();
  Account account;
  for (long k = 0; k < std::lround(kUntil / h); ++k) {
    EXPECT_EQ(method->step(h).status, StepStatus::solved) << key << ", step " << k + 1;
    const BodyState<3>& body = method->state()[0];
    const auto closest = closest_points(*surface, body.pose, *support, method->state()[1].pose);
    const Vector<3> velocity = point_velocity<3>(body.velocity, closest.a_1 - body.pose.position);
    account.gap = std::max(account.gap, std::abs(closest.gap));
    account.slip = std::max(account.slip, velocity.cross(closest.normal).norm());
    account.energy = std::max(account.energy, std::abs(judge.energy(method->state()).total() - start));
  }
  const BodyState<3>& end = method->state()[0];
  account.velocity = (end.velocity.head<3>() - exact.samples.back().velocity).norm();
  account.position = (end.pose.position - exact.samples.back().position).norm();
  std::printf(
      "%-16s h = %-6g gap %.1e m, slip %.1e m/s, energy drift %.1e J, error of v %.1e m/s, of x %.1e m\n",
      key, h, account.gap, account.slip, account.energy, account.velocity, account.position);
  return account;
}

class RollingEllipsoids : public testing::TestWithParam<truth::RollingEllipsoid> {};

TEST_P(RollingEllipsoids, TheImplicitStepEndsInTouchAndWithoutSlip) {
  for (const double h : {0.02, 0.01}) {
    const Account account = roll("implicit_ncp", GetParam(), h);
    EXPECT_LE(account.gap, 1e-12);
    EXPECT_LE(account.slip, 1e-12);
  }
}

TEST_P(RollingEllipsoids, TheFrozenGeometryFailsThatByTheStepAndItsSquare) {
  const Account coarse = roll("stewart_trinkle", GetParam(), 0.02);
  const Account fine = roll("stewart_trinkle", GetParam(), 0.01);
  EXPECT_GT(fine.gap, 1e-5);
  EXPECT_NEAR(std::log2(coarse.gap / fine.gap), 2, 0.2) << "the linearised gap";
  EXPECT_GT(fine.slip, 1e-3);
  EXPECT_NEAR(std::log2(coarse.slip / fine.slip), 1, 0.2) << "the contact point has moved on";
}

// That is not to say that the frozen geometry rolls the worse: where friction only has to stick it keeps more
// of the energy, and its trajectory is the better one at equal step. Both are of first order.
TEST_P(RollingEllipsoids, TheFrozenGeometryKeepsMoreOfTheEnergyNevertheless) {
  for (const double h : {0.02, 0.01}) {
    const Account implicit = roll("implicit_ncp", GetParam(), h);
    const Account frozen = roll("stewart_trinkle", GetParam(), h);
    std::printf("implicit over frozen: energy drift %.1f, error of v %.1f, of x %.1f\n",
                implicit.energy / frozen.energy, implicit.velocity / frozen.velocity,
                implicit.position / frozen.position);
    EXPECT_LT(frozen.energy, implicit.energy);
    EXPECT_LT(frozen.velocity, implicit.velocity);
    EXPECT_LT(frozen.position, implicit.position);
  }
}

INSTANTIATE_TEST_SUITE_P(OnAPlaneAndOnAnEllipsoid, RollingEllipsoids,
                         testing::Values(rolling_ellipsoid(), ellipsoid_on_ellipsoid()));

// Balls modelled as ellipsoids go through the general query, and must not be told from balls.
TEST(BallsAsEllipsoids, MoveAsBallsDo) {
  const truth::SphereOnSpheres spheres;
  const std::vector<double> times = {1, 2, 3, 4};
  for (const char* key : {"stewart_trinkle", "implicit_ncp"}) {
    const auto balls = run(key, scene_of(spheres, Balls::spheres), 0.01, times);
    const auto ellipsoids = run(key, scene_of(spheres, Balls::ellipsoids), 0.01, times);
    ASSERT_EQ(balls.size(), ellipsoids.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
      EXPECT_LT((balls[i].velocity - ellipsoids[i].velocity).norm(), 1e-9) << key << ", t = " << times[i];
      EXPECT_LT((balls[i].pose.position - ellipsoids[i].pose.position).norm(), 1e-9) << key;
    }
  }
}

}  // namespace
}  // namespace touchstone::order
