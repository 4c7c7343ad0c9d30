#include "core/complementarity/basis_core.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace touchstone {

using Eigen::Index;

namespace {

constexpr double singular_pivot = 1e-12;     // relative to the column
constexpr double refinement_defect = 1e-14;  // relative backward error above which a solve is refined
constexpr double acceptable_defect = 1e-10;  // and above which the inverse is formed anew
constexpr Index smallest_capacity = 32;

}  // namespace

void BasisCore::reserve(Index k) {
  make_room(k);
  static_cast<void>(lu_.matrix(k));
}

void BasisCore::make_room(Index k) {
  if (k <= matrix_.rows()) return;
  const Index capacity = std::max({k, 2 * matrix_.rows(), smallest_capacity});
  matrix_.conservativeResize(capacity, capacity);
  inverse_.conservativeResize(capacity, capacity);
  row_product_.resize(capacity);
  defect_.resize(capacity);
}

void BasisCore::resize(Index k) {
  make_room(k);
  k_ = k;
  factors_ = Factors::none;
}

bool BasisCore::factor() {
  auto a = lu_.matrix(k_);
  for (Index j = 0; j < k_; ++j) {
    for (Index i = 0; i < k_; ++i) a(i, j) = matrix_(i, j);
  }
  factors_ = lu_.factor(singular_pivot) ? Factors::lu : Factors::none;
  return factors_ == Factors::lu;
}

Index BasisCore::reveal_rank() {
  lu_.matrix(k_) = matrix_.topLeftCorner(k_, k_);
  return lu_.factor_rank_revealing(singular_pivot);
}

bool BasisCore::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  assert(factors_ != Factors::none);
  if (factors_ == Factors::lu) {
    x.head(k_) = b.head(k_);
    lu_.solve(x.data());
    return true;
  }
  if (multiply_and_check(b, x)) return true;
  return invert() && multiply_and_check(b, x);
}

// x = K^-1 b by the inverse at hand, with one step of refinement if it is needed; true if x then solves the
// system.
bool BasisCore::multiply_and_check(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (k_ == 0) return true;
  const auto core = matrix_.topLeftCorner(k_, k_);
  const auto inverse = inverse_.topLeftCorner(k_, k_);
  auto solution = x.head(k_);
  auto defect = defect_.head(k_);
  solution.noalias() = inverse * b.head(k_);
  for (int pass = 0; pass < 2; ++pass) {
    defect = b.head(k_);
    defect.noalias() -= core * solution;
    const double scale = b.head(k_).lpNorm<Eigen::Infinity>() +
                         core.lpNorm<Eigen::Infinity>() * solution.lpNorm<Eigen::Infinity>();
    const double error = defect.lpNorm<Eigen::Infinity>();
    if (error <= refinement_defect * scale) return true;
    if (pass == 1) return error <= acceptable_defect * scale;
    solution.noalias() += inverse * defect;
  }
  return false;
}

bool BasisCore::prepare_inverse() { return factors_ == Factors::inverse || invert(); }

bool BasisCore::invert() {
  if (factors_ != Factors::lu && !factor()) return false;
  for (Index j = 0; j < k_; ++j) {
    auto column = inverse_.col(j);
    column.head(k_).setZero();
    column[j] = 1.0;
    lu_.solve(inverse_.data() + j * inverse_.rows());
  }
  factors_ = Factors::inverse;
  return true;
}

// Bordering: with s = corner - a^T K^-1 b the Schur complement of the new entry.
void BasisCore::append(const Eigen::VectorXd& b, const Eigen::VectorXd& a, double corner,
                       const Eigen::VectorXd& solved) {
  [[maybe_unused]] const bool regular = prepare_inverse();
  assert(regular);
  make_room(k_ + 1);
  const Index k = k_;
  row_product_.head(k).noalias() = inverse_.topLeftCorner(k, k).transpose() * a.head(k);
  const double schur = corner - a.head(k).dot(solved.head(k));
  row_product_.head(k) /= schur;
  inverse_.topLeftCorner(k, k).noalias() += solved.head(k) * row_product_.head(k).transpose();
  inverse_.col(k).head(k) = solved.head(k) / -schur;
  inverse_.row(k).head(k) = -row_product_.head(k).transpose();
  inverse_(k, k) = 1.0 / schur;
  matrix_.col(k).head(k) = b.head(k);
  matrix_.row(k).head(k) = a.head(k).transpose();
  matrix_(k, k) = corner;
  ++k_;
}

void BasisCore::remove(Index row, Index column) {
  [[maybe_unused]] const bool regular = prepare_inverse();
  assert(regular);
  const Index last = k_ - 1;
  // K^-1 without row `column` and column `row`, less what they carried: the inverse of bordering.
  row_product_.head(k_) = inverse_.row(column).head(k_).transpose() / inverse_(column, row);
  defect_.head(k_) = inverse_.col(row).head(k_);
  inverse_.topLeftCorner(k_, k_).noalias() -= defect_.head(k_) * row_product_.head(k_).transpose();
  inverse_.row(column).head(k_) = inverse_.row(last).head(k_);
  inverse_.col(row).head(last) = inverse_.col(last).head(last);
  matrix_.row(row).head(k_) = matrix_.row(last).head(k_);
  matrix_.col(column).head(last) = matrix_.col(last).head(last);
  k_ = last;
}

void BasisCore::replace_column(Index column, const Eigen::VectorXd& b, const Eigen::VectorXd& solved) {
  [[maybe_unused]] const bool regular = prepare_inverse();
  assert(regular);
  // Gauss-Jordan: the pivot row scaled, the others cleared of it.
  row_product_.head(k_) = inverse_.row(column).head(k_).transpose() / solved[column];
  inverse_.topLeftCorner(k_, k_).noalias() -= solved.head(k_) * row_product_.head(k_).transpose();
  inverse_.row(column).head(k_) = row_product_.head(k_).transpose();
  matrix_.col(column).head(k_) = b.head(k_);
}

void BasisCore::replace_row(Index row, const Eigen::VectorXd& a) {
  [[maybe_unused]] const bool regular = prepare_inverse();
  assert(regular);
  row_product_.head(k_).noalias() = inverse_.topLeftCorner(k_, k_).transpose() * a.head(k_);
  defect_.head(k_) = inverse_.col(row).head(k_) / row_product_[row];
  inverse_.topLeftCorner(k_, k_).noalias() -= defect_.head(k_) * row_product_.head(k_).transpose();
  inverse_.col(row).head(k_) = defect_.head(k_);
  matrix_.row(row).head(k_) = a.head(k_).transpose();
}

}  // namespace touchstone
