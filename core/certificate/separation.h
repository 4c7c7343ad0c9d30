#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone::certificate {

/// A lower bound of the signed distance of two bodies [m], of which the sign is what matters: planes normal
/// to the nearest point of the hull of ever more points of the bodies' difference (P. Wolfe, Finding the
/// nearest point in a polytope, Math. Programming 11, 1976, on the support mappings). Ends with the first
/// plane found between them, so a positive value proves them apart and is not the distance. If none is found
/// the best bound is returned, which is 0 to a part of 1e-6 where they touch.
template <int Dim>
double separation(const ConvexSurface<Dim>& surface_a, const Pose<Dim>& pose_a,
                  const ConvexSurface<Dim>& surface_b, const Pose<Dim>& pose_b);

}  // namespace touchstone::certificate
