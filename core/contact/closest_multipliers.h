#pragma once

#include <span>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The multipliers of an intersection at its closest point: l_i >= 0 with N = sum l_i grad f_i (Eqs. 20-22
/// with |N| = 1), 0 for what is not active. Where they are not unique (a corner of more than Dim faces) a
/// choice with no more than Dim positive ones. Does not allocate.
///
/// The point may be inexact, as that of a warm start is: inequalities count as active within a distance that
/// grows from rounding to a thousandth of the body, until their gradients make up the normal.
/// @param point_body   closest point, body frame [m]
/// @param normal_body  outward unit normal N there, body frame
/// @param out          l, surface.count() entries [-]
/// @return             |N - sum l_i grad f_i|: 0 to rounding at an exact closest point
template <int Dim>
double closest_multipliers(const ConvexSurface<Dim>& surface, const Vector<Dim>& point_body,
                           const Vector<Dim>& normal_body, std::span<double> out);

}  // namespace touchstone
