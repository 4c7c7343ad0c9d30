#include "experiments/problems/recorded_steps.h"

#include <gtest/gtest.h>

#include "core/complementarity/residual.h"
#include "core/stepper/condensed_newton.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::problems {
namespace {

using Eigen::VectorXd;

Scene<3> balls() { return std::get<Scene<3>>(scene_file::read_scene(SCENES "/sphere_on_spheres.toml")); }

TEST(RecordedSteps, GiveEachStepFromColdAndFromTheLastSolution) {
  const auto recorded = record_steps(balls(), 0.01, {2, 20});
  ASSERT_EQ(recorded.size(), 4u);
  EXPECT_EQ(recorded[0].step, 2);
  EXPECT_EQ(recorded[0].start, "warm");
  EXPECT_EQ(recorded[1].start, "cold");
  EXPECT_EQ(recorded[3].step, 20);
}

TEST(RecordedSteps, AreSolvedByTheMotionThatTheStepperTook) {
  ImplicitStepper<3> stepper(balls(), {});
  for (int step = 1; step <= 20; ++step) ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
  for (const auto& recorded : record_steps(balls(), 0.01, {20})) {
    StepProblem<3> problem = recorded.problem;
    CondensedNewton<3> solver({.tolerance = 1e-12});
    VectorXd z = recorded.z;
    ASSERT_TRUE(solver.solve(problem, z).solved()) << recorded.start;
    EXPECT_LE(natural_residual(problem, z).value, 1e-12);
    std::vector<BodyState<3>> end(stepper.state().begin(), stepper.state().end());
    problem.advance(z, end);
    for (std::size_t body = 0; body < end.size(); ++body) {
      EXPECT_LE((end[body].velocity - stepper.state()[body].velocity).norm(), 1e-9) << recorded.start;
    }
  }
}

/// The balls roll smoothly: what changes over a step is of order h, and so is the residual of the last
/// solution.
TEST(RecordedSteps, TheLastSolutionIsANearStart) {
  for (const auto& recorded : record_steps(balls(), 0.01, {10, 50, 100})) {
    const double residual = natural_residual(recorded.problem, recorded.z).value;
    EXPECT_EQ(residual <= 0.01, recorded.start == "warm") << recorded.step << ": " << residual;
  }
}

}  // namespace
}  // namespace touchstone::problems
