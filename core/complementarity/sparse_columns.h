#pragma once

#include <Eigen/SparseCore>

#include "core/complementarity/column_source.h"

namespace touchstone {

/// The columns of a sparse matrix, for the pivoting of LinearPath, which asks for those that enter its basis.
class SparseColumns final : public ColumnSource {
 public:
  /// @param matrix  square; must outlive the use
  explicit SparseColumns(const Eigen::SparseMatrix<double>& matrix) : matrix_(matrix) {}

  [[nodiscard]] Eigen::Index size() const override { return matrix_.cols(); }
  void column(Eigen::Index j, Eigen::Ref<Eigen::VectorXd> out) const override {
    out.setZero();
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix_, j); entry; ++entry)
      out[entry.row()] = entry.value();
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
};

}  // namespace touchstone
