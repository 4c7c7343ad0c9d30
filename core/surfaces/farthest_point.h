#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The point of a bounded body {f_i <= 0} farthest along `direction`, from the inequalities alone.
///
/// Its reach along the direction is within 1e-12 `size` of the largest, to rounding where the active
/// inequalities determine the point; where they do not (a flat face across the direction) it is a point
/// inside the face. Does not allocate.
/// @param inside  a point with all f_i < 0
/// @param size    the body's extent [m]
template <int Dim>
Vector<Dim> farthest_point(const ConvexSurface<Dim>& surface, const Vector<Dim>& inside, double size,
                           const Vector<Dim>& direction);

}  // namespace touchstone
