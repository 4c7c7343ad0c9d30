#include "core/contact/closest_points.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/closest_newton.h"
#include "core/contact/expanding_polytope.h"
#include "core/contact/gjk.h"

namespace touchstone {

namespace {

/// What a defect must not exceed, over size + distance, for the answer to count as proven.
constexpr double kProven = 1e-12;
/// A defect that is not worth another start, over size + distance.
constexpr double kRounding = 1e-14;

/// A half-space's closest point is the projection of the other body's lowest point.
template <int Dim>
ClosestPoints<Dim> against_plane(const ConvexSurface<Dim>& body, const Pose<Dim>& body_pose,
                                 const HalfSpace<Dim>& plane, const Pose<Dim>& plane_pose) {
  ClosestPoints<Dim> closest;
  const Vector<Dim> n = plane_pose.rotation.matrix() * plane.normal;
  closest.normal = n;
  const Vector<Dim> arm =
      body_pose.rotation.matrix() * body.support(body_pose.rotation.matrix().transpose() * -n);
  closest.a_1 = body_pose.position + arm;
  closest.gap = n.dot(body_pose.position - plane_pose.position) + n.dot(arm) - plane.offset;
  closest.a_2 = closest.a_1 - closest.gap * n;
  closest.converged = closest.a_1.allFinite();
  return closest;
}

/// On the line of their centres, which must not coincide.
template <int Dim>
ClosestPoints<Dim> between_balls(const ConvexSurface<Dim>& ball_1, const Pose<Dim>& pose_1,
                                 const ConvexSurface<Dim>& ball_2, const Pose<Dim>& pose_2) {
  const auto first = ball_1.bounding_ball();
  const auto second = ball_2.bounding_ball();
  const Vector<Dim> center_1 = pose_1.to_world(first.center);
  const Vector<Dim> center_2 = pose_2.to_world(second.center);
  const Vector<Dim> apart = center_1 - center_2;
  const double distance = apart.norm();
  ClosestPoints<Dim> closest;
  closest.normal = apart / distance;
  closest.a_1 = center_1 - first.radius * closest.normal;
  closest.a_2 = center_2 + second.radius * closest.normal;
  closest.gap = distance - first.radius - second.radius;
  closest.converged = closest.normal.allFinite();
  return closest;
}

/// Tries starts for Newton's method in the order of their cost until one ends exact; keeps the best.
template <int Dim>
class Search {
 public:
  explicit Search(const BodyPair<Dim>& bodies) : bodies_(bodies) {}

  [[nodiscard]] const Candidate<Dim>& best() const { return best_; }
  [[nodiscard]] bool proven() const { return defect_ <= kProven * scale(); }

  void run() {
    constexpr GjkOptions kCoarse{1e-4, 1e-2};
    constexpr GjkOptions kFine{1e-8, 1e-5};
    constexpr GjkOptions kFinest{1e-15, 1e-15};
    const Distance<Dim> distance = gjk(bodies_, kCoarse);
    if (distance.lower > 0) {
      floor_ = distance.lower;
      if (take(distance, 1e-2) || take(gjk(bodies_, kFine), 1e-4) || take(gjk(bodies_, kFinest), 1e-6))
        return;
      settle(distance.v.normalized());
    } else {
      if (settle(least_overlap_direction(bodies_, 1e-6, 2e-2))) return;
      settle(least_overlap_direction(bodies_, 1e-12, 1e-12));
    }
  }

 private:
  [[nodiscard]] double scale() const { return bodies_.size + std::abs(best_.gap()); }

  /// Ascends from `n` to a local maximum of the separation s, the least overlap.
  ///
  /// Moved apart by t n, t > -s(n), the bodies have a distance, max over u of s(u) + t n.u. The direction u
  /// of it has s(u) >= s(n) + t (1 - n.u): a proximal-point step, and each is a problem that gjk() can solve.
  /// Steps lengthen as t shrinks to the overlap itself, which a corner barely inside the other body asks for.
  /// @return true if it ended exact
  bool settle(Vector<Dim> n) {
    constexpr double kFirst = 0.1;  // distance to solve at, over size
    constexpr double kLast = 1e-10;
    double separation = bodies_.separation(n);
    for (double apart = kFirst; apart >= kLast; apart *= 0.1) {
      floor_ = std::max(floor_, separation);
      const Vector<Dim> shift = (apart * bodies_.size - separation) * n;
      const BodyPair<Dim> moved{bodies_.body_1.moved(shift), bodies_.body_2, bodies_.size};
      Distance<Dim> distance = gjk(moved, {1e-3 * apart, 0.1 * apart});
      distance.a_1 -= shift;
      if (take(distance, 0.1 * apart)) return true;
      if (!(distance.v.norm() > 0)) break;
      const Vector<Dim> next = distance.v.normalized();
      const double reached = bodies_.separation(next);
      if (reached > separation) {
        separation = reached;
        n = next;
      }
    }
    return false;
  }
  bool take(const Distance<Dim>& distance, double slack) {
    if (!(distance.v.norm() > 0)) return false;  // no direction: touching, to the last digit
    return take(Candidate<Dim>{distance.a_1, distance.a_2, distance.v.normalized()}, slack);
  }
  bool take(Candidate<Dim> candidate, double slack) {
    const double found = closest_newton(bodies_, slack * bodies_.size, candidate);
    const double tried = std::max(found, floor_ - candidate.gap());
    if (tried < defect_) {
      defect_ = tried;
      best_ = candidate;
    }
    return defect_ <= kRounding * scale();
  }

  const BodyPair<Dim>& bodies_;
  Candidate<Dim> best_;
  double defect_ = std::numeric_limits<double>::infinity();
  double floor_ =
      -std::numeric_limits<double>::infinity();  ///< greatest separation met: psi cannot be less [m]
};

}  // namespace

template <int Dim>
ClosestPoints<Dim> closest_points(const ConvexSurface<Dim>& surface_1, const Pose<Dim>& pose_1,
                                  const ConvexSurface<Dim>& surface_2, const Pose<Dim>& pose_2) {
  if (surface_2.plane() != nullptr) return against_plane(surface_1, pose_1, *surface_2.plane(), pose_2);
  if (surface_1.plane() != nullptr) {
    ClosestPoints<Dim> swapped = against_plane(surface_2, pose_2, *surface_1.plane(), pose_1);
    std::swap(swapped.a_1, swapped.a_2);
    swapped.normal = -swapped.normal;
    return swapped;
  }
  if (surface_1.is_ball() && surface_2.is_ball()) {
    const ClosestPoints<Dim> closest = between_balls(surface_1, pose_1, surface_2, pose_2);
    if (closest.converged) return closest;
  }
  const Vector<Dim> origin = pose_2.position;
  const BodyPair<Dim> bodies{{surface_1, pose_1, origin},
                             {surface_2, pose_2, origin},
                             surface_1.bounding_ball().radius + surface_2.bounding_ball().radius};
  Search<Dim> search(bodies);
  search.run();
  const Candidate<Dim>& best = search.best();
  return {origin + best.a_1, origin + best.a_2, best.normal, best.gap(), search.proven()};
}

template ClosestPoints<2> closest_points(const ConvexSurface<2>&, const Pose<2>&, const ConvexSurface<2>&,
                                         const Pose<2>&);
template ClosestPoints<3> closest_points(const ConvexSurface<3>&, const Pose<3>&, const ConvexSurface<3>&,
                                         const Pose<3>&);

}  // namespace touchstone
