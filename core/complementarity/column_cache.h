#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/complementarity/column_source.h"

namespace touchstone {

/// Columns of a matrix by pointer: straight into a dense matrix, or into slots filled from a ColumnSource
/// when a column is first asked for. A pointer stays valid until its column is released or another matrix is
/// bound. Slots are kept for the next problem, so a repeated solve allocates nothing.
class ColumnCache {
 public:
  /// Makes room for every column of a matrix of size n.
  void reserve(Eigen::Index n);
  void bind(const Eigen::MatrixXd& matrix);
  void bind(const ColumnSource& source);

  [[nodiscard]] Eigen::Index size() const { return size_; }

  [[nodiscard]] const double* column(Eigen::Index j) {
    return dense_ != nullptr ? dense_ + j * size_ : cached(j);
  }

  /// Gives the slot of a column back; nothing happens if it has none.
  void release(Eigen::Index j);

 private:
  [[nodiscard]] const double* cached(Eigen::Index j);

  Eigen::Index size_ = 0;
  const double* dense_ = nullptr;
  const ColumnSource* source_ = nullptr;
  std::vector<Eigen::VectorXd> slots_;
  std::vector<int> free_slots_;
  std::vector<int> slot_of_column_;  // -1: not cached
};

}  // namespace touchstone
