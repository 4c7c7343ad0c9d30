#pragma once

#include "core/contact/closest_points.h"

namespace touchstone {

/// Closest points in the middle of the patch in which two bodies lie flat on each other, as a start for a
/// step whose balance of moments decides where in the patch the resultant acts. closest_points() returns
/// whichever corner of it rounding makes the closest, from which a Newton method may have a long way to go.
///
/// The mean of the closest points with body 1 turned a little to four sides (in the plane to two), each of
/// which has another corner of the patch. Bodies that touch in a point have it moved by at most the turn
/// (1e-4 rad) times their size. The normal is that of closest_points(), and so is the gap.
template <int Dim>
ClosestPoints<Dim> patch_middle(const ConvexSurface<Dim>& surface_1, const Pose<Dim>& pose_1,
                                const ConvexSurface<Dim>& surface_2, const Pose<Dim>& pose_2);

}  // namespace touchstone
