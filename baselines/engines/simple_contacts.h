#pragma once

#include <span>
#include <vector>

#include "core/model/scene.h"

/// Contact points of the pairs whose gap has a closed form, for time-steppers that bring no collider of their
/// own.
namespace touchstone::engines {

/// A point pair that may touch, with the geometry at the poses it was made for.
struct PointContact {
  int body_a = 0;
  int body_b = 0;
  Vector<3> point_a = Vector<3>::Zero();  ///< world frame [m]
  Vector<3> point_b = Vector<3>::Zero();
  Vector<3> normal = Vector<3>::Zero();  ///< unit, from body_b into body_a
  double gap = 0.0;                      ///< normal . (point_a - point_b) [m]
};

/// The pairs of a scene that can touch: a sphere, ellipsoid, capsule, box or polytope with a half-space, and
/// a sphere with a sphere. A box or polytope has one point a corner, a capsule one an end.
class SimpleContacts {
 public:
  /// @param planar  bodies stay in z = 0, where one corner stands for all along z
  /// @throws Unsupported naming a pair of bodies, not both fixed, of other shapes
  SimpleContacts(const Scene<3>& scene, bool planar);

  /// Every point pair at the poses of `state`, touching or not.
  void at(std::span<const BodyState<3>> state, std::vector<PointContact>& contacts) const;

 private:
  struct Pair {
    int body_a;
    int body_b;
  };
  /// Points of a body that may touch a half-space, each with a ball of `radius` around it; body frame.
  struct Corners {
    std::vector<Vector<3>> points;
    double radius = 0.0;
  };

  void against_half_space(const Pair& pair, std::span<const BodyState<3>> state,
                          std::vector<PointContact>& contacts) const;
  void between_spheres(const Pair& pair, std::span<const BodyState<3>> state,
                       std::vector<PointContact>& contacts) const;

  const Scene<3>& scene_;
  std::vector<Corners> corners_;        ///< one a body; empty for a half-space or an ellipsoid
  std::vector<Pair> half_space_pairs_;  ///< body_b is the half-space
  std::vector<Pair> sphere_pairs_;
};

}  // namespace touchstone::engines
