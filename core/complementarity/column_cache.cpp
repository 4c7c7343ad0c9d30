#include "core/complementarity/column_cache.h"

#include <cassert>

namespace touchstone {

using Eigen::Index;

void ColumnCache::reserve(Index n) {
  const auto columns = static_cast<std::size_t>(n);
  if (slots_.size() < columns) slots_.resize(columns);
  for (Eigen::VectorXd& values : slots_) values.resize(n);
  slot_of_column_.reserve(columns);
  free_slots_.reserve(slots_.size());
}

void ColumnCache::bind(const Eigen::MatrixXd& matrix) {
  assert(matrix.rows() == matrix.cols());
  size_ = matrix.rows();
  dense_ = matrix.data();
  source_ = nullptr;
}

void ColumnCache::bind(const ColumnSource& source) {
  size_ = source.size();
  dense_ = nullptr;
  source_ = &source;
  slot_of_column_.assign(static_cast<std::size_t>(size_), -1);
  free_slots_.clear();
  for (int slot = static_cast<int>(slots_.size()) - 1; slot >= 0; --slot) free_slots_.push_back(slot);
}

const double* ColumnCache::cached(Index j) {
  int& slot = slot_of_column_[static_cast<std::size_t>(j)];
  if (slot < 0) {
    if (free_slots_.empty()) {
      free_slots_.push_back(static_cast<int>(slots_.size()));
      slots_.emplace_back();  // moves the vectors, whose data stay where they are
    }
    slot = free_slots_.back();
    free_slots_.pop_back();
    Eigen::VectorXd& values = slots_[static_cast<std::size_t>(slot)];
    values.resize(size_);
    source_->column(j, values);
  }
  return slots_[static_cast<std::size_t>(slot)].data();
}

void ColumnCache::release(Index j) {
  if (source_ == nullptr) return;
  int& slot = slot_of_column_[static_cast<std::size_t>(j)];
  if (slot < 0) return;
  free_slots_.push_back(slot);
  slot = -1;
}

}  // namespace touchstone
