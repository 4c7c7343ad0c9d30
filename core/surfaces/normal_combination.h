#pragma once

#include <array>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// A normal as a nonnegative combination of gradients, N = sum_k multiplier_k grad f_index_k(x): the
/// stationarity of Eqs. 20-22 at one point. At most Dim gradients are needed (Caratheodory).
template <int Dim>
struct NormalCombination {
  int size = 0;                                ///< entries in use of the two arrays
  std::array<int, Dim> index{};                ///< of the inequalities, each different
  std::array<double, Dim> multiplier{};        ///< > 0 [-]
  Vector<Dim> residual = Vector<Dim>::Zero();  ///< N minus the combination; zero if N is in the normal cone
};

/// The nonnegative combination of the gradients active at `x` that comes closest to `normal`.
/// @param normal  body frame, not zero
/// @param slack   f_i(x) >= -slack makes inequality i active [m]
template <int Dim>
NormalCombination<Dim> normal_combination(const ConvexSurface<Dim>& surface, const Vector<Dim>& x,
                                          const Vector<Dim>& normal, double slack);

}  // namespace touchstone
