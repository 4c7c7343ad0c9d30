#include "core/complementarity/dense_lu.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace touchstone {

using Eigen::Index;

namespace {
constexpr std::size_t usual_deficiency = 4;  // a larger one makes the null space's storage grow

/// Runs the same loops with the order known to the compiler for the orders that one or two contacts lead to.
template <typename Loops>
bool with_fixed_size(Index n, const Loops& loops) {
  switch (n) {
    case 3:
      return loops(std::integral_constant<Index, 3>{});  // points of a disc on a plane
    case 4:
      return loops(std::integral_constant<Index, 4>{});  // of two discs
    case 5:
      return loops(
          std::integral_constant<Index, 5>{});  // of a ball on a plane; a body in the plane, 1 contact
    case 6:
      return loops(std::integral_constant<Index, 6>{});  // of two balls
    case 7:
      return loops(std::integral_constant<Index, 7>{});  // a body in the plane, 2 contacts
    case 10:
      return loops(std::integral_constant<Index, 10>{});  // a body in space, 1 contact
    case 14:
      return loops(std::integral_constant<Index, 14>{});  // a body in space, 2 contacts
    case 16:
      return loops(std::integral_constant<Index, 16>{});  // two bodies in space, 1 contact
    default:
      return loops(n);
  }
}

/// Likewise for the velocities of one or two bodies.
template <typename Loops>
bool with_fixed_columns(Index columns, const Loops& loops) {
  switch (columns) {
    case 3:
      return loops(std::integral_constant<Index, 3>{});
    case 6:
      return loops(std::integral_constant<Index, 6>{});
    case 12:
      return loops(std::integral_constant<Index, 12>{});
    default:
      return loops(columns);
  }
}
}  // namespace

Eigen::Map<Eigen::MatrixXd> DenseLu::matrix(Index n) {
  const auto size = static_cast<std::size_t>(n);
  if (storage_.size() < size * size) storage_.resize(size * size);
  if (inverse_pivot_.size() < size) {
    inverse_pivot_.resize(size);
    column_scale_.resize(size);
    exchanges_.resize(size);
    // What only a singular matrix needs, so that meeting the first one allocates nothing either.
    row_order_.reserve(size);
    column_order_.reserve(size);
    permuted_.reserve(size);
    null_space_.reserve(size * usual_deficiency);
  }
  n_ = n;
  return {storage_.data(), n, n};
}

bool DenseLu::factor(double tolerance) {
  return n_ < blocked_size ? factor_small(tolerance) : factor_blocked(tolerance);
}

bool DenseLu::factor_small(double tolerance) {
  return with_fixed_size(n_, [&](auto size) { return factor_of(size, tolerance); });
}

template <typename Size>
bool DenseLu::factor_of(Size size, double tolerance) {
  const Index n = size;
  double* const a = storage_.data();
  for (Index j = 0; j < n; ++j) {
    double largest = 0.0;
    for (Index i = 0; i < n; ++i) largest = std::max(largest, std::abs(a[i + j * n]));
    column_scale_[static_cast<std::size_t>(j)] = largest;
  }
  for (Index k = 0; k < n; ++k) {
    const double* const column = a + k * n;
    Index pivot_row = k;
    double pivot = std::abs(column[k]);
    for (Index i = k + 1; i < n; ++i) {
      const double candidate = std::abs(column[i]);
      if (candidate > pivot) {
        pivot = candidate;
        pivot_row = i;
      }
    }
    // Written so that a NaN fails it.
    if (!(pivot > tolerance * column_scale_[static_cast<std::size_t>(k)]) || !std::isfinite(pivot))
      return false;
    exchanges_[static_cast<std::size_t>(k)] = pivot_row;
    if (pivot_row != k) {
      for (Index j = 0; j < n; ++j) std::swap(a[k + j * n], a[pivot_row + j * n]);
    }
    eliminate(size, k);
  }
  return true;
}

bool DenseLu::factor_blocked(double tolerance) {
  Eigen::Map<Eigen::MatrixXd> a(storage_.data(), n_, n_);
  for (Index j = 0; j < n_; ++j) column_scale_[static_cast<std::size_t>(j)] = a.col(j).cwiseAbs().maxCoeff();
  blocked_.compute(a);
  a = blocked_.matrixLU();
  for (Index k = 0; k < n_; ++k) {
    const double pivot = std::abs(a(k, k));
    if (!(pivot > tolerance * column_scale_[static_cast<std::size_t>(k)]) || !std::isfinite(pivot))
      return false;
    inverse_pivot_[static_cast<std::size_t>(k)] = 1.0 / a(k, k);
  }
  return true;
}

void DenseLu::swap_rows(Index r, Index s) {
  double* const a = storage_.data();
  for (Index j = 0; j < n_; ++j) std::swap(a[r + j * n_], a[s + j * n_]);
}

void DenseLu::swap_columns(Index r, Index s) {
  double* const a = storage_.data();
  std::swap_ranges(a + r * n_, a + (r + 1) * n_, a + s * n_);
}

// One step of right-looking elimination: multipliers of column k, then the block right of and below the
// pivot, two columns at a time so that the multipliers are read half as often.
template <typename Size>
void DenseLu::eliminate(Size size, Index k) {
  const Index n = size;
  double* const a = storage_.data();
  double* const multipliers = a + k * n;
  const double inverse = 1.0 / multipliers[k];
  inverse_pivot_[static_cast<std::size_t>(k)] = inverse;
  for (Index i = k + 1; i < n; ++i) multipliers[i] *= inverse;
  const double* __restrict const column = multipliers;
  Index j = k + 1;
  for (; j + 1 < n; j += 2) {
    double* __restrict const first = a + j * n;
    double* __restrict const second = first + n;
    const double first_factor = first[k];
    const double second_factor = second[k];
    if (first_factor == 0.0 && second_factor == 0.0) continue;  // contacts leave many zeros
    for (Index i = k + 1; i < n; ++i) {
      first[i] -= first_factor * column[i];
      second[i] -= second_factor * column[i];
    }
  }
  if (j == n) return;
  double* __restrict const last = a + j * n;
  const double factor = last[k];
  for (Index i = k + 1; i < n; ++i) last[i] -= factor * column[i];
}

void DenseLu::solve(double* x) {
  permute(x);
  with_fixed_size(n_, [&](auto size) {
    const Index n = size;
    const double* const a = storage_.data();
    const auto subtract = [&](Index from, Index to, Index k) {
      double* __restrict const target = x;
      const double* __restrict const column = a + k * n;
      const double factor = target[k];
      for (Index i = from; i < to; ++i) target[i] -= column[i] * factor;
    };
    for (Index k = 0; k < n; ++k) subtract(k + 1, n, k);
    for (Index k = n - 1; k >= 0; --k) {
      x[k] *= inverse_pivot_[static_cast<std::size_t>(k)];
      subtract(0, k, k);
    }
    return true;
  });
}

void DenseLu::solve_rows(double* x, Index columns) {
  assert(n_ < blocked_size);
  const auto row = [&](Index i) { return x + i * columns; };
  for (Index k = 0; k < n_; ++k) {
    const Index other = exchanges_[static_cast<std::size_t>(k)];
    if (other != k) std::swap_ranges(row(k), row(k + 1), row(other));
  }
  with_fixed_columns(columns, [&](auto width) {
    return with_fixed_size(n_, [&](auto size) {
      const Index n = size;
      const double* const a = storage_.data();
      const auto subtract = [&](Index i, double factor, Index k) {
        double* __restrict const target = row(i);
        const double* __restrict const source = row(k);
        for (Index c = 0; c < width; ++c) target[c] -= factor * source[c];
      };
      for (Index k = 0; k < n; ++k) {
        for (Index i = k + 1; i < n; ++i) subtract(i, a[i + k * n], k);
      }
      for (Index k = n - 1; k >= 0; --k) {
        const double inverse = inverse_pivot_[static_cast<std::size_t>(k)];
        for (Index c = 0; c < width; ++c) row(k)[c] *= inverse;
        for (Index i = 0; i < k; ++i) subtract(i, a[i + k * n], k);
      }
      return true;
    });
  });
}

void DenseLu::permute(double* x) {
  if (n_ < blocked_size) {
    for (Index k = 0; k < n_; ++k) std::swap(x[k], x[exchanges_[static_cast<std::size_t>(k)]]);
    return;
  }
  permuted_.assign(x, x + n_);  // Eigen's own permutation in place allocates
  for (Index i = 0; i < n_; ++i)
    x[blocked_.permutationP().indices()[i]] = permuted_[static_cast<std::size_t>(i)];
}

Index DenseLu::factor_rank_revealing(double tolerance) {
  const auto size = static_cast<std::size_t>(n_);
  row_order_.resize(size);
  column_order_.resize(size);
  std::iota(row_order_.begin(), row_order_.end(), Index{0});
  std::iota(column_order_.begin(), column_order_.end(), Index{0});
  const Eigen::Map<Eigen::MatrixXd> a(storage_.data(), n_, n_);
  double largest = 0.0;
  for (rank_ = 0; rank_ < n_; ++rank_) {
    const Index left = n_ - rank_;
    Index row = 0;
    Index column = 0;
    const double pivot = a.bottomRightCorner(left, left).cwiseAbs().maxCoeff(&row, &column);
    largest = std::max(largest, pivot);
    if (!(pivot > tolerance * largest) || !std::isfinite(pivot)) break;
    swap_rows(rank_, rank_ + row);
    swap_columns(rank_, rank_ + column);
    std::swap(row_order_[static_cast<std::size_t>(rank_)], row_order_[static_cast<std::size_t>(rank_ + row)]);
    std::swap(column_order_[static_cast<std::size_t>(rank_)],
              column_order_[static_cast<std::size_t>(rank_ + column)]);
    eliminate(n_, rank_);
  }
  return rank_;
}

void DenseLu::solve_least_norm(const double* b, double* x) {
  permuted_.resize(static_cast<std::size_t>(n_));
  double* const y = permuted_.data();
  const double* const a = storage_.data();
  for (Index i = 0; i < n_; ++i) y[i] = i < rank_ ? b[row_order_[static_cast<std::size_t>(i)]] : 0.0;
  for (Index k = 0; k < rank_; ++k) {
    for (Index i = k + 1; i < rank_; ++i) y[i] -= a[i + k * n_] * y[k];
  }
  back_substitute(rank_, y);
  remove_null_components(y);
  for (Index j = 0; j < n_; ++j) x[column_order_[static_cast<std::size_t>(j)]] = y[j];
}

// x <- U^-1 x for the leading block of the given order.
void DenseLu::back_substitute(Index order, double* x) const {
  for (Index k = order - 1; k >= 0; --k) {
    const double* const column = storage_.data() + k * n_;
    x[k] *= inverse_pivot_[static_cast<std::size_t>(k)];
    for (Index i = 0; i < k; ++i) x[i] -= column[i] * x[k];
  }
}

// Null vector of the independent rows that has 1 in the k-th dependent column: (-U11^-1 U12 e_k, e_k).
void DenseLu::null_vector(Index k, double* x) const {
  const double* const column = storage_.data() + (rank_ + k) * n_;
  for (Index i = 0; i < n_; ++i) x[i] = i < rank_ ? -column[i] : 0.0;
  back_substitute(rank_, x);
  x[rank_ + k] = 1.0;
}

// The basic solution has zeros in the dependent columns; its shortest sibling is orthogonal to the null
// space, whose basis is made orthonormal by modified Gram-Schmidt. The deficiency is a handful at most.
void DenseLu::remove_null_components(double* x) {
  const Index deficiency = n_ - rank_;
  const auto needed = static_cast<std::size_t>(n_ * deficiency);
  if (null_space_.size() < needed) null_space_.resize(needed);
  Eigen::Map<Eigen::MatrixXd> basis(null_space_.data(), n_, deficiency);
  Eigen::Map<Eigen::VectorXd> solution(x, n_);
  for (Index k = 0; k < deficiency; ++k) {
    null_vector(k, null_space_.data() + k * n_);
    auto vector = basis.col(k);
    for (Index j = 0; j < k; ++j) vector -= basis.col(j).dot(vector) * basis.col(j);
    vector.normalize();
    solution -= vector.dot(solution) * vector;
  }
}

}  // namespace touchstone
