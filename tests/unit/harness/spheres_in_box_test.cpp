// The heap of spheres: its scene, that its steps are solved, and that the judge finds the deepest of many
// overlaps.
#include "experiments/scenarios/spheres_in_box.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/model/errors.h"
#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/judge.h"

namespace touchstone {
namespace {

SpheresInBox heap(int spheres) {
  SpheresInBox box;
  box.spheres = spheres;
  return box;
}

double radius(const Body<3>& body) { return std::get<Sphere<3>>(body.shape.geometry).radius; }

/// From every pair of spheres and the box's closed form.
double deepest_of_all_pairs(const SpheresInBox& box, const Scene<3>& scene,
                            const std::vector<BodyState<3>>& state) {
  double deepest = 0;
  const auto n = static_cast<std::size_t>(box.spheres);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector<3> p = state[i].pose.position;
    const double room = std::min({p.x(), p.y(), p.z(), box.width() - p.x(), box.width() - p.y()});
    deepest = std::max(deepest, radius(scene.bodies[i]) - room);
    for (std::size_t j = i + 1; j < n; ++j) {
      deepest = std::max(
          deepest, radius(scene.bodies[i]) + radius(scene.bodies[j]) - (p - state[j].pose.position).norm());
    }
  }
  return deepest;
}

TEST(SpheresInBoxScene, StartsInTheBoxWithoutOverlap) {
  for (const int n : {1, 10, 137, 400}) {
    const SpheresInBox box = heap(n);
    const Scene<3> scene = spheres_in_box_scene(box);
    ASSERT_EQ(scene.bodies.size(), static_cast<std::size_t>(n) + 5);
    EXPECT_EQ(deepest_of_all_pairs(box, scene, initial_state(scene)), 0) << n;
  }
}

TEST(SpheresInBoxScene, IsAsDeepAsItIsWide) {
  for (const int n : {30, 300, 3000}) {
    const SpheresInBox box = heap(n);
    double top = 0;
    const Scene<3> scene = spheres_in_box_scene(box);
    for (int i = 0; i < n; ++i)
      top = std::max(top, scene.bodies[static_cast<std::size_t>(i)].pose.position.z());
    EXPECT_NEAR(top / box.width(), 1.0, 0.3) << n;  // a layer more or less of few
  }
}

TEST(SpheresInBoxScene, ATrayHasAsManyLayersWhateverTheNumber) {
  for (const int n : {64, 400, 4000}) {
    SpheresInBox box = heap(n);
    box.layers = 4;
    const Scene<3> scene = spheres_in_box_scene(box);
    double top = 0;
    for (int i = 0; i < n; ++i)
      top = std::max(top, scene.bodies[static_cast<std::size_t>(i)].pose.position.z());
    EXPECT_NEAR(top, 3.5 / 4 * 0.6, 0.1) << n;  // 4 layers of diameters 0.2 / sqrt 2, the top one's middle
    EXPECT_NEAR(box.width() * box.width() / n, 0.04 / 4, 0.005) << n;  // floor for each sphere [m^2]
  }
}

TEST(SpheresInBoxScene, FollowsFromItsSeed) {
  SpheresInBox box = heap(20);
  const Vector<3> first = spheres_in_box_scene(box).bodies[7].pose.position;
  EXPECT_EQ(spheres_in_box_scene(box).bodies[7].pose.position, first);
  box.seed = 2;
  EXPECT_NE(spheres_in_box_scene(box).bodies[7].pose.position, first);
}

TEST(SpheresInBoxScene, RefusesWhatMakesNoSense) {
  EXPECT_THROW(spheres_in_box_scene(heap(0)), InputError);
  SpheresInBox box;
  box.smallest_radius = 0.2;
  EXPECT_THROW(spheres_in_box_scene(box), InputError);
}

TEST(SpheresInBoxJudge, FindsTheDeepestOverlapOfAllPairs) {
  const SpheresInBox box = heap(200);
  const Scene<3> scene = spheres_in_box_scene(box);
  const Judge<3> judge(scene);
  for (const double shrink : {0.98, 0.9, 0.5}) {  // towards the floor's middle, so that many overlap
    std::vector<BodyState<3>> state = initial_state(scene);
    for (std::size_t i = 0; i < 200; ++i) state[i].pose.position *= shrink;
    const double all = deepest_of_all_pairs(box, scene, state);
    EXPECT_GT(all, 0);
    EXPECT_NEAR(judge.largest_penetration(state), all, 1e-12);
  }
}

TEST(SpheresInBoxSteps, AreSolvedWithoutTheFullProblem) {
  const Scene<3> scene = spheres_in_box_scene(heap(100));
  const Judge<3> judge(scene);
  ImplicitStepper<3> stepper(scene, {});
  std::vector<BodyState<3>> before;
  for (int k = 0; k < 20; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved) << k;
    EXPECT_LE(judge.step_residual(before, stepper.state(), stepper.contacts(), 0.01).largest(), 1e-10) << k;
  }
  EXPECT_EQ(stepper.fallbacks(), 0);
  EXPECT_GT(stepper.contacts().size(), 200U);
}

// Rounds of sweeps, which steps of more than 60 contacts begin with, against the full problem as a whole.
TEST(SpheresInBoxSteps, AreThoseOfTheFullProblem) {
  SpheresInBox box = heap(30);
  box.layers = 4;
  const Scene<3> scene = spheres_in_box_scene(box);
  ImplicitStepper<3> stepper(scene, {});
  ImplicitStepper<3> full(scene, {.solver = ImplicitOptions::Solver::semismooth});
  std::size_t most = 0;
  for (int k = 0; k < 12; ++k) {
    ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved) << k;
    ASSERT_EQ(full.step(0.01).status, StepStatus::solved) << k;
    most = std::max(most, stepper.contacts().size());
    for (std::size_t i = 0; i < 30; ++i)
      EXPECT_LE((stepper.state()[i].velocity - full.state()[i].velocity).norm(), 1e-9) << k;
  }
  EXPECT_GT(most, 60U);
}

}  // namespace
}  // namespace touchstone
