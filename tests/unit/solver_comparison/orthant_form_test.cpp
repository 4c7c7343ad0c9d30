#include "experiments/solver_comparison/orthant_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/complementarity/residual.h"
#include "core/complementarity/solver_chain.h"
#include "experiments/problems/literature.h"

namespace touchstone::solver_comparison {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using problems::FunctionProblem;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Every kind of bounds: free, below, above, both.
FunctionProblem mixed() {
  MatrixXd m(5, 5);
  m << 4, 1, 0, -1, 0, 0, 3, 1, 0, 1, 1, 0, 5, 0, -1, 0, -1, 0, 4, 1, 1, 0, 1, 0, 3;
  VectorXd q(5), lower(5), upper(5);
  q << 1, -9, 4, -30, 12;
  lower << -infinity, 0.5, -infinity, -1, -2;
  upper << infinity, infinity, -0.25, 2, 1;
  return {lower, upper, problems::linear(m, q)};
}

/// The form as a problem: its first rows equations, the rest of them 0 <= x _|_ f >= 0.
FunctionProblem as_problem(OrthantForm& form) {
  VectorXd lower = VectorXd::Constant(form.size(), -infinity);
  lower.tail(form.inequalities()).setZero();
  return {lower, VectorXd::Constant(form.size(), infinity),
          [&form](const VectorXd& x, VectorXd& f, MatrixXd* jacobian) {
            form.evaluate(x.data(), f.data(), jacobian == nullptr ? nullptr : jacobian->data());
          }};
}

TEST(OrthantForm, CountsEquationsAndInequalities) {
  const FunctionProblem problem = mixed();
  const OrthantForm form(problem);
  EXPECT_EQ(form.equations(), 1);
  EXPECT_EQ(form.inequalities(), 6);  // four, and one beside each of the two boxed
}

TEST(OrthantForm, JacobianMatchesCentralDifferences) {
  const FunctionProblem problem = mixed();
  OrthantForm form(problem);
  const Index n = form.size();
  const VectorXd x = VectorXd::LinSpaced(n, 0.3, 1.7);
  VectorXd f(n), above(n), below(n);
  MatrixXd jacobian(n, n);
  form.evaluate(x.data(), f.data(), jacobian.data());
  for (Index j = 0; j < n; ++j) {
    VectorXd moved = x;
    moved[j] += 0.5;
    form.evaluate(moved.data(), above.data(), nullptr);
    moved[j] -= 1.0;
    form.evaluate(moved.data(), below.data(), nullptr);
    EXPECT_LE((above - below - jacobian.col(j)).norm(), 1e-13) << j;  // it is linear
  }
}

TEST(OrthantForm, ItsSolutionsAreThoseOfTheProblem) {
  SolverChain chain;
  const FunctionProblem problem = mixed();
  VectorXd z = VectorXd::Zero(5);
  ASSERT_TRUE(chain.solve(problem, z).solved());
  EXPECT_EQ((z.array() == 2.0).count() + (z.array() == -2.0).count(), 2) << "some at their second bound";
  OrthantForm form(problem);
  const FunctionProblem transformed = as_problem(form);
  EXPECT_LE(natural_residual(transformed, form.from(z)).value, 1e-9);
  VectorXd x = VectorXd::Zero(form.size());
  ASSERT_TRUE(chain.solve(transformed, x).solved());
  EXPECT_LE(natural_residual(problem, form.to(x)).value, 1e-9);
  EXPECT_LE((form.to(x) - z).norm(), 1e-9);
}

TEST(OrthantForm, ProblemsOfTheTableAreSolvedThroughIt) {
  SolverChain chain;
  for (const problems::TestProblem& test : problems::all_problems()) {
    OrthantForm form(*test.problem);
    const FunctionProblem transformed = as_problem(form);
    for (const VectorXd& start : test.starts) {
      VectorXd x = form.from(start);
      ASSERT_TRUE(chain.solve(transformed, x).solved()) << test.name;
      EXPECT_LE(natural_residual(*test.problem, form.to(x)).value, 1e-9) << test.name;
    }
  }
}

TEST(OrthantForm, AStartIsPutWithinTheBoundsAndComesBack) {
  const FunctionProblem problem = mixed();
  OrthantForm form(problem);
  VectorXd z(5);
  z << -7, 2, -3, 1, -1.5;  // within
  EXPECT_LE((form.to(form.from(z)) - z).norm(), 1e-14);
  z << 3, -5, 8, 9, -9;  // outside, but for the free one
  const VectorXd inside = form.to(form.from(z));
  EXPECT_LE((inside - z.cwiseMax(problem.lower()).cwiseMin(problem.upper())).norm(), 1e-14);
}

}  // namespace
}  // namespace touchstone::solver_comparison
