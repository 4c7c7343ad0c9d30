#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/checks.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using problems::FunctionProblem;
using problems::TestProblem;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double tolerance = 1e-10;

TEST(TestProblems, EveryJacobianIsTheDerivative) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(0.1, 2.0);
  for (const TestProblem& test : problems::all_problems()) {
    const Index n = test.problem->size();
    VectorXd f(n), above(n), below(n);
    MatrixXd jacobian = MatrixXd::Constant(n, n, std::nan(""));
    for (int sample = 0; sample < 3; ++sample) {
      VectorXd z = VectorXd::NullaryExpr(n, [&] { return uniform(engine); });
      test.problem->evaluate(z, f, &jacobian);
      for (Index j = 0; j < n; ++j) {
        const double step = 1e-5 * z[j];
        const double at = z[j];
        z[j] = at + step;
        test.problem->evaluate(z, above, nullptr);
        z[j] = at - step;
        test.problem->evaluate(z, below, nullptr);
        z[j] = at;
        const VectorXd difference = (above - below) / (2 * step);
        EXPECT_LT((difference - jacobian.col(j)).norm(), 1e-6 * (1.0 + jacobian.col(j).norm()))
            << test.name << " column " << j;
      }
    }
  }
}

TEST(TestProblems, TheListedSolutionsAreSolutions) {
  for (const TestProblem& test : problems::all_problems()) {
    for (const VectorXd& solution : test.solutions) {
      // Six decimals of z, and the slope of F: nash's costs are steep.
      EXPECT_LT(natural_residual(*test.problem, solution).value, test.name.starts_with("nash") ? 1e-4 : 1e-9)
          << test.name;
    }
  }
}

/// Both methods, by the same tests.
class Newton : public ::testing::TestWithParam<SolverKind> {
 protected:
  Newton() {
    if (GetParam() == SolverKind::path_newton) {
      solver_ = std::make_unique<PathNewton>();
    } else {
      solver_ = std::make_unique<SemismoothNewton>();
    }
  }

  SolveReport solve(const MixedComplementarityProblem& problem, VectorXd& z) {
    return solver_->solve(problem, z);
  }

 private:
  std::unique_ptr<ComplementaritySolver> solver_;
};

INSTANTIATE_TEST_SUITE_P(Both, Newton,
                         ::testing::Values(SolverKind::path_newton, SolverKind::semismooth_newton),
                         [](const auto& test_info) { return std::string(to_string(test_info.param)); });

TEST_P(Newton, SolvesTheTableFromEveryStartButBillupsTraps) {
  for (const TestProblem& test : problems::all_problems()) {
    for (const VectorXd& start : test.starts) {
      VectorXd z = start;
      const SolveReport report = solve(*test.problem, z);
      if (test.name == "billups" && start[0] < 0.9) {
        EXPECT_FALSE(report.solved()) << "not a trap any more: move it to the others";
        testing::expect_honest(report, *test.problem, z, tolerance);
        continue;
      }
      testing::expect_solved(report, test, z, tolerance);
    }
  }
}

TEST_P(Newton, ConvergesQuadratically) {
  const TestProblem test = problems::nash10();
  VectorXd z = test.starts[3];
  const SolveReport report = solve(*test.problem, z);
  ASSERT_TRUE(report.solved());
  const auto history = report.history.values();
  ASSERT_GE(history.size(), 3U);
  EXPECT_LT(history[history.size() - 1], 1e-3 * history[history.size() - 2]);
  EXPECT_EQ(report.history.count(), report.iterations + 1);
}

TEST_P(Newton, AStartThatIsASolutionIsLeftAlone) {
  VectorXd z = problems::path4().solutions[0];
  const VectorXd start = z;
  const SolveReport report = solve(*problems::path4().problem, z);
  EXPECT_TRUE(report.solved());
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.evaluations, 1);
  EXPECT_EQ(z, start);
}

TEST_P(Newton, AnswersDoNotDependOnWhatWasSolvedBefore) {
  const TestProblem test = problems::josephy();
  VectorXd first = test.starts[2];
  const SolveReport fresh = solve(*test.problem, first);
  for (const TestProblem& other : problems::all_problems()) {
    VectorXd z = other.starts[0];
    [[maybe_unused]] const SolveReport report = solve(*other.problem, z);
  }
  VectorXd second = test.starts[2];
  const SolveReport again = solve(*test.problem, second);
  EXPECT_EQ(first, second);
  EXPECT_EQ(fresh.iterations, again.iterations);
  EXPECT_EQ(fresh.evaluations, again.evaluations);
}

TEST_P(Newton, AnEquationWithoutARootIsALocalMinimum) {
  const FunctionProblem problem(VectorXd::Constant(1, -infinity), VectorXd::Constant(1, infinity),
                                [](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
                                  f[0] = x[0] * x[0] + 1;
                                  if (jacobian != nullptr) (*jacobian)(0, 0) = 2 * x[0];
                                });
  for (const double start : {-3.0, 0.0, 0.5, 40.0}) {
    VectorXd z = VectorXd::Constant(1, start);
    const SolveReport report = solve(problem, z);
    testing::expect_honest(report, problem, z, tolerance);
    EXPECT_TRUE(report.status == SolveStatus::local_minimum || report.status == SolveStatus::stalled)
        << describe(report, problem);
    EXPECT_NEAR(report.residual, 1.0, 0.05);
  }
}

TEST_P(Newton, InfeasibleRowsAreNotSolved) {
  MatrixXd m(2, 2);
  m << -1, 0, 0, 1;
  const FunctionProblem problem(2, problems::linear(m, Eigen::Vector2d(-1, -1)));
  for (const double start : {0.0, 1.0, 30.0}) {
    VectorXd z = VectorXd::Constant(2, start);
    const SolveReport report = solve(problem, z);
    testing::expect_honest(report, problem, z, tolerance);
    EXPECT_FALSE(report.solved());
  }
}

TEST_P(Newton, ContradictoryEquationsAreNotSolved) {
  const FunctionProblem problem(VectorXd::Constant(2, -infinity), VectorXd::Constant(2, infinity),
                                problems::linear(MatrixXd::Ones(2, 2), Eigen::Vector2d(0, -1)));
  VectorXd z = Eigen::Vector2d(0.3, 0.4);
  const SolveReport report = solve(problem, z);
  testing::expect_honest(report, problem, z, tolerance);
  EXPECT_FALSE(report.solved());
  EXPECT_LE(report.residual, 0.71) << "the best point seen, not the last";
}

TEST_P(Newton, AnUndefinedStartIsSaidToBeSo) {
  const FunctionProblem problem(2, [](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
    f << x[0], std::log(x[1] - 1);
    if (jacobian != nullptr) *jacobian << 1, 0, 0, 1 / (x[1] - 1);
  });
  VectorXd z = Eigen::Vector2d(1, 0.5);
  const SolveReport report = solve(problem, z);
  EXPECT_EQ(report.status, SolveStatus::non_finite);
  EXPECT_EQ(report.residual, infinity);
  EXPECT_EQ(report.worst_row, 1);
  z[1] = 40;
  EXPECT_TRUE(solve(problem, z).solved()) << "and from a defined one it never steps where F is not defined";
  EXPECT_NEAR(z[1], 2, 1e-9);
}

// Projection of a force onto a ball: F is piecewise smooth, and the problem hands out one element of its
// Jacobian.
TEST_P(Newton, TakesRowsThatAreOnlySemismooth) {
  const double limit = 0.5;
  for (const double push : {0.2, 0.5, 3.0}) {
    const FunctionProblem problem(
        VectorXd::Constant(4, -infinity), VectorXd::Constant(4, infinity),
        [=](const VectorXd& z, VectorXd& f, MatrixXd* jacobian) {
          // z = [v, p]: v = push + p (momentum), p = projection of p - v onto the ball of radius `limit`.
          const Eigen::Vector2d target = z.tail<2>() - z.head<2>();
          const double norm = target.norm();
          const bool outside = norm > limit;
          Eigen::Matrix2d slope = Eigen::Matrix2d::Identity();
          Eigen::Vector2d projected = target;
          if (outside) {
            projected *= limit / norm;
            slope = limit / norm * (slope - target * target.transpose() / (norm * norm));
          }
          f.head<2>() = z.head<2>() - z.tail<2>() - Eigen::Vector2d(push, 0.3 * push);
          f.tail<2>() = z.tail<2>() - projected;
          if (jacobian == nullptr) return;
          jacobian->topLeftCorner<2, 2>().setIdentity();
          jacobian->topRightCorner<2, 2>() = -Eigen::Matrix2d::Identity();
          jacobian->bottomLeftCorner<2, 2>() = slope;
          jacobian->bottomRightCorner<2, 2>() = Eigen::Matrix2d::Identity() - slope;
        });
    for (const double start : {0.0, 5.0}) {
      VectorXd z = VectorXd::Constant(4, start);
      const SolveReport report = solve(problem, z);
      EXPECT_TRUE(report.solved()) << describe(report, problem);
      const double load = std::hypot(push, 0.3 * push);
      EXPECT_NEAR(z.tail<2>().norm(), std::min(load, limit), 1e-9);
      EXPECT_NEAR(z.head<2>().norm(), std::max(load - limit, 0.0), 1e-9);
    }
  }
}

TEST_P(Newton, ASingularConsistentJacobianDoesNotMoveWhatItDoesNotDetermine) {
  const TestProblem test = problems::undetermined();
  for (const VectorXd& start : test.starts) {
    VectorXd z = start;
    const SolveReport report = solve(*test.problem, z);
    testing::expect_solved(report, test, z, tolerance);
    EXPECT_NEAR(z[0], 1.0, 1e-9);
    EXPECT_NEAR(z[1], start[1], 1e-12);
  }
}

TEST_P(Newton, AFixedUnknownStaysAndItsRowSaysNothing) {
  // 2 z_1 - z_2 - 4 = 0 with z_2 = 3 fixed, whatever F_2.
  const FunctionProblem problem(
      Eigen::Vector2d(-infinity, 3), Eigen::Vector2d(infinity, 3),
      problems::linear((Eigen::Matrix2d() << 2, -1, 5, 1).finished(), Eigen::Vector2d(-4, 70)));
  for (const double start : {0.0, 3.0, 50.0}) {
    VectorXd z = VectorXd::Constant(2, start);
    const SolveReport report = solve(problem, z);
    EXPECT_TRUE(report.solved()) << describe(report, problem);
    EXPECT_NEAR(z[0], 3.5, 1e-9);
    EXPECT_NEAR(z[1], 3.0, 1e-9);
  }
}

TEST_P(Newton, NoUnknownsAreNoProblem) {
  const FunctionProblem problem(0, [](const VectorXd&, VectorXd&, MatrixXd*) {});
  VectorXd z(0);
  const SolveReport report = solve(problem, z);
  EXPECT_TRUE(report.solved());
  EXPECT_EQ(report.worst_row, -1);
}

TEST(PathNewton, WithoutAChangeOfTheActiveSetThereIsNoPivot) {
  const TestProblem test = problems::nash10();
  PathNewton solver;
  VectorXd z = test.starts[3];
  const SolveReport report = solver.solve(*test.problem, z);
  EXPECT_TRUE(report.solved());
  EXPECT_GT(report.iterations, 2);
  z = test.solutions[0];
  const SolveReport warm = solver.solve(*test.problem, z);
  EXPECT_TRUE(warm.solved());
  EXPECT_EQ(warm.pivots, 0);
}

TEST(PathNewton, ALinearProblemIsOneStep) {
  PathNewton solver;
  for (const TestProblem& test :
       {problems::munson1(), problems::path4(), problems::murty(8), problems::obstacle(8)}) {
    for (const VectorXd& start : test.starts) {
      VectorXd z = start;
      const SolveReport report = solver.solve(*test.problem, z);
      EXPECT_TRUE(report.solved());
      EXPECT_EQ(report.iterations, 1) << test.name;
    }
  }
}

}  // namespace
}  // namespace touchstone
