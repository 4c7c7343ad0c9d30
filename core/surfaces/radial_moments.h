#pragma once

#include "core/model/moments.h"
#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The moments of a bounded convex body from its inequalities alone, by integrating over the directions in
/// which rays leave a point inside: with r(u) the length of the ray along u,
///   int 1 = int r^n / n du,  int x = int u r^(n+1) / (n+1) du,  int x x^T = int u u^T r^(n+2) / (n+2) du.
/// @param tolerance  relative error of the result, up to which the integrals are refined
template <int Dim>
Moments<Dim> radial_moments(const ConvexSurface<Dim>& surface, double tolerance);

}  // namespace touchstone
