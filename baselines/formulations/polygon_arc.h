#pragma once

#include "core/model/pose.h"
#include "core/model/shape.h"

/// Vertices of a regular polygon by index arithmetic: those on which a linear function of the position is
/// small form an arc around its lowest point, so finding them costs their number and not that of all
/// vertices.
namespace touchstone {

/// Consecutive vertices of a polygon of N edges: first, first + 1, ... modulo N; 0 <= first < N.
struct VertexArc {
  int first = 0;
  int count = 0;
};

/// The circumscribed circle of a polygon in the world, with the turn of its vertices.
/// The point of the circle at angle a is  center + R (sin a, -cos a);  vertex k has  a = turn + 2 pi k / N.
struct PlacedPolygon {
  int edges = 3;
  double circumradius = 1.0;
  Vector<2> center = Vector<2>::Zero();
  double turn = 0.0;  ///< [rad]
};

/// `frame` is where the polygon's own frame stands in the world.
PlacedPolygon placed(const RegularPolygon& polygon, const Pose<2>& frame);

/// Angles from low to high on the circumscribed circle, [rad]; empty if low > high.
struct AngleInterval {
  double low = 1.0;
  double high = 0.0;
  [[nodiscard]] bool empty() const { return low > high; }
};

/// Where on the circle  slope . x <= level,  x from the polygon's centre; slope is not zero.
/// With slope = |slope| (-sin g, cos g) the function is  -|slope| R cos(a - g): an interval centred on g,
/// which is given within half a turn of `near`.
AngleInterval below(const PlacedPolygon& polygon, const Vector<2>& slope, double level, double near);

/// The angle g at which  slope . x  is lowest.
double lowest_angle(const Vector<2>& slope);

/// The least interval that holds both.
AngleInterval hull(const AngleInterval& a, const AngleInterval& b);

/// The vertices within the interval and one more at each end, which takes up the rounding of the angles.
VertexArc vertices_within(const PlacedPolygon& polygon, const AngleInterval& interval);

/// The `count` vertices (at most all) nearest in angle to `angle`; of two equally near the one of the smaller
/// angle.
VertexArc vertices_nearest(const PlacedPolygon& polygon, double angle, int count);

/// Calls visit(k) for every vertex of the arc, in ascending order of k.
template <typename Visit>
void for_each_vertex(const VertexArc& arc, int edges, Visit&& visit) {
  const int end = arc.first + arc.count;
  for (int k = 0; k < end - edges; ++k) visit(k);
  for (int k = arc.first; k < (end < edges ? end : edges); ++k) visit(k);
}

}  // namespace touchstone
