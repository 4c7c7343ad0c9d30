// A membrane between two obstacles, against projected Gauss-Seidel, which shares nothing with the solvers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "experiments/problems/literature.h"
#include "tests/unit/complementarity/checks.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of  l <= z _|_ M z + q <= u  with M symmetric and positive definite (Cryer 1971).
VectorXd projected_gauss_seidel(const problems::FunctionProblem& problem) {
  const Index n = problem.size();
  MatrixXd m(n, n);
  VectorXd q(n);
  VectorXd z = VectorXd::Zero(n);
  problem.evaluate(z, q, &m);
  for (int sweep = 0; sweep < 20000; ++sweep) {
    double change = 0.0;
    for (Index i = 0; i < n; ++i) {
      const double target = z[i] - (m.col(i).dot(z) + q[i]) / m(i, i);
      const double next = std::clamp(target, problem.lower()[i], problem.upper()[i]);
      change = std::max(change, std::abs(next - z[i]));
      z[i] = next;
    }
    if (change < 1e-14) break;
  }
  return z;
}

TEST(Obstacle, BothMethodsAgreeWithGaussSeidel) {
  for (const Index side : {5, 10, 20}) {
    const problems::TestProblem test = problems::obstacle(side);
    const VectorXd expected = projected_gauss_seidel(*test.problem);
    ASSERT_LT(natural_residual(*test.problem, expected).value, 1e-11);
    const Index n = expected.size();
    const auto at_lower = (expected.array() == test.problem->lower().array()).count();
    const auto at_upper = (expected.array() == test.problem->upper().array()).count();
    EXPECT_GT(at_lower, 0) << "both obstacles are to be touched";
    EXPECT_GT(at_upper, 0);
    EXPECT_LT(at_lower + at_upper, n);
    PathNewton path;
    SemismoothNewton semismooth;
    for (ComplementaritySolver* solver :
         {static_cast<ComplementaritySolver*>(&path), static_cast<ComplementaritySolver*>(&semismooth)}) {
      for (const VectorXd& start : test.starts) {
        VectorXd z = start;
        testing::expect_solved(solver->solve(*test.problem, z), test, z, 1e-10);
        EXPECT_LT((z - expected).lpNorm<Eigen::Infinity>(), 1e-8) << side;
      }
    }
  }
}

}  // namespace
}  // namespace touchstone
