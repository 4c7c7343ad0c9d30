#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <span>
#include <vector>

#include "core/complementarity/dense_lu.h"

namespace touchstone {

/// A square linear system that is put together from small dense blocks: dense and free of allocations while
/// it is small, sparse with Eigen's supernodal LU where it is large. The sparse pattern is analysed once for
/// as long as the blocks' places stay the same.
class ReducedSystem {
 public:
  /// Above this many unknowns it is sparse.
  static constexpr Eigen::Index dense_limit = 60;

  /// Makes room for a system of this size, if it is dense.
  void reserve(Eigen::Index size) {
    if (is_dense(size)) static_cast<void>(lu_.matrix(size));
  }
  /// Begins anew with all entries zero.
  void start(Eigen::Index size);
  [[nodiscard]] static bool is_dense(Eigen::Index size) { return size <= dense_limit; }
  /// Adds block(unknown[r], unknown[c]) at (place[r], place[c]).
  void add(std::span<const Eigen::Index> unknown, std::span<const Eigen::Index> place,
           const Eigen::Ref<const Eigen::MatrixXd>& block);
  /// Adds `value` to the diagonal from entry `first` on.
  void add_to_diagonal(Eigen::Index first, double value);
  /// False if it is singular to working precision.
  [[nodiscard]] bool factor();
  /// Sign of the determinant by the last factors, 0 if it is not known: of a dense system or a singular one.
  [[nodiscard]] double determinant_sign() const { return determinant_sign_; }
  /// x <- A^-1 x with the last factors; x has at least as many entries as the system.
  void solve(Eigen::VectorXd& x);

 private:
  [[nodiscard]] bool factor_sparse();
  [[nodiscard]] bool same_pattern() const;

  Eigen::Index size_ = 0;
  bool dense_ = true;
  double determinant_sign_ = 0.0;
  DenseLu lu_;
  std::vector<Eigen::Triplet<double, int>> entries_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<int> outer_, inner_;  ///< of the pattern that was analysed
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> sparse_lu_;
  Eigen::VectorXd sparse_solution_;
};

}  // namespace touchstone
