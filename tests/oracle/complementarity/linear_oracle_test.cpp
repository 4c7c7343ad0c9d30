// Linear complementarity problems from fixed seeds, against what the solvers have no part in: solutions that
// were chosen before the problem, and the enumeration of all complementary bases, which also knows when there
// is no solution.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/path_newton.h"
#include "core/complementarity/residual.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/complementarity/solver_chain.h"
#include "experiments/problems/literature.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct LinearProblem {
  MatrixXd m;
  VectorXd q, lower, upper;
  VectorXd solution;  ///< by construction

  [[nodiscard]] double residual(const VectorXd& z) const {
    return natural_residual(lower, upper, z, m * z + q).value;
  }
};

class Generator {
 public:
  explicit Generator(unsigned seed) : engine_(seed) {}

  double normal() { return normal_(engine_); }
  double positive() { return 0.1 + std::abs(normal()); }
  Index below(Index n) { return static_cast<Index>(engine_() % static_cast<unsigned>(n)); }
  MatrixXd matrix(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [this] { return normal(); });
  }

  /// Positive definite, with a skew part as large as the symmetric one: a P-matrix that is not symmetric.
  MatrixXd p_matrix(Index n) {
    const MatrixXd a = matrix(n, n);
    const MatrixXd b = matrix(n, n);
    return a * a.transpose() / static_cast<double>(n) + 0.5 * (b - b.transpose()) +
           0.1 * MatrixXd::Identity(n, n);
  }

  /// Positive z or positive slack in each row, or neither in `degenerate` of them (a part, 0 to 1).
  LinearProblem complementarity(Index n, double degenerate) {
    LinearProblem problem = frame(n);
    VectorXd slack = VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
      if (unit() < degenerate) continue;
      (below(2) == 0 ? problem.solution[i] : slack[i]) = positive();
    }
    problem.q = slack - problem.m * problem.solution;
    return problem;
  }

  /// Free unknowns, one bound, the other, both; some of them at a bound without a slack.
  LinearProblem mixed(Index n) {
    LinearProblem problem = frame(n);
    VectorXd slack = VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const Index kind = below(4);
      const double at = normal();
      problem.lower[i] = kind == 1 || kind == 3 ? at : -infinity;
      problem.upper[i] = kind == 2 ? at : (kind == 3 ? at + positive() : infinity);
      problem.solution[i] = at;
      const Index place = below(3);  // inside, at a bound with slack, at a bound without
      if (kind == 1 || kind == 3) {
        if (place == 0) problem.solution[i] = kind == 3 ? 0.5 * (at + problem.upper[i]) : at + positive();
        if (place == 1) slack[i] = positive();
        if (kind == 3 && place == 1 && below(2) == 0) {
          problem.solution[i] = problem.upper[i];
          slack[i] = -slack[i];
        }
      } else if (kind == 2) {
        if (place == 0) problem.solution[i] = at - positive();
        if (place == 1) slack[i] = -positive();
      }
    }
    problem.q = slack - problem.m * problem.solution;
    return problem;
  }

  /// KKT conditions of  minimise x^T H x / 2 + c^T x  subject to  A x = b, x >= 0  with free multipliers:
  /// monotone, with a block of zeros on the diagonal; H of the given rank.
  LinearProblem programme(Index n, Index rank) {
    const Index rows = std::max<Index>(1, n / 4);
    const MatrixXd root = matrix(n, rank);
    const MatrixXd a = matrix(rows, n);
    LinearProblem problem = frame(n + rows);
    problem.m.setZero();
    problem.m.topLeftCorner(n, n) = root * root.transpose();
    problem.m.topRightCorner(n, rows) = -a.transpose();
    problem.m.bottomLeftCorner(rows, n) = a;
    problem.lower.tail(rows).setConstant(-infinity);
    VectorXd slack = VectorXd::Zero(n + rows);
    for (Index i = 0; i < n; ++i) (below(2) == 0 ? problem.solution[i] : slack[i]) = positive();
    for (Index i = n; i < n + rows; ++i) problem.solution[i] = normal();
    problem.q = slack - problem.m * problem.solution;
    return problem;
  }

 private:
  double unit() { return static_cast<double>(below(1 << 20)) / (1 << 20); }
  LinearProblem frame(Index n) {
    return {p_matrix(n), VectorXd::Zero(n), VectorXd::Zero(n), VectorXd::Constant(n, infinity),
            VectorXd::Zero(n)};
  }

  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

/// Solves by Lemke, by the path from two starts and by both Newton methods; all must agree, with the solution
/// if unique.
void expect_all_solve(const LinearProblem& problem, bool unique, const std::string& label) {
  const Index n = problem.q.size();
  const auto check = [&](const VectorXd& z, const std::string& who) {
    EXPECT_LT(problem.residual(z), 1e-9) << label << " " << who;
    if (unique) {
      EXPECT_LT((z - problem.solution).lpNorm<Eigen::Infinity>(), 1e-7) << label << " " << who;
    }
  };
  LinearPath path;
  VectorXd z;
  EXPECT_TRUE(path.lemke(problem.m, problem.q, problem.lower, problem.upper, VectorXd::Zero(n), z).solved())
      << label;
  check(z, "lemke");
  const problems::FunctionProblem function(problem.lower, problem.upper,
                                           problems::linear(problem.m, problem.q));
  PathNewton path_newton;
  SemismoothNewton semismooth_newton;
  for (const double start : {0.0, 3.0}) {
    const VectorXd inside = VectorXd::Constant(n, start).cwiseMax(problem.lower).cwiseMin(problem.upper);
    z = inside;
    EXPECT_TRUE(
        path.follow(problem.m, problem.m * z + problem.q, problem.lower, problem.upper, 0.0, z).solved())
        << label;
    check(z, "path");
    z = inside;
    EXPECT_TRUE(path_newton.solve(function, z).solved()) << label;
    check(z, "path Newton");
    z = inside;
    EXPECT_TRUE(semismooth_newton.solve(function, z).solved()) << label;
    check(z, "semismooth Newton");
  }
}

TEST(LinearOracle, PMatrices) {
  Generator generator(11);
  for (const Index n : {1, 2, 3, 5, 10, 25, 60}) {
    for (int sample = 0; sample < 10; ++sample) {
      expect_all_solve(generator.complementarity(n, 0.0), true, "P-matrix " + std::to_string(n));
    }
  }
}

TEST(LinearOracle, DegenerateSolutions) {
  Generator generator(12);
  for (const Index n : {2, 5, 10, 25, 60}) {
    for (int sample = 0; sample < 10; ++sample) {
      expect_all_solve(generator.complementarity(n, 0.6), true, "degenerate " + std::to_string(n));
    }
  }
}

TEST(LinearOracle, BoundsOfAllKindsAndFreeUnknowns) {
  Generator generator(13);
  for (const Index n : {1, 2, 4, 10, 25, 60}) {
    for (int sample = 0; sample < 10; ++sample) {
      expect_all_solve(generator.mixed(n), true, "mixed " + std::to_string(n));
    }
  }
}

TEST(LinearOracle, ProgrammesWithFreeMultipliers) {
  Generator generator(14);
  for (const Index n : {3, 6, 12, 25, 50}) {
    for (const Index rank : {Index{0}, n / 2, n}) {
      for (int sample = 0; sample < 6; ++sample) {
        expect_all_solve(generator.programme(n, rank), false,
                         "programme " + std::to_string(n) + " rank " + std::to_string(rank));
      }
    }
  }
}

/// Whether 0 <= z _|_ M z + q >= 0 has a solution, by all 2^n complementary bases.
bool has_solution(const MatrixXd& m, const VectorXd& q) {
  const Index n = q.size();
  for (unsigned mask = 0; mask < (1U << static_cast<unsigned>(n)); ++mask) {
    MatrixXd basis = MatrixXd::Identity(n, n);  // of  w - M z = q
    for (Index j = 0; j < n; ++j) {
      if ((mask >> static_cast<unsigned>(j) & 1U) != 0U) basis.col(j) = -m.col(j);
    }
    const Eigen::FullPivLU<MatrixXd> lu(basis);
    if (lu.isInvertible() && lu.solve(q).minCoeff() >= -1e-9) return true;
  }
  return false;
}

// Arbitrary matrices: a solution is only claimed where there is one, a chain of solvers finds nearly all, and
// where there is none every solver says so.
TEST(LinearOracle, AgainstEnumeration) {
  Generator generator(15);
  int solvable = 0;
  int found_by_chain = 0;
  int found_by_lemke = 0;
  for (int sample = 0; sample < 300; ++sample) {
    const Index n = 2 + sample % 5;
    const MatrixXd m = generator.matrix(n, n);
    const VectorXd q = generator.matrix(n, 1);
    const bool expected = has_solution(m, q);
    const VectorXd upper = VectorXd::Constant(n, infinity);
    VectorXd z;
    LinearPath path;
    const LinearPathResult lemke = path.lemke(m, q, z);
    if (lemke.solved()) {
      EXPECT_LT(natural_residual(VectorXd::Zero(n), upper, z, m * z + q).value, 1e-9);
    }
    SolverChainOptions options;
    options.restarts = 4;
    SolverChain chain(options);
    z = VectorXd::Zero(n);
    const SolveReport report = chain.solve(problems::FunctionProblem(n, problems::linear(m, q)), z);
    if (!expected) {
      EXPECT_FALSE(lemke.solved()) << sample;
      EXPECT_FALSE(report.solved()) << sample;
      continue;
    }
    ++solvable;
    found_by_lemke += lemke.solved() ? 1 : 0;
    found_by_chain += report.solved() ? 1 : 0;
  }
  EXPECT_GT(solvable, 100);
  EXPECT_LT(solvable, 290);
  EXPECT_GE(found_by_lemke, solvable / 2);  // of an arbitrary matrix Lemke promises nothing
  EXPECT_GE(found_by_chain, solvable - 2);
}

// Copositive-plus matrices are those for which a ray proves that there is no solution (Cottle, Pang & Stone,
// 4.4.12).
TEST(LinearOracle, ForMonotoneProblemsLemkeDecides) {
  Generator generator(16);
  int solvable = 0;
  for (int sample = 0; sample < 300; ++sample) {
    const Index n = 2 + sample % 5;
    const MatrixXd root = generator.matrix(n, std::max<Index>(1, n / 2));
    const MatrixXd skew = generator.matrix(n, n);
    const bool with_skew = sample % 2 == 0;
    const MatrixXd m = root * root.transpose() + (with_skew ? 1.0 : 0.0) * (skew - skew.transpose());
    const VectorXd q = generator.matrix(n, 1);
    VectorXd z;
    LinearPath path;
    const LinearPathResult lemke = path.lemke(m, q, z);
    const bool expected = has_solution(m, q);
    solvable += expected ? 1 : 0;
    EXPECT_EQ(lemke.status, expected ? LinearPathStatus::solved : LinearPathStatus::ray) << sample;
  }
  EXPECT_GT(solvable, 50);
  EXPECT_LT(solvable, 250);
}

}  // namespace
}  // namespace touchstone
