#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/complementarity/dense_lu.h"

namespace touchstone {

/// The k x k core K of a complementary basis: the rows whose slack is nonbasic by the structural columns that
/// are basic. Everything else of the basis is slack columns, so a solve with the basis is a solve with K and
/// a product. K changes by one row and/or one column a pivot.
///
/// The first solve after a fill uses LU factors. Before the first change the inverse is formed, and then kept
/// up to date in O(k^2) a change; each solve is checked against K itself and refined, and the inverse is
/// formed anew when the check shows that it has drifted. An explicit inverse also gives the single rows that
/// breaking a tie asks for.
class BasisCore {
 public:
  /// Makes room for a core of k x k and its factors.
  void reserve(Eigen::Index k);
  /// Makes the core k x k, to be filled through entry(); forgets all factors.
  void resize(Eigen::Index k);
  [[nodiscard]] Eigen::Index size() const { return k_; }
  [[nodiscard]] double& entry(Eigen::Index row, Eigen::Index column) { return matrix_(row, column); }

  /// Factorises what was filled in; false if K is singular to working accuracy.
  [[nodiscard]] bool factor();
  /// Rank of a K that factor() refused. The first rank entries of independent_rows() and
  /// independent_columns() then name a regular part of it.
  [[nodiscard]] Eigen::Index reveal_rank();
  [[nodiscard]] const std::vector<Eigen::Index>& independent_rows() const { return lu_.row_order(); }
  [[nodiscard]] const std::vector<Eigen::Index>& independent_columns() const { return lu_.column_order(); }

  /// x = K^-1 b, k entries each. False if K has become singular.
  [[nodiscard]] bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  // Changes of K. `b`: the new column, by the rows of K; `a`: the new row, by its columns; `solved`: K^-1 b.
  // The caller has made sure, by its ratio test, that the result is regular. remove() moves the last row and
  // column into the gap.
  void append(const Eigen::VectorXd& b, const Eigen::VectorXd& a, double corner,
              const Eigen::VectorXd& solved);
  void remove(Eigen::Index row, Eigen::Index column);
  void replace_column(Eigen::Index column, const Eigen::VectorXd& b, const Eigen::VectorXd& solved);
  void replace_row(Eigen::Index row, const Eigen::VectorXd& a);

 private:
  void make_room(Eigen::Index k);
  [[nodiscard]] bool prepare_inverse();
  [[nodiscard]] bool invert();
  [[nodiscard]] bool multiply_and_check(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  enum class Factors { none, lu, inverse };

  Eigen::Index k_ = 0;
  Factors factors_ = Factors::none;
  Eigen::MatrixXd matrix_;   // top-left k x k: K
  Eigen::MatrixXd inverse_;  // top-left k x k: K^-1, if factors_ says so
  Eigen::VectorXd row_product_;
  Eigen::VectorXd defect_;
  DenseLu lu_;
};

}  // namespace touchstone
