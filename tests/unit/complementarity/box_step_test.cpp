#include "tests/unit/complementarity/box_step.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/complementarity/solver_chain.h"
#include "tests/unit/complementarity/checks.h"

// The kind of problem that the solvers are for: contact with unknown points and face multipliers, friction by
// projection, singular but consistent Jacobians in the air.

namespace touchstone::testing {
namespace {

using Eigen::VectorXd;

struct Throws {
  int steps = 0;
  int solved = 0;
  double deepest = 0.0;      ///< penetration [m]
  double energy_gain = 0.0;  ///< largest in one step [J]
};

/// Throws tumbling boxes onto the plane, each step by `solver` from the step before, by a chain where that
/// fails.
Throws throw_boxes(ComplementaritySolver& solver, int boxes, int steps, bool warm) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  SolverChain chain;
  Throws throws;
  for (int box = 0; box < boxes; ++box) {
    BoxScene scene;
    scene.half_extents.y() = box % 3 == 0 ? 0.25 : 0.5;
    scene.mu = 0.2 + 0.3 * (box % 4);
    scene.slope = box % 5 == 4 ? 0.3 : 0.0;
    BoxState state;
    const double spin = box == 0 ? 0.0 : 1.0;  // the first box falls flat
    state.q << 0.0, 1.2 + 0.3 * uniform(engine), 3.0 * spin * uniform(engine);
    state.nu << 3.0 * uniform(engine), 2.0 * uniform(engine), 6.0 * spin * uniform(engine);
    VectorXd z;
    for (int k = 0; k < steps; ++k) {
      const BoxStep problem(scene, state);
      if (k == 0 || !warm) z = problem.predicted_start();
      const VectorXd start = z;
      SolveReport report = solver.solve(problem, z);
      ++throws.steps;
      throws.solved += report.solved() ? 1 : 0;
      if (!report.solved()) {
        z = start;
        report = chain.solve(problem, z);
      }
      EXPECT_TRUE(report.solved()) << "box " << box << " step " << k << ": " << describe(report, problem);
      expect_honest(report, problem, z, 1e-10);
      const BoxState next = problem.next_state(z);
      throws.deepest = std::max(throws.deepest, -z[4]);
      throws.energy_gain = std::max(throws.energy_gain, problem.energy(next) - problem.energy(state));
      state = next;
    }
  }
  return throws;
}

TEST(BoxStep, PathNewtonSolvesEveryStep) {
  PathNewton solver;
  for (const bool warm : {true, false}) {
    const Throws throws = throw_boxes(solver, 12, 200, warm);
    EXPECT_EQ(throws.solved, throws.steps);
    EXPECT_LT(throws.deepest, 1e-9);
    // A contact point that moves within its step can gain a little; an explosion would be joules.
    EXPECT_LT(throws.energy_gain, 1e-2);
  }
}

TEST(BoxStep, SemismoothNewtonSolvesNearlyEveryStepFromTheStepBefore) {
  SemismoothNewton solver;
  const Throws throws = throw_boxes(solver, 12, 200, /*warm=*/true);
  EXPECT_GE(throws.solved, throws.steps - 3);
  EXPECT_LT(throws.deepest, 1e-9);
}

TEST(BoxStep, ABoxOnASlopeRestsWithItsContactPointWhereTheTorquesBalance) {
  BoxScene scene;
  scene.slope = std::atan(0.3);
  BoxState state;
  state.q << 0.0, 0.5, 0.0;
  const BoxStep problem(scene, state);
  for (const SolverKind first : {SolverKind::path_newton, SolverKind::semismooth_newton}) {
    SolverChainOptions options;
    options.first = first;
    SolverChain chain(options);
    VectorXd z = problem.predicted_start();
    const SolveReport report = chain.solve(problem, z);
    ASSERT_TRUE(report.solved()) << describe(report, problem);
    EXPECT_LT(z.head(3).norm(), 1e-9) << "at rest, for mu = 0.5 > 0.3";
    EXPECT_NEAR(z[3], 0.15, 1e-8) << "downhill by half the height times tan(slope)";
    EXPECT_NEAR(z[10] / z[9], -0.3, 1e-8);
  }
}

TEST(BoxStep, AFlatBoxInTheAirNeedsNoContactPoint) {
  BoxState state;
  state.q << 0.0, 3.0, 0.0;
  const BoxStep problem({}, state);
  VectorXd f(BoxStep::unknowns);
  Eigen::MatrixXd jacobian(BoxStep::unknowns, BoxStep::unknowns);
  VectorXd start = problem.predicted_start();
  start[1] = 0.4;  // some work to do
  start[3] = 0.2;
  problem.evaluate(start, f, &jacobian);
  EXPECT_LT(jacobian.fullPivLu().rank(), BoxStep::unknowns);
  PathNewton path;
  SemismoothNewton semismooth;
  for (ComplementaritySolver* solver :
       {static_cast<ComplementaritySolver*>(&path), static_cast<ComplementaritySolver*>(&semismooth)}) {
    VectorXd z = start;
    const SolveReport report = solver->solve(problem, z);
    EXPECT_TRUE(report.solved()) << describe(report, problem);
    EXPECT_LE(report.iterations, 8);
    EXPECT_LE(std::abs(z[3]), 0.5 + 1e-9);
  }
}

TEST(BoxStep, ItsJacobianIsTheDerivative) {
  BoxState state;
  state.q << 0.1, 0.6, 0.3;
  const BoxStep problem({}, state);
  VectorXd z = VectorXd::LinSpaced(BoxStep::unknowns, 0.1, 1.3);
  VectorXd f(BoxStep::unknowns), above(BoxStep::unknowns), below(BoxStep::unknowns);
  Eigen::MatrixXd jacobian(BoxStep::unknowns, BoxStep::unknowns);
  problem.evaluate(z, f, &jacobian);
  for (Eigen::Index j = 0; j < z.size(); ++j) {
    const double at = z[j];
    z[j] = at + 1e-6;
    problem.evaluate(z, above, nullptr);
    z[j] = at - 1e-6;
    problem.evaluate(z, below, nullptr);
    z[j] = at;
    EXPECT_LT(((above - below) / 2e-6 - jacobian.col(j)).norm(), 1e-8) << j;
  }
}

}  // namespace
}  // namespace touchstone::testing
