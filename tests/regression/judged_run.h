#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/judge.h"

namespace touchstone::testing {

/// Runs to `until` and shows each step to `look(t, stepper)`. The judge looks at every step: Eqs. 10-11 and
/// the joints to 1e-10.
template <int Dim, class Look>
void judged_run(const Scene<Dim>& scene, double h, double until, const Look& look) {
  ImplicitStepper<Dim> stepper(scene, {});
  const Judge<Dim> judge(stepper.scene());
  std::vector<BodyState<Dim>> before;
  const int steps = static_cast<int>(std::lround(until / h));
  for (int k = 1; k <= steps; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    ASSERT_EQ(stepper.step(h).status, StepStatus::solved) << "step " << k;
    const StepResidual residual =
        judge.step_residual(before, stepper.state(), stepper.contacts(), h, stepper.joints());
    ASSERT_LE(residual.joints, 1e-10) << "step " << k;
    ASSERT_LE(residual.largest(), 1e-10) << "step " << k;
    look(h * k, stepper);
  }
}

}  // namespace touchstone::testing
