#include "experiments/scene_file/overlaps.h"

#include <algorithm>

#include "core/contact/closest_points.h"

namespace touchstone::scene_file {

namespace {

template <int Dim>
using Surface = std::shared_ptr<const ConvexSurface<Dim>>;

/// Two half-spaces have no closest points; whether a method takes them is its own business.
template <int Dim>
bool may_collide(const Scene<Dim>& scene, const std::vector<Surface<Dim>>& surfaces, std::size_t i,
                 std::size_t j) {
  if (scene.bodies[i].fixed && scene.bodies[j].fixed) return false;
  if (surfaces[i]->plane() != nullptr && surfaces[j]->plane() != nullptr) return false;
  return !scene.jointed(static_cast<int>(i), static_cast<int>(j));
}

template <int Dim>
bool balls_apart(const Surface<Dim>& a, const Pose<Dim>& pose_a, const Surface<Dim>& b,
                 const Pose<Dim>& pose_b) {
  const auto ball_a = a->bounding_ball();
  const auto ball_b = b->bounding_ball();
  const double distance = (pose_a.to_world(ball_a.center) - pose_b.to_world(ball_b.center)).norm();
  return distance > ball_a.radius + ball_b.radius;
}

}  // namespace

template <int Dim>
std::optional<Overlap> find_overlap(const Scene<Dim>& scene) {
  constexpr double kTolerance = 1e-9;
  std::vector<Surface<Dim>> surfaces;
  for (const auto& body : scene.bodies) surfaces.push_back(make_surface(body.shape));
  for (std::size_t j = 1; j < surfaces.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (!may_collide(scene, surfaces, i, j)) continue;
      const Pose<Dim>& pose_i = scene.bodies[i].pose;
      const Pose<Dim>& pose_j = scene.bodies[j].pose;
      if (balls_apart(surfaces[i], pose_i, surfaces[j], pose_j)) continue;
      const auto closest = closest_points(*surfaces[i], pose_i, *surfaces[j], pose_j);
      const double size = std::min(surfaces[i]->bounding_ball().radius, surfaces[j]->bounding_ball().radius);
      const Overlap overlap = {static_cast<int>(i), static_cast<int>(j), -closest.gap, kTolerance * size};
      if (overlap.depth > overlap.allowed) return overlap;
    }
  }
  return std::nullopt;
}

template std::optional<Overlap> find_overlap(const Scene<2>&);
template std::optional<Overlap> find_overlap(const Scene<3>&);

}  // namespace touchstone::scene_file
