#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

/// Four numbers in single precision that are added and multiplied at once, in the vector types of the
/// compilers: a vector of space with 0 behind it, or what else comes in fours. Eigen's products of fixed size
/// go through memory where lanes change places, as in a cross product: sweeps over contacts took 1.8 times as
/// long with them.
namespace touchstone {

using Lanes = float __attribute__((vector_size(16)));

inline Lanes no_lanes() { return Lanes{0, 0, 0, 0}; }

/// `v` from lane `First` on, and 0 elsewhere. What is 1e-12 of its largest entry is rounding and becomes 0:
/// its products with small numbers would be below the least normal number, which is slow.
template <int First = 0, typename Derived>
Lanes in_lanes(const Eigen::MatrixBase<Derived>& v) {
  constexpr int kSize = Derived::RowsAtCompileTime;
  const Eigen::Matrix<typename Derived::Scalar, kSize, 1> values = v;
  const auto least = typename Derived::Scalar(1e-12) * values.cwiseAbs().maxCoeff();
  Lanes lanes = no_lanes();
  for (int i = 0; i < kSize; ++i)
    lanes[First + i] = std::abs(values[i]) > least ? static_cast<float>(values[i]) : 0.0F;
  return lanes;
}

/// `Count` lanes from `First` on.
template <int Count, int First = 0>
Eigen::Matrix<float, Count, 1> of_lanes(Lanes lanes) {
  Eigen::Matrix<float, Count, 1> values;
  for (int i = 0; i < Count; ++i) values[i] = lanes[First + i];
  return values;
}

/// a x b of vectors of space.
inline Lanes cross(Lanes a, Lanes b) {
  const Lanes c =
      a * __builtin_shufflevector(b, b, 1, 2, 0, 3) - __builtin_shufflevector(a, a, 1, 2, 0, 3) * b;
  return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}

/// Of the lanes of each.
inline Lanes sums(Lanes a, Lanes b, Lanes c, Lanes d) {
  const Lanes ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes cd = __builtin_shufflevector(c, d, 0, 4, 1, 5) + __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}
inline float sum(Lanes a) {
  const Lanes pairs = a + __builtin_shufflevector(a, a, 2, 3, 0, 1);
  return pairs[0] + pairs[1];
}

/// Without the last lane.
inline Lanes of_space(Lanes a) { return __builtin_shufflevector(a, no_lanes(), 0, 1, 2, 7); }

inline float largest_size(Lanes a) {
  return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::max(std::abs(a[2]), std::abs(a[3])));
}

}  // namespace touchstone
