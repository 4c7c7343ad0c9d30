// The step by elimination against the full mixed problem on every example scene: the same unknowns and rows,
// so the same motion. And that it is elimination that solved it, and not what it falls back to.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/stepper/implicit_stepper.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone {
namespace {

constexpr double kStep = 0.005;  // [s]

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(EXAMPLE_SCENES))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

scene_file::AnyScene example(const std::string& name) {
  return scene_file::read_scene(std::filesystem::path(EXAMPLE_SCENES) / (name + ".toml"));
}

/// Largest difference of pose and velocity, relative to 1 + the velocities' size.
template <int Dim>
double difference(std::span<const BodyState<Dim>> a, std::span<const BodyState<Dim>> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double size = 1 + a[i].velocity.norm();
    largest = std::max({largest, (a[i].velocity - b[i].velocity).norm() / size,
                        (a[i].pose.position - b[i].pose.position).norm(),
                        (a[i].pose.rotation.matrix() - b[i].pose.rotation.matrix()).norm()});
  }
  return largest;
}

/// Where ten bodies knock against each other all at once a step with friction has more than one solution: of
/// ten spheres with 21 contacts the two solvers find some that are 0.01 m/s apart, both to 1e-14. They are
/// followed until then.
int steps_of(const std::string& name) { return name == "ten_bodies" || name == "spheres_in_box" ? 40 : 100; }

class Elimination : public testing::TestWithParam<std::string> {};

TEST_P(Elimination, MovesEveryExampleAsTheFullProblemDoes) {
  const int steps = steps_of(GetParam());
  std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        ImplicitStepper<Dim> condensed(scene, {.solver = ImplicitOptions::Solver::condensed});
        ImplicitStepper<Dim> full(scene, {.solver = ImplicitOptions::Solver::path});
        for (int k = 0; k < steps; ++k) {
          ASSERT_EQ(condensed.step(kStep).status, StepStatus::solved) << "step " << k;
          ASSERT_EQ(full.step(kStep).status, StepStatus::solved) << "step " << k;
          ASSERT_LE((difference<Dim>(condensed.state(), full.state())), 1e-9) << "step " << k;
        }
      },
      example(GetParam()));
}

TEST_P(Elimination, SolvesNearlyEveryStepItself) {
  const int steps = steps_of(GetParam());
  std::visit(
      [&]<int Dim>(const Scene<Dim>& scene) {
        ImplicitStepper<Dim> stepper(scene, {});
        for (int k = 0; k < steps; ++k) ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved);
        EXPECT_LE(stepper.fallbacks(), steps / 50);
      },
      example(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Elimination, testing::ValuesIn(examples()),
                         [](const auto& example) { return example.param; });

}  // namespace
}  // namespace touchstone
