#include "core/complementarity/crash_start.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/complementarity/path_newton.h"
#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/checks.h"

namespace touchstone {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using problems::FunctionProblem;
using problems::TestProblem;

constexpr double infinity = std::numeric_limits<double>::infinity();

SolveReport solve_with(int crash_steps, const MixedComplementarityProblem& problem, VectorXd& z) {
  PathNewtonOptions options;
  options.crash_steps = crash_steps;
  PathNewton solver(options);
  return solver.solve(problem, z);
}

TEST(CrashStart, FindsTheActiveSetOfAMembraneWithoutPivots) {
  const TestProblem test = problems::obstacle(12);
  int saved = 0;
  for (const VectorXd& start : test.starts) {
    VectorXd plain = start, crashed = start;
    const SolveReport without = solve_with(0, *test.problem, plain);
    const SolveReport with = solve_with(50, *test.problem, crashed);
    ASSERT_TRUE(without.solved() && with.solved());
    EXPECT_NEAR((plain - crashed).lpNorm<Eigen::Infinity>(), 0.0, 1e-9);
    EXPECT_LE(with.pivots, without.pivots);
    saved += without.pivots - with.pivots;
  }
  EXPECT_GE(saved, 100) << "a step changes the active set of 144 unknowns in many places, a pivot in one";
}

TEST(CrashStart, IsTheSameForASparseJacobian) {
  const problems::SparseLinearProblem sparse = problems::sparse_obstacle(10);
  const TestProblem dense = problems::obstacle(10);
  VectorXd a = VectorXd::Zero(100), b = VectorXd::Zero(100);
  const SolveReport one = solve_with(50, sparse, a);
  const SolveReport other = solve_with(50, *dense.problem, b);
  ASSERT_TRUE(one.solved() && other.solved());
  EXPECT_EQ(one.iterations, other.iterations);
  EXPECT_EQ(one.pivots, other.pivots);
  EXPECT_NEAR((a - b).lpNorm<Eigen::Infinity>(), 0.0, 1e-10);
}

TEST(CrashStart, TakesNoMoreStepsThanAllowed) {
  const TestProblem test = problems::obstacle(12);
  for (const int steps : {0, 1, 2}) {
    MeritSearch search{SearchOptions{}};
    ASSERT_TRUE(search.start(*test.problem, test.starts[0]));
    CrashStart crash;
    crash.run(*test.problem, steps, search);
    EXPECT_LE(search.report().iterations, steps);
    EXPECT_EQ(search.report().iterations == 0, steps == 0);
  }
}

TEST(CrashStart, EveryStepStaysWithinTheBoundsAndTheMeritFalls) {
  const TestProblem test = problems::obstacle(12);
  MeritSearch search{SearchOptions{}};
  ASSERT_TRUE(search.start(*test.problem, test.starts[2]));
  CrashStart crash;
  const double before = search.current().merit;
  crash.run(*test.problem, 50, search);
  EXPECT_LT(search.current().merit, before);
  EXPECT_TRUE((search.current().z.array() >= test.problem->lower().array()).all());
  EXPECT_TRUE((search.current().z.array() <= test.problem->upper().array()).all());
}

TEST(CrashStart, ASingularJacobianIsPerturbed) {
  // Two equations that say the same, and say it wrongly at the start: the matrix of a step is singular.
  const auto function = [](const VectorXd& z, VectorXd& f, MatrixXd* jacobian) {
    f.setConstant(z[0] + z[1] - 1);
    if (jacobian != nullptr) jacobian->setOnes();
  };
  const FunctionProblem problem(VectorXd::Constant(2, -infinity), VectorXd::Constant(2, infinity), function);
  MeritSearch search{SearchOptions{}};
  ASSERT_TRUE(search.start(problem, VectorXd::Zero(2)));
  CrashStart crash;
  crash.run(problem, 10, search);
  EXPECT_GE(search.report().iterations, 1);
  EXPECT_NEAR(search.current().z.sum(), 1.0, 1e-5);
}

TEST(CrashStart, SolutionsOfTheTableStayWhereTheyAre) {
  for (const TestProblem& test : problems::all_problems()) {
    for (const VectorXd& solution : test.solutions) {
      MeritSearch search{SearchOptions{.tolerance = 1e-4}};  // the table is exact to 1e-6, F steep
      ASSERT_TRUE(search.start(*test.problem, solution)) << test.name;
      CrashStart crash;
      crash.run(*test.problem, 10, search);
      EXPECT_EQ(search.report().iterations, 0) << test.name;
    }
  }
}

}  // namespace
}  // namespace touchstone
