#include "core/stepper/reduced_system.h"

#include <algorithm>

namespace touchstone {

void ReducedSystem::start(Eigen::Index size) {
  size_ = size;
  dense_ = is_dense(size);
  if (dense_) {
    lu_.matrix(size).setZero();
  } else {
    entries_.clear();
  }
}

void ReducedSystem::add(std::span<const Eigen::Index> unknown, std::span<const Eigen::Index> place,
                        const Eigen::Ref<const Eigen::MatrixXd>& block) {
  const std::size_t n = place.size();
  if (dense_) {
    auto matrix = lu_.matrix(size_);
    // Unknowns that stand side by side in both, a body's or a contact's, are taken together.
    for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
      end = begin + 1;
      while (end < n && place[end] == place[end - 1] + 1 && unknown[end] == unknown[end - 1] + 1) ++end;
      const auto rows = static_cast<Eigen::Index>(end - begin);
      for (std::size_t c = 0; c < n; ++c) {
        double* __restrict const target = &matrix(place[begin], place[c]);
        const double* __restrict const source = &block.coeffRef(unknown[begin], unknown[c]);
        for (Eigen::Index r = 0; r < rows; ++r) target[r] += source[r];
      }
    }
    return;
  }
  // Zeros too, so that the pattern depends on places alone.
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t r = 0; r < n; ++r) {
      entries_.emplace_back(static_cast<int>(place[r]), static_cast<int>(place[c]),
                            block(unknown[r], unknown[c]));
    }
  }
}

void ReducedSystem::add_to_diagonal(Eigen::Index first, double value) {
  if (dense_) {
    lu_.matrix(size_).diagonal().tail(size_ - first).array() += value;
    return;
  }
  for (auto i = static_cast<int>(first); i < static_cast<int>(size_); ++i) entries_.emplace_back(i, i, value);
}

bool ReducedSystem::factor() {
  constexpr double kSingular = 1e-11;
  determinant_sign_ = 0;
  return dense_ ? lu_.factor(kSingular) : factor_sparse();
}

bool ReducedSystem::same_pattern() const {
  return outer_.size() == static_cast<std::size_t>(size_) + 1 &&
         inner_.size() == static_cast<std::size_t>(matrix_.nonZeros()) &&
         std::equal(outer_.begin(), outer_.end(), matrix_.outerIndexPtr()) &&
         std::equal(inner_.begin(), inner_.end(), matrix_.innerIndexPtr());
}

bool ReducedSystem::factor_sparse() {
  matrix_.resize(size_, size_);
  matrix_.setFromTriplets(entries_.begin(), entries_.end());
  matrix_.makeCompressed();
  if (!same_pattern()) {
    outer_.assign(matrix_.outerIndexPtr(), matrix_.outerIndexPtr() + size_ + 1);
    inner_.assign(matrix_.innerIndexPtr(), matrix_.innerIndexPtr() + matrix_.nonZeros());
    sparse_lu_.analyzePattern(matrix_);
  }
  sparse_lu_.factorize(matrix_);
  if (sparse_lu_.info() != Eigen::Success) return false;
  determinant_sign_ = sparse_lu_.signDeterminant();
  return true;
}

void ReducedSystem::solve(Eigen::VectorXd& x) {
  if (dense_) {
    lu_.solve(x.data());
    return;
  }
  sparse_solution_ = sparse_lu_.solve(x.head(size_));
  x.head(size_) = sparse_solution_;
}

}  // namespace touchstone
