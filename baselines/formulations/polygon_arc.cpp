#include "baselines/formulations/polygon_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// The angle as a number of vertices from vertex 0, in [-edges / 2, edges / 2].
double in_vertices(const PlacedPolygon& polygon, double angle) {
  return std::remainder(angle - polygon.turn, full_turn) * polygon.edges / full_turn;
}

VertexArc arc(const PlacedPolygon& polygon, int first, int count) {
  const int wrapped = first % polygon.edges;
  return {wrapped < 0 ? wrapped + polygon.edges : wrapped, std::min(count, polygon.edges)};
}

}  // namespace

PlacedPolygon placed(const RegularPolygon& polygon, const Pose<2>& frame) {
  return {polygon.edges, polygon.circumradius, frame.position, frame.rotation.angle()};
}

double lowest_angle(const Vector<2>& slope) { return std::atan2(-slope.x(), slope.y()); }

AngleInterval below(const PlacedPolygon& polygon, const Vector<2>& slope, double level, double near) {
  const double cosine = -level / (slope.norm() * polygon.circumradius);
  if (cosine > 1.0) return {};
  const double center = near + std::remainder(lowest_angle(slope) - near, full_turn);
  const double half_width = std::acos(std::max(cosine, -1.0));
  return {center - half_width, center + half_width};
}

AngleInterval hull(const AngleInterval& a, const AngleInterval& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

VertexArc vertices_within(const PlacedPolygon& polygon, const AngleInterval& interval) {
  if (interval.empty()) return {};
  const double width = (interval.high - interval.low) * polygon.edges / full_turn;
  if (width + 3 >= polygon.edges) return {0, polygon.edges};
  const double low = in_vertices(polygon, interval.low);
  const int first = static_cast<int>(std::ceil(low)) - 1;
  const int last = static_cast<int>(std::floor(low + width)) + 1;
  return arc(polygon, first, last - first + 1);
}

VertexArc vertices_nearest(const PlacedPolygon& polygon, double angle, int count) {
  const int used = std::min(count, polygon.edges);
  return arc(polygon, static_cast<int>(std::ceil(in_vertices(polygon, angle) - used / 2.0)), used);
}

}  // namespace touchstone
