#include "baselines/formulations/candidate_selection.h"

#include <algorithm>
#include <limits>

namespace touchstone {

namespace {

using Kind = CandidatePolicy::Kind;

// A vertex that the bound leaves this far out, as a fraction of its distance from the centre of mass, is let
// in: far above what rounding does to the bound and to a gap.
constexpr double kRounding = 1e-9;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// The body's regular polygon in the world; none in space or of another shape.
template <int Dim>
std::optional<PlacedPolygon> placed_polygon(const Shape<Dim>& shape, const Pose<Dim>& pose) {
  if constexpr (Dim == 2) {
    if (const auto* polygon = std::get_if<RegularPolygon>(&shape.geometry)) {
      return placed(*polygon, geometry_pose(shape, pose));
    }
  }
  return std::nullopt;
}

/// The vertices with  psi + h (least n . v' + min_omega omega (r x n)) <= 0,  r the arm from the centre of
/// mass: the minimum is taken at the least or at the largest omega, and for each of the two the left side is
/// linear in r.
VertexArc reachable_arc(const PlacedPolygon& polygon, const WorldPlane<2>& plane,
                        const Vector<2>& center_of_mass, const ReachBound<2>& bound, double h) {
  const Vector<2> across(plane.normal.y(), -plane.normal.x());  // r x n = across . r
  const double lift = plane.gap(polygon.center) + h * bound.least_normal_speed(plane.normal);
  const double offset = across.dot(polygon.center - center_of_mass);
  const auto reached_at = [&](double omega) {
    return below(polygon, plane.normal + h * omega * across, -lift - h * omega * offset,
                 lowest_angle(plane.normal));
  };
  const double least_omega = bound.least_turn(Angular<2>(1.0));
  const double largest_omega = -bound.least_turn(Angular<2>(-1.0));
  return vertices_within(polygon, hull(reached_at(least_omega), reached_at(largest_omega)));
}

/// The vertices among which those of the policy are, by index arithmetic.
VertexArc polygon_range(const PlacedPolygon& polygon, const WorldPlane<2>& plane,
                        const CandidatePolicy& policy) {
  const double down = lowest_angle(plane.normal);
  if (policy.kind == Kind::nearest) return vertices_nearest(polygon, down, policy.count);
  return vertices_within(polygon,
                         below(polygon, plane.normal, policy.distance - plane.gap(polygon.center), down));
}

}  // namespace

template <int Dim>
CandidateSelection<Dim>::CandidateSelection(const ContactGeometry<Dim>& geometry,
                                            const CandidatePolicy& policy, std::vector<double> friction)
    : geometry_(&geometry), policy_(policy), friction_(std::move(friction)) {
  planes_.reserve(geometry.pairs().size());
}

template <int Dim>
void CandidateSelection<Dim>::select(State state, std::span<const Twist<Dim>> free, double h,
                                     Candidates& candidates) {
  candidates.clear();
  const auto pairs = geometry_->pairs();
  for (int pair = 0; pair < static_cast<int>(pairs.size()); ++pair) {
    if (!pairs[at(pair)].by_vertices) {
      add_closest_points(pair, state, candidates);
      continue;
    }
    const int body = pairs[at(pair)].body_a;
    const bool bounded = policy_.kind == Kind::reachable;
    add_vertices(pair, state, bounded ? bound_of(body, state, free[at(body)], h) : Bound(), h, candidates);
  }
}

template <int Dim>
void CandidateSelection<Dim>::add_closest_points(int pair, State state, Candidates& candidates) const {
  constexpr int none = ContactCandidate<Dim>::no_vertex;
  const ContactPoints<Dim> points = geometry_->points(geometry_->pairs()[at(pair)], none, state);
  if (policy_.kind == Kind::epsilon && points.gap > policy_.distance) return;
  candidates.push_back({pair, none, points});
}

template <int Dim>
void CandidateSelection<Dim>::add_vertices(int pair, State state, const Bound& bound, double h,
                                           Candidates& candidates) {
  const ContactPair& bodies = geometry_->pairs()[at(pair)];
  const VerticesAbove<Dim> vertices = geometry_->vertices_above(bodies, state);
  const Vector<Dim>& center_of_mass = state[at(bodies.body_a)].pose.position;
  const std::size_t first = candidates.size();
  for_each_vertex(range(bodies.body_a, state, vertices, bound, h), vertices.count(), [&](int vertex) {
    const ContactPoints<Dim> points = vertices[vertex];
    if (admits(points, center_of_mass, bound, h)) candidates.push_back({pair, vertex, points});
  });
  if (policy_.kind == Kind::nearest) keep_nearest(first, candidates);
}

/// Of candidates[first], ... the policy's number of least gap, in the order they were in.
template <int Dim>
void CandidateSelection<Dim>::keep_nearest(std::size_t first, Candidates& candidates) const {
  if (candidates.size() - first <= at(policy_.count)) return;
  const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, candidates.end(), [](const auto& x, const auto& y) {
    return std::pair(x.points.gap, x.vertex) < std::pair(y.points.gap, y.vertex);
  });
  candidates.resize(first + at(policy_.count));
  std::sort(begin, candidates.end(), [](const auto& x, const auto& y) { return x.vertex < y.vertex; });
}

template <int Dim>
auto CandidateSelection<Dim>::bound_of(int body, State state, const Twist<Dim>& free, double h) -> Bound {
  planes_.clear();
  const auto pairs = geometry_->pairs();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (pairs[p].body_a != body) continue;
    const VerticesAbove<Dim> vertices = geometry_->vertices_above(pairs[p], state);
    planes_.push_back({vertices.plane().normal, least_gap(body, state, vertices), friction_[p]});
  }
  const Body<Dim>& data = geometry_->scene().bodies[at(body)];
  const Inertia<Dim> inertia = world_inertia(data.inertia, state[at(body)].pose.rotation);
  const ReachBound<Dim> bound(data.mass, inertia, free, planes_, h);
  return bound.known() ? Bound(bound) : Bound();
}

template <int Dim>
double CandidateSelection<Dim>::least_gap(int body, State state, const VerticesAbove<Dim>& vertices) const {
  VertexArc arc{0, vertices.count()};
  if constexpr (Dim == 2) {
    const auto polygon = placed_polygon(geometry_->scene().bodies[at(body)].shape, state[at(body)].pose);
    if (polygon) arc = vertices_nearest(*polygon, lowest_angle(vertices.plane().normal), 1);
  }
  double least = std::numeric_limits<double>::infinity();
  for_each_vertex(arc, vertices.count(), [&](int vertex) { least = std::min(least, vertices[vertex].gap); });
  return least;
}

template <int Dim>
VertexArc CandidateSelection<Dim>::range(int body, State state, const VerticesAbove<Dim>& vertices,
                                         const Bound& bound, double h) const {
  const VertexArc everything{0, vertices.count()};
  if constexpr (Dim == 2) {
    const Pose<2>& pose = state[at(body)].pose;
    const auto polygon = placed_polygon(geometry_->scene().bodies[at(body)].shape, pose);
    if (!polygon) return everything;
    if (bound) return reachable_arc(*polygon, vertices.plane(), pose.position, *bound, h);
    if (policy_.kind == Kind::nearest || policy_.kind == Kind::epsilon) {
      return polygon_range(*polygon, vertices.plane(), policy_);
    }
  }
  return everything;
}

template <int Dim>
bool CandidateSelection<Dim>::admits(const ContactPoints<Dim>& points, const Vector<Dim>& center_of_mass,
                                     const Bound& bound, double h) const {
  if (policy_.kind == Kind::epsilon) return points.gap <= policy_.distance;
  if (!bound) return true;
  const Vector<Dim> arm = points.point_a - center_of_mass;
  return points.gap + h * bound->least_gap_rate(points.normal, arm) <= kRounding * arm.norm();
}

template class CandidateSelection<2>;
template class CandidateSelection<3>;

}  // namespace touchstone
