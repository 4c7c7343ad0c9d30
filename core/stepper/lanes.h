#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

/// Four numbers in single precision that are added and multiplied at once, in the vector types of the
/// compilers: a vector of space with 0 behind it, or a number of each of four contacts. Eigen's products of
/// fixed size go through memory where lanes change places, and its choice between two arrays entry by entry.
namespace touchstone {

using Lanes = float __attribute__((vector_size(16)));
/// Of a comparison of two: -1 where it holds, else 0.
using LaneMask = int __attribute__((vector_size(16)));
inline constexpr std::size_t kLanes = 4;

inline Lanes no_lanes() { return Lanes{0, 0, 0, 0}; }

/// `v` as floats. What is 1e-12 of its largest entry is rounding and becomes 0: its products with small
/// numbers would be below the least normal number, which is slow.
template <typename Derived>
Eigen::Matrix<float, Derived::RowsAtCompileTime, 1> in_floats(const Eigen::MatrixBase<Derived>& v) {
  const Eigen::Matrix<typename Derived::Scalar, Derived::RowsAtCompileTime, 1> values = v;
  const auto least = typename Derived::Scalar(1e-12) * values.cwiseAbs().maxCoeff();
  return (values.array().abs() > least).select(values, 0).template cast<float>();
}

/// The same from lane `First` on, and 0 elsewhere.
template <int First = 0, typename Derived>
Lanes in_lanes(const Eigen::MatrixBase<Derived>& v) {
  const auto values = in_floats(v);
  Lanes lanes = no_lanes();
  for (int i = 0; i < Derived::RowsAtCompileTime; ++i) lanes[First + i] = values[i];
  return lanes;
}

/// `Count` lanes from `First` on.
template <int Count, int First = 0>
Eigen::Matrix<float, Count, 1> of_lanes(Lanes lanes) {
  Eigen::Matrix<float, Count, 1> values;
  for (int i = 0; i < Count; ++i) values[i] = lanes[First + i];
  return values;
}

/// Lane j of the i-th becomes lane i of the j-th.
inline void transpose(std::array<Lanes, kLanes>& rows) {
  const auto [a, b, c, d] = rows;
  const Lanes ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Lanes ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Lanes cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Lanes cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  rows = {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
          __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7),
          __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
          __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7)};
}

inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes sizes(Lanes a) { return a < 0 ? -a : a; }
/// Rounded as std::sqrt; Eigen's of four begins with an estimate that is another one on each processor.
inline Lanes roots(Lanes a) {
#ifdef __SSE__
  return _mm_sqrt_ps(a);
#else
  return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}
inline bool all(LaneMask mask) { return (mask[0] & mask[1] & mask[2] & mask[3]) != 0; }
inline float largest(Lanes a) { return std::max(std::max(a[0], a[1]), std::max(a[2], a[3])); }

/// Of vectors in space, a lane each of four.
using Space = std::array<Lanes, 3>;

inline Lanes dot(const Space& a, const Space& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Space cross(const Space& a, const Space& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace touchstone
