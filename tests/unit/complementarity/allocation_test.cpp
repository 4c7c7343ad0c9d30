// A second solve of a problem allocates nothing. A program of its own, because it replaces malloc: Eigen's
// storage does not come from operator new, which ends in malloc as well.

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/solver_chain.h"
#include "experiments/problems/literature.h"
#include "tests/support/allocation_counter.h"
#include "tests/unit/complementarity/box_step.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

long count(const std::function<void()>& action) {
  const long before = allocations;
  action();
  return allocations - before;
}

class Allocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  }
};

TEST_F(Allocation, IsCounted) {
  EXPECT_GE(count([] { VectorXd::Ones(100).eval(); }), 1);
  EXPECT_GE(count([] { std::string(100, 'x').clear(); }), 1);
}

/// Every start once, so that all sizes were seen, then every start again under the count.
void expect_no_allocation(ComplementaritySolver& solver, const problems::TestProblem& test) {
  VectorXd z;
  SolveReport report;
  const auto solve_all = [&] {
    for (const VectorXd& start : test.starts) {
      z = start;
      report = solver.solve(*test.problem, z);
    }
  };
  solve_all();
  EXPECT_EQ(count(solve_all), 0) << test.name;
}

TEST_F(Allocation, NoneInASecondSolveOfTheTable) {
  for (const problems::TestProblem& test : problems::all_problems()) {
    PathNewton path;
    SemismoothNewton semismooth;
    SolverChain chain;
    expect_no_allocation(path, test);
    expect_no_allocation(semismooth, test);
    expect_no_allocation(chain, test);
  }
}

TEST_F(Allocation, NoneWhereTheJacobianIsSingular) {
  testing::BoxState state;
  state.q << 0.0, 3.0, 0.0;
  const testing::BoxStep problem({}, state);
  VectorXd start = problem.predicted_start();
  start[1] = 0.4;
  PathNewton path;
  SemismoothNewton semismooth;
  for (ComplementaritySolver* solver :
       {static_cast<ComplementaritySolver*>(&path), static_cast<ComplementaritySolver*>(&semismooth)}) {
    VectorXd z = start;
    SolveReport report = solver->solve(problem, z);
    ASSERT_TRUE(report.solved());
    EXPECT_EQ(count([&] {
                z = start;
                report = solver->solve(problem, z);
              }),
              0);
  }
}

class Columns final : public ColumnSource {
 public:
  explicit Columns(MatrixXd m) : m_(std::move(m)) {}
  [[nodiscard]] Index size() const override { return m_.rows(); }
  void column(Index j, Eigen::Ref<VectorXd> out) const override { out = m_.col(j); }

 private:
  MatrixXd m_;
};

TEST_F(Allocation, NoneInASecondPivoting) {
  const Index n = 8;
  const MatrixXd m = problems::murty_matrix(n);
  const VectorXd q = problems::murty_q(n);
  const VectorXd zero = VectorXd::Zero(n);
  const VectorXd upper = VectorXd::Constant(n, infinity);
  const VectorXd cover = VectorXd::Ones(n);
  const Columns columns(m);
  LinearPathOptions options;
  options.max_pivots = 1000;
  LinearPath path(options);
  VectorXd z(n);
  LinearPathResult result;
  const auto pivot_all = [&] {
    result = path.lemke(m, q, z);
    result = path.lemke(columns, q, cover, z);
    z.setZero();
    result = path.follow(m, q, zero, upper, 0.0, z);
  };
  pivot_all();
  ASSERT_TRUE(result.solved());
  EXPECT_EQ(count(pivot_all), 0);
}

}  // namespace
}  // namespace touchstone
