// Ten bodies of every shape of space dropped into a box of half-spaces that stands on a corner: every step is
// solved, nothing overlaps, no energy comes from nowhere, and they come to rest and stay there.
//
// At rest there are more contacts than the motion needs, and their impulses are not unique: such steps, and
// those shortly before, are what a solver finds hardest.
#include <gtest/gtest.h>

#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/ledger.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/regression/sanitized.h"

namespace touchstone {
namespace {

constexpr double kUntil = testing::kSanitized ? 0.25 : 3.5;  // [s]
constexpr double kRest = 2.5;                                // from when on nothing moves [s]
constexpr double kStill = 1e-6;                              // [m/s], [rad/s]
constexpr double kEnergyWindow = 0.5;                        // at the end [s]
constexpr double kEnergyChange = 1e-9;                       // in it [J]

class TenBodies : public ::testing::TestWithParam<double> {};

TEST_P(TenBodies, FallWithoutOverlapAndComeToRest) {
  const auto scene =
      std::get<Scene<3>>(scene_file::read_scene(std::string(EXAMPLE_SCENES) + "/ten_bodies.toml"));
  const double h = GetParam();
  ImplicitStepper<3> stepper(scene, {});
  const Judge<3> judge(stepper.scene());
  EnergyLedger<3> ledger(stepper.scene(), judge, stepper.state());
  std::vector<BodyState<3>> before;
  double last = ledger.energy().total();
  double least = last;  // energy in the last window [J]
  double most = last;
  const int steps = static_cast<int>(std::lround(kUntil / h));
  for (int k = 1; k <= steps; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    ASSERT_EQ(stepper.step(h).status, StepStatus::solved) << "step " << k;
    ASSERT_LE(judge.step_residual(before, stepper.state(), stepper.contacts(), h).largest(), 1e-10)
        << "step " << k;
    ASSERT_LE(judge.largest_penetration(stepper.state()), 1e-9) << "step " << k;
    const double drift = ledger.account().drift;
    ledger.book(h, before, stepper.state(), stepper.contacts(), stepper.joints());
    const double now = ledger.energy().total();
    // Contacts only take; what else there is, is the step's own drift.
    ASSERT_LE(now - last, std::max(0.0, ledger.account().drift - drift) + 1e-9) << "step " << k;
    last = now;
    if (k * h < kUntil - kEnergyWindow) {
      least = most = now;
    } else {
      least = std::min(least, now);
      most = std::max(most, now);
    }
    if (k * h < kRest) continue;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
      const Twist<3>& velocity = stepper.state()[body].velocity;
      ASSERT_LE(velocity.head<3>().norm(), kStill) << scene.bodies[body].name << ", step " << k;
      ASSERT_LE(velocity.tail<3>().norm(), kStill) << scene.bodies[body].name << ", step " << k;
    }
  }
  if (testing::kSanitized) return;
  EXPECT_LE(most - least, kEnergyChange);
}

INSTANTIATE_TEST_SUITE_P(Steps, TenBodies, ::testing::Values(0.005, 0.01));

}  // namespace
}  // namespace touchstone
