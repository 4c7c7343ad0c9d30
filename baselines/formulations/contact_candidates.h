#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/model/scene.h"
#include "core/surfaces/convex_surface.h"

/// Where two bodies may come to touch, for formulations that freeze the contact geometry at the start of a
/// step.
namespace touchstone {

/// A point of each body and the line between them, world frame. The gap falls at the rate at which the point
/// of A approaches that of B along the normal, so  psi + h n . (v_a - v_b)  is the gap linearised over a step
/// h.
template <int Dim>
struct ContactPoints {
  Vector<Dim> point_a = Vector<Dim>::Zero();  ///< [m]
  Vector<Dim> point_b = Vector<Dim>::Zero();  ///< [m]
  Vector<Dim> normal = Vector<Dim>::Zero();   ///< unit, from body B into body A
  double gap = 0.0;                           ///< psi = normal . (point_a - point_b), > 0 when apart [m]
  bool exact = true;  ///< false: a search for them ended without an answer; these are the best it has
};

/// A half-space in the world: normal . x <= offset is solid.
template <int Dim>
struct WorldPlane {
  Vector<Dim> normal = Vector<Dim>::Zero();
  double offset = 0.0;

  [[nodiscard]] double gap(const Vector<Dim>& point) const { return normal.dot(point) - offset; }
};

/// Two bodies that can touch. If one of them is a half-space it is B.
struct ContactPair {
  int body_a = 0;
  int body_b = 0;
  bool by_vertices = false;  ///< A has vertices and B is a fixed half-space: a candidate a vertex of A
  bool closed_form = false;  ///< two balls, or a ball or an ellipsoid above a half-space
};

/// One possible contact of a pair: a vertex of A against the half-space B, or the closest points of two
/// smooth bodies.
template <int Dim>
struct ContactCandidate {
  static constexpr int no_vertex = -1;

  int pair = 0;            ///< index into ContactGeometry::pairs()
  int vertex = no_vertex;  ///< of body A
  ContactPoints<Dim> points;
};

/// The vertices of a body above a half-space, both at their places in the world.
template <int Dim>
class VerticesAbove {
 public:
  VerticesAbove(std::span<const Vector<Dim>> body_points, const Pose<Dim>& pose, const WorldPlane<Dim>& plane)
      : body_points_(body_points),
        position_(pose.position),
        rotation_(pose.rotation.matrix()),
        plane_(plane) {}

  [[nodiscard]] int count() const { return static_cast<int>(body_points_.size()); }
  [[nodiscard]] const WorldPlane<Dim>& plane() const { return plane_; }
  [[nodiscard]] ContactPoints<Dim> operator[](int vertex) const {
    const Vector<Dim> point = position_ + rotation_ * body_points_[static_cast<std::size_t>(vertex)];
    const double gap = plane_.gap(point);
    return {point, point - gap * plane_.normal, plane_.normal, gap};
  }

 private:
  std::span<const Vector<Dim>> body_points_;
  Vector<Dim> position_;
  Matrix<Dim> rotation_;
  WorldPlane<Dim> plane_;
};

/// What a scene's bodies are to contact: vertices or smooth, and the pairs of them that can touch. Keeps a
/// reference to the scene.
///
/// Smooth pairs are those whose closest points are unique wherever the bodies stand: of balls, ellipsoids and
/// superellipsoids among themselves, above half-spaces and beside capsules. Their points come in closed form
/// or from the query of core/contact/closest_points.h.
template <int Dim>
class ContactGeometry {
 public:
  /// @throws Unsupported, naming both bodies, if a pair of shapes has no contact candidates here
  explicit ContactGeometry(const Scene<Dim>& scene);

  [[nodiscard]] const Scene<Dim>& scene() const { return *scene_; }
  /// Pairs of which one body at least moves, in the order of their indices.
  [[nodiscard]] std::span<const ContactPair> pairs() const { return pairs_; }
  /// Number of candidates of all pairs together.
  [[nodiscard]] int candidate_count() const;

  /// The candidates of a pair with `by_vertices`, at the poses in `state`. Refers to this object.
  [[nodiscard]] VerticesAbove<Dim> vertices_above(const ContactPair& pair,
                                                  std::span<const BodyState<Dim>> state) const;
  /// Vertex `vertex` of the pair's body A, or the closest points (no_vertex), at the poses in `state`.
  [[nodiscard]] ContactPoints<Dim> points(const ContactPair& pair, int vertex,
                                          std::span<const BodyState<Dim>> state) const;

 private:
  const Scene<Dim>* scene_;
  std::vector<std::vector<Vector<Dim>>> vertices_;  // by body, in its frame; none of a smooth body
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;  // by body; where a query needs one
  std::vector<ContactPair> pairs_;
};

/// Where the frame of a shape's geometry stands in the world if its body stands at `body`.
template <int Dim>
Pose<Dim> geometry_pose(const Shape<Dim>& shape, const Pose<Dim>& body) {
  return {body.to_world(shape.placement.position), body.rotation * shape.placement.rotation};
}

}  // namespace touchstone
