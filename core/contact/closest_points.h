#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The closest points of two bodies that are apart, or the points that realise the least overlap of two that
/// overlap.
template <int Dim>
struct ClosestPoints {
  Vector<Dim> a_1 = Vector<Dim>::Zero();     ///< on body 1, world frame [m]
  Vector<Dim> a_2 = Vector<Dim>::Zero();     ///< on body 2, world frame [m]
  Vector<Dim> normal = Vector<Dim>::Zero();  ///< unit, outward from body 2, into body 1
  double gap = 0.0;                          ///< psi = n . (a_1 - a_2) [m]; < 0 when they overlap
  bool converged = false;  ///< false: the best found so far; a caller must not use it as exact
};

/// Closest points from cold: no initial guess is needed, any distance, overlap included (where the bodies
/// overlap deeply the least-overlap direction found is a local one). Bodies may be of any of our shapes; not
/// two half-spaces. Does not allocate.
template <int Dim>
ClosestPoints<Dim> closest_points(const ConvexSurface<Dim>& surface_1, const Pose<Dim>& pose_1,
                                  const ConvexSurface<Dim>& surface_2, const Pose<Dim>& pose_2);

}  // namespace touchstone
