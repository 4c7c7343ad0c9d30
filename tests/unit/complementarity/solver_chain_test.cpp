#include "core/complementarity/solver_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/checks.h"

namespace touchstone {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using problems::FunctionProblem;
using problems::TestProblem;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SolverChain, SolvesEveryStartOfTheTable) {
  for (const SolverKind first : {SolverKind::path_newton, SolverKind::semismooth_newton}) {
    SolverChainOptions options;
    options.first = first;
    SolverChain chain(options);
    for (const TestProblem& test : problems::all_problems()) {
      for (const VectorXd& start : test.starts) {
        VectorXd z = start;
        const SolveReport report = chain.solve(*test.problem, z);
        testing::expect_solved(report, test, z, 1e-10);
        EXPECT_EQ(report.stages.values()[0].solver, first);
      }
    }
  }
}

TEST(SolverChain, IsItsFirstSolverWhereThatSucceeds) {
  const TestProblem test = problems::kojshin();
  VectorXd chained = test.starts[0];
  VectorXd alone = test.starts[0];
  SolverChain chain;
  PathNewton path;
  const SolveReport report = chain.solve(*test.problem, chained);
  const SolveReport expected = path.solve(*test.problem, alone);
  EXPECT_EQ(chained, alone);
  EXPECT_EQ(report.iterations, expected.iterations);
  EXPECT_EQ(report.evaluations, expected.evaluations);
  ASSERT_EQ(report.stages.count(), 1);
  EXPECT_EQ(report.stages.values()[0].start, StageStart::given);
  EXPECT_EQ(report.stages.values()[0].status, SolveStatus::solved);
}

TEST(SolverChain, RecordsEveryStageOfAHardStart) {
  const TestProblem test = problems::billups();
  SolverChain chain;
  VectorXd z = VectorXd::Zero(1);
  const SolveReport report = chain.solve(*test.problem, z);
  ASSERT_TRUE(report.solved());
  const auto stages = report.stages.values();
  ASSERT_GT(stages.size(), 3U);
  EXPECT_EQ(stages[0].start, StageStart::given);
  EXPECT_EQ(stages[0].solver, SolverKind::path_newton);
  EXPECT_EQ(stages[1].start, StageStart::given);
  EXPECT_EQ(stages[1].solver, SolverKind::semismooth_newton);
  EXPECT_EQ(stages[2].start, StageStart::crash);
  EXPECT_EQ(stages[2].solver, SolverKind::path_newton);
  EXPECT_EQ(stages[3].start, StageStart::proximal);
  EXPECT_EQ(stages[3].weight, 1.0);
  for (std::size_t i = 0; i + 1 < stages.size(); ++i) {
    if (stages[i].weight > 0.0) continue;  // a proximal step, which may be solved
    EXPECT_NE(stages[i].status, SolveStatus::solved);
  }
  EXPECT_EQ(stages.back().status, SolveStatus::solved);
  EXPECT_EQ(stages.back().residual, report.residual);
}

TEST(SolverChain, AProblemWithoutASolutionKeepsTheBestPointAndSaysWhy) {
  const FunctionProblem problem(VectorXd::Constant(1, -infinity), VectorXd::Constant(1, infinity),
                                [](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
                                  f[0] = x[0] * x[0] + 1;
                                  if (jacobian != nullptr) (*jacobian)(0, 0) = 2 * x[0];
                                });
  SolverChainOptions options;
  options.restarts = 4;
  SolverChain chain(options);
  VectorXd z = VectorXd::Constant(1, 3.0);
  const SolveReport report = chain.solve(problem, z);
  testing::expect_honest(report, problem, z, 1e-10);
  EXPECT_FALSE(report.solved());
  EXPECT_NEAR(report.residual, 1.0, 1e-3);
  EXPECT_EQ(report.stages.count(),
            11);  // given twice, crash, proximal three times and once without, 4 perturbed
}

TEST(SolverChain, FindsADefinedStartNearAnUndefinedOne) {
  const FunctionProblem problem(VectorXd::Constant(1, -infinity), VectorXd::Constant(1, infinity),
                                [](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
                                  f[0] = std::log(x[0]);
                                  if (jacobian != nullptr) (*jacobian)(0, 0) = 1 / x[0];
                                });
  SolverChain chain;
  VectorXd z = VectorXd::Constant(1, -0.5);
  const SolveReport report = chain.solve(problem, z);
  EXPECT_TRUE(report.solved()) << describe(report, problem);
  EXPECT_EQ(report.stages.values()[0].status, SolveStatus::non_finite);
  EXPECT_NEAR(z[0], 1.0, 1e-9);
}

TEST(SolverChain, RepeatsItselfToTheBit) {
  const TestProblem test = problems::billups();
  SolverChain chain;
  VectorXd first = VectorXd::Zero(1);
  VectorXd second = VectorXd::Zero(1);
  const SolveReport a = chain.solve(*test.problem, first);
  const SolveReport b = chain.solve(*test.problem, second);
  EXPECT_EQ(first, second);
  EXPECT_EQ(a.evaluations, b.evaluations);
}

TEST(ProximalProblem, AddsItsTermToFAndJacobian) {
  const TestProblem test = problems::munson1();
  const VectorXd center = Eigen::Vector3d(1, 2, 3);
  const VectorXd z = Eigen::Vector3d(2, 2, 1);
  ProximalProblem proximal;
  proximal.bind(*test.problem, center, 0.5);
  VectorXd f(3), shifted(3);
  MatrixXd jacobian(3, 3), shifted_jacobian(3, 3);
  test.problem->evaluate(z, f, &jacobian);
  proximal.evaluate(z, shifted, &shifted_jacobian);
  EXPECT_EQ(shifted - f, VectorXd(Eigen::Vector3d(0.5, 0, -1)));
  EXPECT_EQ(shifted_jacobian - jacobian, MatrixXd(0.5 * MatrixXd::Identity(3, 3)));
  EXPECT_EQ(proximal.row_name(1), "row 1");
}

}  // namespace
}  // namespace touchstone
