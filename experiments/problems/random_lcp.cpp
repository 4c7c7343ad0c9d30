#include "experiments/problems/random_lcp.h"

#include <cmath>
#include <random>

namespace touchstone::problems {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Uniform numbers from the top bits of a generator that the standard fixes; its distributions are not fixed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11U), -53);
  }
  VectorXd vector(Index n, double low, double high) {
    VectorXd v(n);
    for (Index i = 0; i < n; ++i) v[i] = between(low, high);
    return v;
  }
  MatrixXd matrix(Index rows, Index columns) {
    MatrixXd m(rows, columns);
    for (Index j = 0; j < columns; ++j) m.col(j) = vector(rows, -1, 1);
    return m;
  }

 private:
  std::mt19937_64 engine_;
};

/// A A^T / n + a skew part + shift I: positive semidefinite, definite if shift > 0 or the rank is full.
MatrixXd monotone_matrix(Random& random, Index n, Index rank, double shift) {
  const MatrixXd a = random.matrix(n, rank);
  MatrixXd m = a * a.transpose() / static_cast<double>(n);
  if (shift > 0) {
    const MatrixXd b = random.matrix(n, n) / std::sqrt(static_cast<double>(n));
    m += 0.5 * (b - b.transpose()) + shift * MatrixXd::Identity(n, n);
  }
  return m;
}

/// q for which z is a solution, with slack s: every third pair has z > 0, every third s > 0, and the rest
/// also s > 0, or nothing if `degenerate`.
void choose_solution(Random& random, bool degenerate, RandomLcp& lcp) {
  const Index n = lcp.m.rows();
  VectorXd slack = random.vector(n, 0.1, 1);
  lcp.solution = random.vector(n, 0.1, 1);
  for (Index i = 0; i < n; ++i) {
    (i % 3 == 0 ? slack : lcp.solution)[i] = 0;
    if (degenerate && i % 3 == 2) slack[i] = 0;
  }
  lcp.q = slack - lcp.m * lcp.solution;
}

/// Replaces a row so that y^T M = -c < 0 and y^T q = -1 with y > 0: then y^T (M z + q) < 0 for all z >= 0.
void make_infeasible(Random& random, RandomLcp& lcp) {
  const Index n = lcp.m.rows();
  const Index last = n - 1;
  const VectorXd y = random.vector(n, 0.5, 1.5);
  const VectorXd c = random.vector(n, 0.1, 1);
  lcp.q = random.vector(n, -1, 1);
  lcp.m.row(last) = -(c.transpose() + y.head(last).transpose() * lcp.m.topRows(last)) / y[last];
  lcp.q[last] = -(1 + y.head(last).dot(lcp.q.head(last))) / y[last];
  lcp.certificate = y;
}

}  // namespace

std::string to_string(LcpKind kind) {
  switch (kind) {
    case LcpKind::p_matrix:
      return "p_matrix";
    case LcpKind::degenerate:
      return "degenerate";
    case LcpKind::infeasible:
      return "infeasible";
  }
  return "";
}

RandomLcp random_lcp(LcpKind kind, Index n, std::uint64_t seed) {
  Random random(seed);
  RandomLcp lcp;
  const bool degenerate = kind == LcpKind::degenerate;
  lcp.m = monotone_matrix(random, n, degenerate ? n / 2 : n, degenerate ? 0.0 : 0.1);
  if (kind == LcpKind::infeasible) {
    make_infeasible(random, lcp);
  } else {
    choose_solution(random, degenerate, lcp);
  }
  return lcp;
}

}  // namespace touchstone::problems
