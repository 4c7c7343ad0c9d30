#include "experiments/problems/trajectory.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/complementarity/residual.h"
#include "core/stepper/condensed_newton.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::problems {
namespace {

constexpr int kSteps = 40;
constexpr double kStep = 0.01;

Scene<3> read(const char* name) {
  return std::get<Scene<3>>(scene_file::read_scene(std::string(SCENES "/") + name));
}

TEST(Trajectory, HasEveryStepFromBothStarts) {
  const auto recorded = record_trajectory(read("sphere_on_spheres.toml"), kStep, kSteps);
  ASSERT_EQ(recorded.size(), 2u * (kSteps - 1));
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    EXPECT_EQ(recorded[i].step, static_cast<int>(2 + i / 2));
    EXPECT_EQ(recorded[i].start, i % 2 == 0 ? "last" : "extrapolated");
  }
}

/// The stepper's own search from there: the same Newton steps to the same motion, step after step.
TEST(Trajectory, ExtrapolatedStartsAreThoseOfTheStepper) {
  for (const char* scene : {"sphere_on_spheres.toml", "tippe_top.toml", "box_on_incline.toml"}) {
    ImplicitStepper<3> stepper(read(scene), {});
    ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved);
    const ImplicitOptions options;
    CondensedNewton<3> solver({options.tolerance, options.max_iterations, ImplicitOptions::kAcceptable});
    for (const auto& recorded : record_trajectory(read(scene), kStep, kSteps)) {
      if (recorded.start != "extrapolated") continue;
      const StepReport step = stepper.step(kStep);
      StepProblem<3> problem = recorded.problem;
      Eigen::VectorXd z = recorded.z;
      const SolveReport report = solver.solve(problem, z);
      EXPECT_EQ(report.iterations, step.iterations) << scene << ", step " << recorded.step;
      EXPECT_EQ(z, stepper.solution()) << scene << ", step " << recorded.step;
    }
  }
}

/// A ball that rolls smoothly: the last solution is O(h) away, a cubic through four O(h^4).
TEST(Trajectory, ACubicIsFarNearerThanTheLastSolution) {
  const auto recorded = record_trajectory(read("sphere_on_spheres.toml"), kStep, kSteps);
  for (std::size_t i = 10; i < recorded.size(); i += 2) {
    const double last = natural_residual(recorded[i].problem, recorded[i].z).value;
    const double cubic = natural_residual(recorded[i + 1].problem, recorded[i + 1].z).value;
    EXPECT_LE(cubic, 0.1 * last) << recorded[i].step;
  }
}

TEST(Trajectory, IsOfOneMovingBody) {
  EXPECT_THROW(static_cast<void>(record_trajectory(read("ten_bodies.toml"), kStep, 2)),
               std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::problems
