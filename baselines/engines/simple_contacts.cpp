#include "baselines/engines/simple_contacts.h"

#include <algorithm>

#include "baselines/engines/shapes.h"
#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

template <typename T>
bool holds(const Body<3>& body) {
  return std::holds_alternative<T>(body.shape.geometry);
}

Pose<3> shape_pose(const Body<3>& body, const Pose<3>& pose) {
  return {pose.to_world(body.shape.placement.position), pose.rotation * body.shape.placement.rotation};
}

/// The lowest point of an ellipsoid along `direction`, world frame.
Vector<3> support(const Ellipsoid<3>& shape, const Pose<3>& pose, const Vector<3>& direction) {
  const Vector<3> d = pose.rotation.matrix().transpose() * direction;
  const Vector<3> scaled = shape.semi_axes.cwiseProduct(d);
  return pose.to_world(shape.semi_axes.cwiseProduct(scaled) / scaled.norm());
}

}  // namespace

SimpleContacts::SimpleContacts(const Scene<3>& scene, bool planar) : scene_(scene) {
  for (const auto& body : scene.bodies) {
    Corners& corners = corners_.emplace_back();
    const auto& geometry = body.shape.geometry;
    if (const auto* s = std::get_if<Sphere<3>>(&geometry)) corners = {{Vector<3>::Zero()}, s->radius};
    if (const auto* s = std::get_if<Capsule>(&geometry)) {
      corners = {{s->half_height * Vector<3>::UnitZ(), -s->half_height * Vector<3>::UnitZ()}, s->radius};
    }
    if (corners.points.empty()) corners.points = convex_corners(geometry);
    if (planar) keep_one_of_each_in_plane(corners.points);
  }
  const int count = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const auto& a = scene.bodies[static_cast<std::size_t>(i)];
      const auto& b = scene.bodies[static_cast<std::size_t>(j)];
      const auto touches_plane = [&](int k, const Body<3>& body) {
        return !corners_[static_cast<std::size_t>(k)].points.empty() || holds<Ellipsoid<3>>(body);
      };
      if (a.fixed && b.fixed) continue;
      if (holds<Sphere<3>>(a) && holds<Sphere<3>>(b)) {
        sphere_pairs_.push_back({i, j});
      } else if (holds<HalfSpace<3>>(b) && touches_plane(i, a)) {
        half_space_pairs_.push_back({i, j});
      } else if (holds<HalfSpace<3>>(a) && touches_plane(j, b)) {
        half_space_pairs_.push_back({j, i});
      } else {
        throw Unsupported(fmt::format("no closed form for the gap of '{}' ({}) and '{}' ({})", a.name,
                                      shape_name(a.shape), b.name, shape_name(b.shape)));
      }
    }
  }
}

void SimpleContacts::at(std::span<const BodyState<3>> state, std::vector<PointContact>& contacts) const {
  contacts.clear();
  for (const auto& pair : half_space_pairs_) against_half_space(pair, state, contacts);
  for (const auto& pair : sphere_pairs_) between_spheres(pair, state, contacts);
}

void SimpleContacts::against_half_space(const Pair& pair, std::span<const BodyState<3>> state,
                                        std::vector<PointContact>& contacts) const {
  const auto a = static_cast<std::size_t>(pair.body_a);
  const auto b = static_cast<std::size_t>(pair.body_b);
  const Pose<3> pose = shape_pose(scene_.bodies[a], state[a].pose);
  const Pose<3> ground = shape_pose(scene_.bodies[b], state[b].pose);
  const auto& half_space = std::get<HalfSpace<3>>(scene_.bodies[b].shape.geometry);
  const Vector<3> normal = ground.rotation.matrix() * half_space.normal;
  const double offset = half_space.offset + normal.dot(ground.position);
  const auto add = [&](const Vector<3>& point) {
    const double gap = normal.dot(point) - offset;
    contacts.push_back({pair.body_a, pair.body_b, point, point - gap * normal, normal, gap});
  };
  if (const auto* ellipsoid = std::get_if<Ellipsoid<3>>(&scene_.bodies[a].shape.geometry)) {
    add(support(*ellipsoid, pose, -normal));
  }
  for (const auto& corner : corners_[a].points) add(pose.to_world(corner) - corners_[a].radius * normal);
}

void SimpleContacts::between_spheres(const Pair& pair, std::span<const BodyState<3>> state,
                                     std::vector<PointContact>& contacts) const {
  const auto a = static_cast<std::size_t>(pair.body_a);
  const auto b = static_cast<std::size_t>(pair.body_b);
  const Vector<3> centre_a = shape_pose(scene_.bodies[a], state[a].pose).position;
  const Vector<3> centre_b = shape_pose(scene_.bodies[b], state[b].pose).position;
  const Vector<3> between = centre_a - centre_b;
  if (between.norm() == 0) return;  // no direction to part them in
  const Vector<3> normal = between.normalized();
  const double gap = between.norm() - corners_[a].radius - corners_[b].radius;
  contacts.push_back({pair.body_a, pair.body_b, centre_a - corners_[a].radius * normal,
                      centre_b + corners_[b].radius * normal, normal, gap});
}

}  // namespace touchstone::engines
