#include "core/complementarity/linear_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/complementarity/residual.h"
#include "experiments/problems/literature.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double infinity = std::numeric_limits<double>::infinity();

double lcp_residual(const MatrixXd& m, const VectorXd& q, const VectorXd& z) {
  return natural_residual(VectorXd::Zero(q.size()), VectorXd::Constant(q.size(), infinity), z, m * z + q)
      .value;
}

TEST(Lemke, MurtyTakesTwoToTheNPivots) {
  LinearPathOptions options;
  options.max_pivots = 5000;
  LinearPath path(options);
  for (int n = 1; n <= 12; ++n) {
    const MatrixXd m = problems::murty_matrix(n);
    const VectorXd q = problems::murty_q(n);
    VectorXd z;
    const LinearPathResult result = path.lemke(m, q, z);
    ASSERT_TRUE(result.solved()) << n;
    EXPECT_EQ(result.pivots, 1 << n);
    EXPECT_EQ(lcp_residual(m, q, z), 0) << n;
    EXPECT_EQ(result.parameter, 0);
  }
}

TEST(Lemke, ANonnegativeQIsSolvedWithoutAPivot) {
  LinearPath path;
  VectorXd z;
  const LinearPathResult result = path.lemke(MatrixXd::Identity(3, 3), VectorXd::Ones(3), z);
  EXPECT_TRUE(result.solved());
  EXPECT_EQ(result.pivots, 0);
  EXPECT_EQ(z, VectorXd::Zero(3));
}

TEST(Lemke, TheCoveringVectorChangesThePath) {
  LinearPath path;
  const Index n = 6;
  VectorXd z;
  const MatrixXd m = problems::murty_matrix(n);
  const VectorXd q = problems::murty_q(n);
  // Later rows are covered so well that the first unknown, which alone is positive at the end, enters first.
  VectorXd cover(n);
  for (Index i = 0; i < n; ++i) cover[i] = std::pow(4.0, static_cast<double>(i));
  const LinearPathResult result = path.lemke(m, q, cover, z);
  ASSERT_TRUE(result.solved());
  EXPECT_EQ(result.pivots, 2);
  EXPECT_EQ(lcp_residual(m, q, z), 0);
}

TEST(Lemke, StopsAtThePivotLimitAndSaysSo) {
  LinearPathOptions options;
  options.max_pivots = 20;
  LinearPath path(options);
  VectorXd z;
  const LinearPathResult result = path.lemke(problems::murty_matrix(6), problems::murty_q(6), z);
  EXPECT_EQ(result.status, LinearPathStatus::pivot_limit);
  EXPECT_EQ(result.pivots, 20);
  EXPECT_GT(result.parameter, 0);
}

TEST(Lemke, ReportsARayWhereNoSolutionExists) {
  MatrixXd m(2, 2);
  m << -1, 0, 0, 1;
  const Eigen::Vector2d q(-1, -1);  // w_1 = -z_1 - 1 cannot be >= 0
  LinearPath path;
  VectorXd z;
  const LinearPathResult result = path.lemke(m, q, z);
  ASSERT_EQ(result.status, LinearPathStatus::ray);
  // A secondary ray (u, w, tau): u >= 0, w = M u + cover tau >= 0, not all zero, complementary to the point
  // it leaves.
  const VectorXd& u = path.unknown_ray();
  const VectorXd w = m * u + VectorXd::Constant(2, path.parameter_ray());
  EXPECT_GE(u.minCoeff(), 0);
  EXPECT_GE(w.minCoeff(), -1e-15);
  EXPECT_GE(path.parameter_ray(), 0);
  EXPECT_GT(u.norm(), 0);
  EXPECT_LT((w - path.slack_ray()).norm(), 1e-15);
  EXPECT_EQ(u.dot(w), 0);
}

// Beale's linear programme (1955), on which the simplex method cycles, as the complementarity problem of its
// KKT conditions: two of its three constraints pass through the start.
TEST(PathFollowing, BreaksTheTiesOfBealesProgramme) {
  MatrixXd a(3, 4);
  a << 0.25, -60, -1.0 / 25, 9, 0.5, -90, -1.0 / 50, 3, 0, 0, 1, 0;
  const Eigen::Vector4d c(-0.75, 150, -0.02, 6);
  const Eigen::Vector3d b(0, 0, 1);
  MatrixXd m = MatrixXd::Zero(7, 7);
  m.topRightCorner(4, 3) = a.transpose();
  m.bottomLeftCorner(3, 4) = -a;
  VectorXd q(7);
  q << c, b;
  VectorXd z = VectorXd::Zero(7);
  LinearPath path;
  const LinearPathResult result =
      path.follow(m, q, VectorXd::Zero(7), VectorXd::Constant(7, infinity), 0.0, z);
  ASSERT_TRUE(result.solved());
  EXPECT_GT(result.ties_broken, 0);
  EXPECT_LT(lcp_residual(m, q, z), 1e-12);
  EXPECT_NEAR(c.dot(z.head(4)), -0.05, 1e-12);
}

// All rows tie at the start, and the path runs along degenerate vertices.
TEST(Lemke, SolvesFullyTiedProblems) {
  LinearPath path;
  for (const Index n : {2, 5, 20, 60}) {
    VectorXd z;
    const MatrixXd ones = MatrixXd::Ones(n, n);
    const VectorXd q = VectorXd::Constant(n, -1);
    LinearPathResult result = path.lemke(ones, q, z);
    ASSERT_TRUE(result.solved()) << n;
    EXPECT_GT(result.ties_broken, 0);
    EXPECT_LT(lcp_residual(ones, q, z), 1e-12);
    if (n > 5) continue;  // exponentially many pivots
    const MatrixXd murty = problems::murty_matrix(n);
    result = path.lemke(murty, q, z);
    ASSERT_TRUE(result.solved()) << n;
    EXPECT_LT(lcp_residual(murty, q, z), 1e-12);
  }
}

class CountingSource final : public ColumnSource {
 public:
  explicit CountingSource(const MatrixXd& m) : m_(m), calls(static_cast<std::size_t>(m.rows()), 0) {}
  [[nodiscard]] Index size() const override { return m_.rows(); }
  void column(Index j, Eigen::Ref<VectorXd> out) const override {
    ++calls[static_cast<std::size_t>(j)];
    out = m_.col(j);
  }

 private:
  const MatrixXd& m_;

 public:
  mutable std::vector<int> calls;
};

// Many contacts of one body: M = W^T W has rank 3, and few rows ever become active.
TEST(Lemke, ByColumnsDoesTheSameAndAsksForFewColumns) {
  const Index n = 400;
  MatrixXd w(3, n);
  VectorXd q(n);
  for (Index i = 0; i < n; ++i) {
    const double angle = 0.0157 * static_cast<double>(i);
    w.col(i) << std::cos(angle), std::sin(angle), 0.3 * std::sin(3 * angle);
    q[i] = 1.0 + std::sin(7.0 * angle) - 3.0 * std::cos(angle) + 0.2 * std::cos(0.5 + angle);
  }
  const MatrixXd m = w.transpose() * w;
  LinearPath path;
  VectorXd dense_z, z;
  const LinearPathResult dense = path.lemke(m, q, dense_z);
  ASSERT_TRUE(dense.solved());
  EXPECT_LT(lcp_residual(m, q, dense_z), 1e-10);
  const CountingSource source(m);
  const LinearPathResult result = path.lemke(source, q, VectorXd::Ones(n), z);
  ASSERT_TRUE(result.solved());
  EXPECT_EQ(result.pivots, dense.pivots);
  EXPECT_EQ(z, dense_z);
  int asked = 0;
  for (const int calls : source.calls) asked += calls;
  EXPECT_GT(result.pivots, 3);
  EXPECT_LE(asked, result.pivots);
}

TEST(Lemke, TakesBoundsAndFreeUnknowns) {
  MatrixXd m(3, 3);
  m << 2, 1, 0, 1, 3, -1, 0, 1, 1;
  const Eigen::Vector3d q(-1, -20, 5);
  const Eigen::Vector3d lower(-infinity, 0, -infinity);
  const Eigen::Vector3d upper(infinity, 4, -2);
  LinearPath path;
  VectorXd z;
  ASSERT_TRUE(path.lemke(m, q, lower, upper, VectorXd::Zero(3), z).solved());
  EXPECT_LT(natural_residual(lower, upper, z, m * z + q).value, 1e-14);
  EXPECT_EQ(z[1], 4) << "exactly at its bound";
}

TEST(PathFollowing, FromTheSolutionsActiveSetTakesNoPivot) {
  const problems::TestProblem test = problems::path4();
  MatrixXd m(4, 4);
  VectorXd f(4);
  VectorXd z = Eigen::Vector4d(2, 0, 1, 1);
  test.problem->evaluate(z, f, &m);
  f[1] = 5;  // the row at its bound, which stays there
  f.tail(2) = VectorXd::Constant(2, 1e-2);
  LinearPath path;
  const LinearPathResult result = path.follow(m, f, test.problem->lower(), test.problem->upper(), 0.0, z);
  EXPECT_TRUE(result.solved());
  EXPECT_EQ(result.pivots, 0);
}

/// Follows the path of  s = q + M z  from z.
LinearPathResult follow(const MatrixXd& m, const VectorXd& q, const VectorXd& lower, const VectorXd& upper,
                        VectorXd& z, double misfit = 0.0) {
  LinearPath path;
  const VectorXd f = m * z + q;
  return path.follow(m, f, lower, upper, misfit, z);
}

TEST(PathFollowing, SolvesMurtyFromEverywhere) {
  const Index n = 8;
  const MatrixXd m = problems::murty_matrix(n);
  const VectorXd q = problems::murty_q(n);
  const VectorXd upper = VectorXd::Constant(n, infinity);
  for (const double start : {0.0, 1.0, 300.0}) {
    VectorXd z = VectorXd::Constant(n, start);
    ASSERT_TRUE(follow(m, q, VectorXd::Zero(n), upper, z).solved()) << start;
    EXPECT_LT(lcp_residual(m, q, z), 1e-10);
  }
}

TEST(PathFollowing, ASingularConsistentBlockLeavesTheUndeterminedUnknown) {
  const VectorXd free = VectorXd::Constant(2, infinity);
  VectorXd z = Eigen::Vector2d(3, 5);
  const LinearPathResult result = follow(MatrixXd::Ones(2, 2), VectorXd::Constant(2, -1), -free, free, z);
  EXPECT_TRUE(result.solved());
  EXPECT_TRUE(result.repaired);
  EXPECT_EQ(result.pivots, 0);
  EXPECT_NEAR(z.sum(), 1, 1e-15);
  EXPECT_TRUE(z[0] == 3 || z[1] == 5);
}

TEST(PathFollowing, ASingularContradictoryBlockIsNotSolved) {
  const VectorXd free = VectorXd::Constant(2, infinity);
  VectorXd z = Eigen::Vector2d(3, 5);
  EXPECT_EQ(follow(MatrixXd::Ones(2, 2), Eigen::Vector2d(-1, -2), -free, free, z).status,
            LinearPathStatus::ray);
}

TEST(PathFollowing, AMisfitOfADependentRowIsAcceptedUpToItsLimit) {
  const VectorXd free = VectorXd::Constant(2, infinity);
  VectorXd z = Eigen::Vector2d(0, 0);
  EXPECT_TRUE(follow(MatrixXd::Ones(2, 2), Eigen::Vector2d(-1, -1.01), -free, free, z, 0.02).solved());
  z.setZero();
  EXPECT_FALSE(follow(MatrixXd::Ones(2, 2), Eigen::Vector2d(-1, -1.01), -free, free, z, 0.005).solved());
}

// A free multiplier z_1 of the constraint z_2 = 1 has a zero on its diagonal: the start basis is singular,
// and the multiplier can enter only when the slack of its row is about to leave zero.
TEST(PathFollowing, APartnerEntersWhereADependentRowHasToMove) {
  MatrixXd m(2, 2);
  m << 0, 1, -1, 0;
  const Eigen::Vector2d q(-1, 0.5);
  const Eigen::Vector2d lower(-infinity, 0);
  const VectorXd upper = VectorXd::Constant(2, infinity);
  VectorXd z = VectorXd::Zero(2);
  const LinearPathResult result = follow(m, q, lower, upper, z);
  ASSERT_TRUE(result.solved());
  EXPECT_TRUE(result.repaired);
  EXPECT_NEAR(z[0], 0.5, 1e-15);
  EXPECT_NEAR(z[1], 1.0, 1e-15);
}

TEST(LinearPathOptions, TieToleranceDecidesWhatTies) {
  const MatrixXd m = MatrixXd::Identity(2, 2);
  const Eigen::Vector2d q(-1, -1 + 1e-6);
  VectorXd z;
  EXPECT_EQ(LinearPath().lemke(m, q, z).ties_broken, 0);
  LinearPathOptions options;
  options.tie_tolerance = 1e-4;
  EXPECT_GT(LinearPath(options).lemke(m, q, z).ties_broken, 0);
}

TEST(LinearPathOptions, PivotToleranceDecidesWhatBlocks) {
  MatrixXd m(2, 2);
  m << 1e-6, 0, 0, 1;
  const Eigen::Vector2d q(-1, -1);
  VectorXd z;
  EXPECT_TRUE(LinearPath().lemke(m, q, z).solved());
  EXPECT_NEAR(z[0], 1e6, 1e-4);
  LinearPathOptions options;
  options.pivot_tolerance = 1e-4;
  EXPECT_EQ(LinearPath(options).lemke(m, q, z).status, LinearPathStatus::ray);
}

TEST(LinearPath, StatusesHaveNames) {
  EXPECT_EQ(to_string(LinearPathStatus::solved), "solved");
  EXPECT_EQ(to_string(LinearPathStatus::ray), "ray");
  EXPECT_EQ(to_string(LinearPathStatus::pivot_limit), "pivot_limit");
  EXPECT_EQ(to_string(LinearPathStatus::singular_basis), "singular_basis");
}

}  // namespace
}  // namespace touchstone
