// A step allocates nothing once the first one has been made: every allocation of this program is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/stepper/implicit_stepper.h"
#include "core/stepper/interior_path.h"
#include "tests/support/allocation_counter.h"

namespace touchstone {
namespace {

Scene<2> sliding_disc() {
  Scene<2> scene;
  scene.gravity = {0, -9.81};
  scene.contact_law.mu = 0.4;
  Body<2> disc;
  disc.name = "disc";
  disc.inertia << 0.5;
  disc.pose.position = {0, 1};
  disc.velocity << -3, 0, 0;  // slides first, then rolls: the solver has work to do
  Body<2> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape = {HalfSpace<2>{}};
  scene.bodies = {disc, ground};
  return scene;
}

TEST(Allocation, TheCounterCounts) {
  const long before = allocations;
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(3);
  EXPECT_EQ(allocations, before + (kAllocationsAreCounted ? 1 : 0)) << vector[0];
}

TEST(Allocation, APlanarStepMakesNone) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  using Solver = ImplicitOptions::Solver;
  for (const auto solver : {Solver::condensed, Solver::path, Solver::semismooth}) {
    ImplicitStepper<2> stepper(sliding_disc(), {.solver = solver});
    ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
    int iterations = 0;
    for (int k = 0; k < 100; ++k) {
      const long before = allocations;
      iterations += stepper.step(0.01).iterations;
      EXPECT_EQ(allocations, before) << "step " << k;
    }
    // Extrapolation starts most steps of elimination at their solutions.
    EXPECT_GT(iterations, solver == Solver::condensed ? 5 : 20);
  }
}

/// A ball on four that touch each other on the ground: more contacts than the motion needs.
Scene<3> pyramid() {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_law.mu = 0.5;
  const double top = 1 + std::sqrt(2.0);
  for (const Vector<3>& place : {Vector<3>(-1, -1, 1), Vector<3>(1, -1, 1), Vector<3>(-1, 1, 1),
                                 Vector<3>(1, 1, 1), Vector<3>(0, 0, top)}) {
    Body<3>& ball = scene.bodies.emplace_back();
    ball.name = "ball " + std::to_string(scene.bodies.size());
    ball.inertia = 0.4 * Inertia<3>::Identity();
    ball.pose.position = place;
    ball.shape.geometry = Sphere<3>{1.0};
  }
  Body<3>& ground = scene.bodies.emplace_back();
  ground.name = "ground";
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<3>{};
  return scene;
}

// What is factorised here is small enough to be dense; the factors of a sparse system, of more than ten
// bodies, are Eigen's, which allocates them anew for each.
TEST(Allocation, AnInteriorPathMakesNoneOnceItHasBeenDown) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  constexpr double kStep = 0.01;
  const Scene<3> scene = pyramid();
  ImplicitStepper<3> stepper(scene, {});
  ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved);
  ASSERT_EQ(stepper.problem().contacts().size(), 12U);
  StepProblem<3> problem(scene);
  problem.begin(stepper.state(), kStep);
  problem.select(stepper.problem().bodies(), {}, stepper.problem().contacts());
  Eigen::VectorXd start = Eigen::VectorXd::Zero(problem.size());
  problem.free_velocity(start);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) problem.find_points(i, start);
  InteriorPath<3> path;
  Eigen::VectorXd z = start;
  const auto go_down = [&] {
    path.begin(problem, start, 1e-3);
    ASSERT_TRUE(path.follow(1e-6));
    ASSERT_TRUE(path.descend(1e-12));
    path.write(z);
  };
  go_down();
  const long before = allocations;
  go_down();
  EXPECT_EQ(allocations, before);
  EXPECT_GT(path.factorisations(), 10);
}

TEST(Allocation, FindingPairsMakesNoneOnceTheyWereMet) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  Scene<3> scene;
  for (int i = 0; i < 200; ++i) {
    Body<3>& body = scene.bodies.emplace_back();
    body.pose.position = {1.9 * (i % 20), 1.9 * (i / 20), 0};
    body.shape.geometry = Sphere<3>{1.0};
  }
  ContactCandidates<3> candidates(scene);
  const auto together = initial_state(scene);
  auto apart = together;
  for (auto& state : apart) state.pose.position *= 2;
  candidates.select(together, 0.01);
  const std::size_t met = candidates.selected().size();
  const long before = allocations;
  for (int k = 0; k < 10; ++k) {
    candidates.select(apart, 0.01);
    EXPECT_FALSE(candidates.add_overlapping(apart));
    EXPECT_TRUE(candidates.add_overlapping(together));
    EXPECT_EQ(candidates.selected().size(), met);
    candidates.select(together, 0.01);
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace touchstone
