#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

namespace touchstone {

/// LU factors of a square matrix on storage that is kept between factorisations: nothing is allocated once
/// the largest size was seen. Small matrices are factorised by a plain loop, whose call costs less than one
/// of Eigen's blocked algorithm; from `blocked_size` on it is Eigen's.
///
/// Use: fill matrix(n), then factor(); if that says "singular", fill again and factor_rank_revealing().
class DenseLu {
 public:
  static constexpr Eigen::Index blocked_size = 40;

  /// The n x n storage to be filled before a factorisation, which overwrites it. Column-major.
  [[nodiscard]] Eigen::Map<Eigen::MatrixXd> matrix(Eigen::Index n);

  /// Partial pivoting. False if a pivot is not larger than `tolerance` times the largest entry of its column
  /// (or is not finite); then solve() is not available.
  [[nodiscard]] bool factor(double tolerance);

  /// x <- A^-1 x, after factor() returned true. x has n entries.
  void solve(double* x);

  /// The same for several right sides at once, after factor() returned true of a matrix below blocked_size:
  /// x is n x columns, row after row.
  void solve_rows(double* x, Eigen::Index columns);

  /// Complete pivoting; returns the rank: the number of pivots larger than `tolerance` times the largest one.
  /// The first rank entries of row_order() and column_order() then name a regular block of A.
  [[nodiscard]] Eigen::Index factor_rank_revealing(double tolerance);
  [[nodiscard]] const std::vector<Eigen::Index>& row_order() const { return row_order_; }
  [[nodiscard]] const std::vector<Eigen::Index>& column_order() const { return column_order_; }

  /// After factor_rank_revealing(): the shortest x that solves the independent rows of A x = b. The dependent
  /// rows are met if b is consistent; the caller checks. b and x have n entries and may not overlap.
  void solve_least_norm(const double* b, double* x);

 private:
  [[nodiscard]] bool factor_small(double tolerance);
  [[nodiscard]] bool factor_blocked(double tolerance);
  void permute(double* x);
  void swap_rows(Eigen::Index a, Eigen::Index b);
  void swap_columns(Eigen::Index a, Eigen::Index b);
  template <typename Size>
  [[nodiscard]] bool factor_of(Size size, double tolerance);
  template <typename Size>
  void eliminate(Size size, Eigen::Index k);
  void back_substitute(Eigen::Index order, double* x) const;
  void null_vector(Eigen::Index k, double* x) const;
  void remove_null_components(double* x);

  Eigen::Index n_ = 0;
  Eigen::Index rank_ = 0;
  std::vector<double> storage_;
  std::vector<double> column_scale_;
  std::vector<double> inverse_pivot_;
  std::vector<Eigen::Index> exchanges_;
  std::vector<Eigen::Index> row_order_;
  std::vector<Eigen::Index> column_order_;
  std::vector<double> permuted_;
  std::vector<double> null_space_;
  Eigen::PartialPivLU<Eigen::MatrixXd> blocked_;
};

}  // namespace touchstone
