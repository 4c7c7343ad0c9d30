// Oracle: the full mixed problem's Jacobian (checked against differences in step_problem_test.cpp), solved
// densely. Elimination is another order of the same Newton step, so that both agree to rounding, far from a
// solution too.

#include "core/stepper/condensed_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "core/stepper/implicit_stepper.h"
#include "tests/support/pile.h"

namespace touchstone {
namespace {

/// Rows and derivatives that the active set of the minimum function asks for.
template <int Dim>
Eigen::VectorXd dense_newton_step(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  const Eigen::Index n = problem.size();
  Eigen::VectorXd f(n);
  Eigen::MatrixXd j(n, n);
  problem.evaluate(z, f, &j);
  const double gap_weight = problem.scale().length / (problem.step_size() * problem.scale().velocity);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    const Eigen::Index row = problem.layout().contact(i).normal;
    if (z[row] > gap_weight * f[row]) continue;
    f[row] = z[row];
    j.row(row).setZero();
    j(row, row) = 1;
  }
  return -j.fullPivLu().solve(f);
}

/// After some steps of a scene: the last problem from its solution, changed at random by `size`.
template <int Dim>
void expect_same_steps(const Scene<Dim>& scene, double size) {
  ImplicitStepper<Dim> stepper(scene, {});
  for (int step = 0; step < 3; ++step) ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
  StepProblem<Dim> problem = stepper.problem();
  ASSERT_FALSE(problem.contacts().empty());
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20; ++round) {
    Eigen::VectorXd z = stepper.solution().head(problem.size());
    for (double& value : z) value += size * normal(random);
    CondensedSystem<Dim> system;
    system.bind(problem);
    system.set_form({});
    system.evaluate(z);  // takes sigma = |w|, as both then start with it
    ASSERT_TRUE(system.newton_step(z));
    Eigen::VectorXd dense = dense_newton_step(problem, z);
    // sigma is no part of the condensed step: evaluate() sets it.
    for (std::size_t i = 0; i < problem.contacts().size(); ++i) dense[problem.layout().contact(i).slip] = 0;
    EXPECT_LE((system.step().head(problem.size()) - dense).norm(), 1e-9 * dense.norm()) << "size " << size;
  }
}

/// A ball on the ground and an ellipsoid on that: contacts of one moving body and of two.
template <int Dim>
Scene<Dim> tower() {
  Body<Dim> below = ball(3.0, at<Dim>(0, 0, 1));
  Body<Dim> above = ball(1.5, at<Dim>(0, 0, 2.8));
  above.shape.geometry = Ellipsoid<Dim>{at<Dim>(1.1, 1.1, 0.8)};
  for (Body<Dim>* body : {&below, &above}) body->velocity.setConstant(0.1);
  Scene<Dim> scene = pile<Dim>({below, above});
  scene.gravity[0] = 0.7;
  return scene;
}

/// The same with a ball at rest in the place of the ground: both sides of each contact are curved.
template <int Dim>
Scene<Dim> tower_on_a_ball() {
  Scene<Dim> scene = tower<Dim>();
  scene.bodies.back().shape = {Sphere<Dim>{2.0}};
  scene.bodies.back().pose.position[Dim - 1] = -2.0;
  return scene;
}

/// With ground that moves and turns, and with it the normal.
template <int Dim>
Scene<Dim> tower_on_a_moving_plane() {
  Scene<Dim> scene = tower<Dim>();
  scene.bodies.back().fixed = false;
  scene.bodies.back().mass = 20;
  scene.bodies.back().velocity.setConstant(0.2);
  return scene;
}

TEST(CondensedSystem, NewtonStepsAreThoseOfTheFullProblem) {
  for (const double size : {1e-6, 1e-3, 1e-2}) {
    expect_same_steps(tower<2>(), size);
    expect_same_steps(tower_on_a_ball<2>(), size);
    expect_same_steps(tower_on_a_moving_plane<2>(), size);
    expect_same_steps(tower<3>(), size);
    expect_same_steps(tower_on_a_ball<3>(), size);
    expect_same_steps(tower_on_a_moving_plane<3>(), size);
  }
}

}  // namespace
}  // namespace touchstone
