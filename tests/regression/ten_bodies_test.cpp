// Ten bodies of every shape of space dropped into a box of half-spaces: every step is solved, nothing
// overlaps, no energy comes from nowhere, and they calm down. They do not come to rest in any time that can
// be waited for: what is round rolls on, because Coulomb friction does not resist rolling, and nudges the
// others.
#include <gtest/gtest.h>

#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/ledger.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/regression/sanitized.h"

namespace touchstone {
namespace {

TEST(TenBodies, FallWithoutOverlapAndCalmDown) {
  const auto scene =
      std::get<Scene<3>>(scene_file::read_scene(std::string(EXAMPLE_SCENES) + "/ten_bodies.toml"));
  constexpr double kStep = 0.005;
  constexpr double kUntil = testing::kSanitized ? 0.25 : 4.0;
  ImplicitStepper<3> stepper(scene, {});
  const Judge<3> judge(stepper.scene());
  EnergyLedger<3> ledger(stepper.scene(), judge, stepper.state());
  std::vector<BodyState<3>> before;
  double fastest = 0;  // largest kinetic energy [J]
  double last = ledger.energy().total();
  const int steps = static_cast<int>(std::lround(kUntil / kStep));
  for (int k = 1; k <= steps; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved) << "step " << k;
    ASSERT_LE(judge.step_residual(before, stepper.state(), stepper.contacts(), kStep).largest(), 1e-10);
    ASSERT_LE(judge.largest_penetration(stepper.state()), 1e-9) << "step " << k;
    const double drift = ledger.account().drift;
    ledger.book(kStep, before, stepper.state(), stepper.contacts(), stepper.joints());
    const double now = ledger.energy().total();
    // Contacts only take; what else there is, is the step's own drift.
    ASSERT_LE(now - last, std::max(0.0, ledger.account().drift - drift) + 1e-9) << "step " << k;
    last = now;
    fastest = std::max(fastest, ledger.energy().kinetic);
  }
  if (testing::kSanitized) return;
  EXPECT_LE(ledger.energy().kinetic, 0.05 * fastest);
}

}  // namespace
}  // namespace touchstone
