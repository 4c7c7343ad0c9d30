#include "baselines/formulations/contact_candidates.h"

#include <fmt/format.h>

#include "core/contact/closest_points.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

template <int Dim, typename Geometry>
const Geometry* geometry_as(const Shape<Dim>& shape) {
  return std::get_if<Geometry>(&shape.geometry);
}

template <int Dim>
bool is_half_space(const Shape<Dim>& shape) {
  return geometry_as<Dim, HalfSpace<Dim>>(shape) != nullptr;
}

template <int Dim>
bool is_ball(const Shape<Dim>& shape) {
  return geometry_as<Dim, Sphere<Dim>>(shape) != nullptr;
}

template <int Dim>
bool is_ellipsoid(const Shape<Dim>& shape) {
  return geometry_as<Dim, Ellipsoid<Dim>>(shape) != nullptr;
}

/// Smooth, and without a straight line on its surface: two such bodies touch at one point. A capsule is
/// smooth and has lines.
template <int Dim>
bool is_round(const Shape<Dim>& shape) {
  return is_ball(shape) || is_ellipsoid(shape) || geometry_as<Dim, Superellipsoid<Dim>>(shape) != nullptr;
}

template <int Dim>
bool is_capsule(const Shape<Dim>& shape) {
  if constexpr (Dim == 3) return geometry_as<3, Capsule>(shape) != nullptr;
  return false;
}

/// Whether the closest points are unique, `b` being the half-space if one of the two is.
template <int Dim>
bool is_smooth_pair(const Shape<Dim>& a, const Shape<Dim>& b) {
  if (is_half_space(b)) return is_round(a);
  return (is_round(a) && (is_round(b) || is_capsule(b))) || (is_capsule(a) && is_round(b));
}

template <int Dim>
bool has_closed_form(const Shape<Dim>& a, const Shape<Dim>& b) {
  if (is_half_space(b)) return is_ball(a) || is_ellipsoid(a);
  return is_ball(a) && is_ball(b);
}

template <int Dim>
WorldPlane<Dim> world_plane(const Shape<Dim>& shape, const Pose<Dim>& body) {
  const auto& half_space = std::get<HalfSpace<Dim>>(shape.geometry);
  const Pose<Dim> frame = geometry_pose(shape, body);
  const Vector<Dim> normal = frame.rotation.matrix() * half_space.normal;
  return {normal, half_space.offset + normal.dot(frame.position)};
}

/// The point of a ball or an ellipsoid that is farthest along the unit vector `direction`, world frame.
/// For x^T A^-2 x <= 1, A = diag(semi-axes), it is A^2 d / |A d|.
template <int Dim>
Vector<Dim> farthest_point(const Shape<Dim>& shape, const Pose<Dim>& body, const Vector<Dim>& direction) {
  const Pose<Dim> frame = geometry_pose(shape, body);
  if (const auto* ball = geometry_as<Dim, Sphere<Dim>>(shape)) {
    return frame.position + ball->radius * direction;
  }
  const Vector<Dim>& axes = std::get<Ellipsoid<Dim>>(shape.geometry).semi_axes;
  const Vector<Dim> scaled = axes.cwiseProduct(frame.rotation.matrix().transpose() * direction);
  return frame.to_world(axes.cwiseProduct(scaled) / scaled.norm());
}

template <int Dim>
ContactPoints<Dim> between_balls(const Shape<Dim>& a, const Pose<Dim>& pose_a, const Shape<Dim>& b,
                                 const Pose<Dim>& pose_b) {
  const double radius_a = std::get<Sphere<Dim>>(a.geometry).radius;
  const double radius_b = std::get<Sphere<Dim>>(b.geometry).radius;
  const Vector<Dim> center_a = geometry_pose(a, pose_a).position;
  const Vector<Dim> center_b = geometry_pose(b, pose_b).position;
  const Vector<Dim> between = center_a - center_b;
  const double distance = between.norm();
  // Concentric balls have no closest points; any direction parts them equally well.
  const Vector<Dim> normal = distance > 0 ? Vector<Dim>(between / distance) : Vector<Dim>::Unit(Dim - 1);
  return {center_a - radius_a * normal, center_b + radius_b * normal, normal, distance - radius_a - radius_b};
}

template <int Dim>
std::vector<Vector<Dim>> corners(const Box<Dim>& box) {
  std::vector<Vector<Dim>> result;
  for (int corner = 0; corner < (1 << Dim); ++corner) {
    Vector<Dim> signs;
    for (int axis = 0; axis < Dim; ++axis) signs[axis] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
    result.push_back(signs.cwiseProduct(box.half_extents));
  }
  return result;
}

/// Vertices in the body frame; none of a smooth shape.
template <int Dim>
std::vector<Vector<Dim>> vertices_of(const Shape<Dim>& shape) {
  std::vector<Vector<Dim>> result;
  if (const auto* box = geometry_as<Dim, Box<Dim>>(shape)) result = corners(*box);
  if (const auto* polytope = geometry_as<Dim, Polytope<Dim>>(shape)) result = polytope->vertices;
  if constexpr (Dim == 2) {
    if (const auto* polygon = geometry_as<Dim, RegularPolygon>(shape)) {
      for (int k = 0; k < polygon->edges; ++k) result.push_back(polygon->vertex(k));
    }
  }
  for (auto& vertex : result) vertex = shape.placement.to_world(vertex);
  return result;
}

/// Of a pair that has_closed_form().
template <int Dim>
ContactPoints<Dim> closed_form(const Shape<Dim>& a, const Pose<Dim>& pose_a, const Shape<Dim>& b,
                               const Pose<Dim>& pose_b) {
  if (!is_half_space(b)) return between_balls(a, pose_a, b, pose_b);
  const WorldPlane<Dim> plane = world_plane(b, pose_b);
  const Vector<Dim> point = farthest_point<Dim>(a, pose_a, -plane.normal);
  const double gap = plane.gap(point);
  return {point, point - gap * plane.normal, plane.normal, gap};
}

}  // namespace

template <int Dim>
ContactGeometry<Dim>::ContactGeometry(const Scene<Dim>& scene) : scene_(&scene) {
  const auto& bodies = scene.bodies;
  for (const auto& body : bodies) vertices_.push_back(vertices_of(body.shape));
  const auto add_pair = [&](std::size_t a, std::size_t b) {
    if (is_half_space(bodies[a].shape)) std::swap(a, b);
    const bool by_vertices = !vertices_[a].empty() && is_half_space(bodies[b].shape) && bodies[b].fixed;
    if (!by_vertices && !is_smooth_pair(bodies[a].shape, bodies[b].shape)) {
      throw Unsupported(fmt::format(
          "no contact candidates for a {} ('{}') and a {}{} ('{}'): known are shapes with vertices above a "
          "fixed half_space, and smooth bodies that touch at one point: discs or spheres, ellipses or "
          "ellipsoids and superellipsoids, above any half_space, between themselves and beside capsules",
          shape_name(bodies[a].shape), bodies[a].name, bodies[b].fixed ? "fixed " : "",
          shape_name(bodies[b].shape), bodies[b].name));
    }
    pairs_.push_back({static_cast<int>(a), static_cast<int>(b), by_vertices,
                      has_closed_form(bodies[a].shape, bodies[b].shape)});
  };
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = a + 1; b < bodies.size(); ++b) {
      if (!bodies[a].fixed || !bodies[b].fixed) add_pair(a, b);
    }
  }
  surfaces_.resize(bodies.size());
  for (const ContactPair& pair : pairs_) {
    if (pair.by_vertices || pair.closed_form) continue;
    for (const int body : {pair.body_a, pair.body_b}) {
      auto& surface = surfaces_[static_cast<std::size_t>(body)];
      if (!surface) surface = make_surface(bodies[static_cast<std::size_t>(body)].shape);
    }
  }
}

template <int Dim>
int ContactGeometry<Dim>::candidate_count() const {
  int count = 0;
  for (const auto& pair : pairs_) {
    count += pair.by_vertices ? static_cast<int>(vertices_[static_cast<std::size_t>(pair.body_a)].size()) : 1;
  }
  return count;
}

template <int Dim>
VerticesAbove<Dim> ContactGeometry<Dim>::vertices_above(const ContactPair& pair,
                                                        std::span<const BodyState<Dim>> state) const {
  const auto a = static_cast<std::size_t>(pair.body_a);
  const auto b = static_cast<std::size_t>(pair.body_b);
  return {vertices_[a], state[a].pose, world_plane(scene_->bodies[b].shape, state[b].pose)};
}

template <int Dim>
ContactPoints<Dim> ContactGeometry<Dim>::points(const ContactPair& pair, int vertex,
                                                std::span<const BodyState<Dim>> state) const {
  if (vertex != ContactCandidate<Dim>::no_vertex) return vertices_above(pair, state)[vertex];
  const auto a = static_cast<std::size_t>(pair.body_a);
  const auto b = static_cast<std::size_t>(pair.body_b);
  if (pair.closed_form)
    return closed_form(scene_->bodies[a].shape, state[a].pose, scene_->bodies[b].shape, state[b].pose);
  const ClosestPoints<Dim> closest =
      closest_points(*surfaces_[a], state[a].pose, *surfaces_[b], state[b].pose);
  return {closest.a_1, closest.a_2, closest.normal, closest.gap, closest.converged};
}

template class ContactGeometry<2>;
template class ContactGeometry<3>;

}  // namespace touchstone
