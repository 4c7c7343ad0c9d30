#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The point where max_i f_i is least, and how deep it lies.
template <int Dim>
struct DeepestPoint {
  Vector<Dim> point = Vector<Dim>::Zero();
  double depth = 0.0;  ///< -max_i f_i(point) [m]; > 0 inside, <= 0 if the set has no inside
};

/// @param start  a ball that contains the set, of finite radius
template <int Dim>
DeepestPoint<Dim> deepest_point(const ConvexSurface<Dim>& surface,
                                const typename ConvexSurface<Dim>::BoundingBall& start);

/// The inequality that is largest at `x`, i.e. the most violated or the nearest to it.
template <int Dim>
int largest_inequality(const ConvexSurface<Dim>& surface, const Vector<Dim>& x) {
  int largest = 0;
  double value = surface.value(0, x);
  for (int i = 1; i < surface.count(); ++i) {
    const double tried = surface.value(i, x);
    if (tried > value) {
      value = tried;
      largest = i;
    }
  }
  return largest;
}

}  // namespace touchstone
