#include "core/complementarity/dense_lu.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/complementarity/basis_core.h"

namespace touchstone {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return normal_(engine_); }
  Index below(Index n) { return static_cast<Index>(engine_() % static_cast<unsigned>(n)); }
  MatrixXd matrix(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [this] { return number(); });
  }
  VectorXd vector(Index n) { return matrix(n, 1); }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

TEST(DenseLu, SolvesLikeEigenOnBothSidesOfTheBlockedSize) {
  Random random(1);
  DenseLu lu;
  for (const Index n : {1, 2, 3, 9, 28, 39, 40, 41, 70, 5}) {
    const MatrixXd a = random.matrix(n, n);
    VectorXd x = random.vector(n);
    const VectorXd expected = a.fullPivLu().solve(x);
    lu.matrix(n) = a;
    ASSERT_TRUE(lu.factor(1e-12)) << n;
    lu.solve(x.data());
    EXPECT_LT((x - expected).norm(), 1e-10 * (1.0 + expected.norm())) << n;
  }
}

TEST(DenseLu, RefusesSingularAndNonFiniteMatrices) {
  Random random(2);
  DenseLu lu;
  for (const Index n : {3, 9, 60}) {
    MatrixXd a = random.matrix(n, n);
    a.col(n - 1) = a.col(0) - 2.0 * a.col(1);
    lu.matrix(n) = a;
    EXPECT_FALSE(lu.factor(1e-12)) << n;
    a = random.matrix(n, n);
    a(1, 1) = std::numeric_limits<double>::quiet_NaN();
    lu.matrix(n) = a;
    EXPECT_FALSE(lu.factor(1e-12)) << n;
  }
  lu.matrix(2).setZero();
  EXPECT_FALSE(lu.factor(1e-12));
}

TEST(DenseLu, PivotsAreJudgedByTheirColumn) {
  DenseLu lu;
  lu.matrix(2) = Eigen::Vector2d(1.0, 1e-15).asDiagonal();
  EXPECT_TRUE(lu.factor(1e-12)) << "a unit of measurement is no singularity";
}

TEST(DenseLu, FindsTheRankAndTheShortestSolution) {
  Random random(3);
  DenseLu lu;
  for (const Index n : {2, 5, 19, 50}) {
    for (const Index deficiency : {Index{0}, Index{1}, n / 2, n}) {
      const Index rank = n - deficiency;
      const MatrixXd a = random.matrix(n, rank) * random.matrix(rank, n);
      const VectorXd b = a * random.vector(n);
      lu.matrix(n) = a;
      ASSERT_EQ(lu.factor_rank_revealing(1e-11), rank) << n;
      VectorXd x(n);
      lu.solve_least_norm(b.data(), x.data());
      const VectorXd expected = a.completeOrthogonalDecomposition().solve(b);
      EXPECT_LT((a * x - b).norm(), 1e-8 * (1.0 + b.norm())) << n << " " << rank;
      EXPECT_LT((x - expected).norm(), 1e-6 * (1.0 + expected.norm())) << n << " " << rank;
    }
  }
}

TEST(DenseLu, NamesARegularBlock) {
  Random random(4);
  const Index n = 7;
  const MatrixXd a = random.matrix(n, 4) * random.matrix(4, n);
  DenseLu lu;
  lu.matrix(n) = a;
  ASSERT_EQ(lu.factor_rank_revealing(1e-11), 4);
  MatrixXd block(4, 4);
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      block(static_cast<Index>(r), static_cast<Index>(c)) = a(lu.row_order()[r], lu.column_order()[c]);
    }
  }
  EXPECT_GT(std::abs(block.determinant()), 1e-6);
}

/// Applies one random change to the core and to a plain matrix.
void change(Random& random, BasisCore& core, MatrixXd& matrix) {
  const Index k = matrix.rows();
  VectorXd solved(k + 2);
  const Index kind = k < 2 ? 0 : random.below(4);
  if (kind == 0) {
    const VectorXd b = random.vector(k);
    const VectorXd a = random.vector(k);
    const double corner = 3.0 + random.number();
    ASSERT_TRUE(core.solve(b, solved));
    core.append(b, a, corner, solved);
    MatrixXd next(k + 1, k + 1);
    next << matrix, b, a.transpose(), corner;
    matrix = next;
  } else if (kind == 1) {
    const Index row = random.below(k);
    const Index column = random.below(k);
    core.remove(row, column);
    MatrixXd next = matrix;
    next.row(row) = next.row(k - 1).eval();
    next.col(column) = next.col(k - 1).eval();
    matrix = next.topLeftCorner(k - 1, k - 1).eval();
  } else if (kind == 2) {
    const Index column = random.below(k);
    const VectorXd b = random.vector(k);
    ASSERT_TRUE(core.solve(b, solved));
    core.replace_column(column, b, solved);
    matrix.col(column) = b;
  } else {
    const Index row = random.below(k);
    const VectorXd a = random.vector(k);
    core.replace_row(row, a);
    matrix.row(row) = a.transpose();
  }
}

TEST(BasisCore, StaysTheInverseThroughAThousandChanges) {
  Random random(5);
  BasisCore core;
  core.resize(0);
  ASSERT_TRUE(core.factor());
  MatrixXd matrix(0, 0);
  double worst = 0.0;
  for (int i = 0; i < 1000; ++i) {
    change(random, core, matrix);
    const Index k = matrix.rows();
    ASSERT_EQ(core.size(), k);
    if (k == 0) continue;
    const VectorXd b = random.vector(k);
    VectorXd x(k);
    ASSERT_TRUE(core.solve(b, x)) << i;
    worst = std::max(worst, (matrix * x - b).norm() / (b.norm() + matrix.norm() * x.norm()));
  }
  EXPECT_LT(worst, 1e-10);
}

}  // namespace
}  // namespace touchstone
