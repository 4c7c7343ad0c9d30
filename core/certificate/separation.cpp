#include "core/certificate/separation.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchstone::certificate {

namespace {

/// How far the body reaches along `direction`, world frame, and the point that does.
template <int Dim>
Vector<Dim> farthest(const ConvexSurface<Dim>& surface, const Pose<Dim>& pose, const Vector<Dim>& direction) {
  return pose.to_world(surface.support(pose.rotation.matrix().transpose() * direction));
}

/// Points of the difference of two bodies, and the point of their hull that is nearest to the origin.
template <int Dim>
class NearestInHull {
 public:
  explicit NearestInHull(const Vector<Dim>& first) : nearest_(first) { points_[size_++] = first; }

  [[nodiscard]] const Vector<Dim>& nearest() const { return nearest_; }

  /// Adds a point and keeps those that hold the nearest one. @return whether it came closer
  bool add(const Vector<Dim>& point) {
    points_[size_] = point;
    double least = nearest_.norm();
    unsigned best = 0;
    for (unsigned others = 0; others < (1U << size_); ++others) {
      const unsigned chosen = others | 1U << size_;
      Vector<Dim> found;
      if (!nearest_of(chosen, found) || !(found.norm() < least)) continue;
      least = found.norm();
      nearest_ = found;
      best = chosen;
    }
    if (best == 0) return false;
    std::size_t kept = 0;
    for (std::size_t k = 0; k <= Dim + 1; ++k) {
      if ((best >> k & 1U) != 0) points_[kept++] = points_[k];
    }
    size_ = kept;
    return size_ <= Dim;  // with Dim + 1 points the origin is inside
  }

 private:
  /// The point nearest to the origin of the plane through the chosen points; false if it is outside their
  /// hull.
  bool nearest_of(unsigned chosen, Vector<Dim>& found) const {
    std::array<Vector<Dim>, Dim + 2> p;
    int count = 0;
    for (std::size_t k = 0; k < p.size(); ++k) {
      if ((chosen >> k & 1U) != 0) p[static_cast<std::size_t>(count++)] = points_[k];
    }
    if (count > Dim + 1) return false;
    found = p[0];
    if (count == 1) return true;
    Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim> edges(Dim, count - 1);
    for (int k = 1; k < count; ++k) edges.col(k - 1) = p[static_cast<std::size_t>(k)] - p[0];
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1> l = edges.colPivHouseholderQr().solve(-p[0]);
    if (l.minCoeff() < 0 || l.sum() > 1) return false;
    found += edges * l;
    return true;
  }

  std::array<Vector<Dim>, Dim + 2> points_;
  std::size_t size_ = 0;
  Vector<Dim> nearest_;
};

}  // namespace

template <int Dim>
double separation(const ConvexSurface<Dim>& surface_a, const Pose<Dim>& pose_a,
                  const ConvexSurface<Dim>& surface_b, const Pose<Dim>& pose_b) {
  for (const auto& [plane, plane_pose, other, other_pose] :
       {std::tuple(&surface_a, &pose_a, &surface_b, &pose_b),
        std::tuple(&surface_b, &pose_b, &surface_a, &pose_a)}) {
    if (plane->plane() == nullptr) continue;
    const Vector<Dim> normal = plane_pose->rotation.matrix() * plane->plane()->normal;
    const Vector<Dim> lowest = farthest<Dim>(*other, *other_pose, -normal);
    return plane->plane()->normal.dot(plane_pose->to_body(lowest)) - plane->plane()->offset;
  }
  constexpr int kSteps = 500;
  const auto ball_a = surface_a.bounding_ball();
  const auto ball_b = surface_b.bounding_ball();
  const double apart = (pose_a.to_world(ball_a.center) - pose_b.to_world(ball_b.center)).norm() -
                       ball_a.radius - ball_b.radius;
  if (apart > 0) return apart;
  const auto difference = [&](const Vector<Dim>& n) {  // least along n
    return Vector<Dim>(farthest<Dim>(surface_a, pose_a, -n) - farthest<Dim>(surface_b, pose_b, n));
  };
  NearestInHull<Dim> hull(difference(Vector<Dim>::UnitX()));
  double best = -std::numeric_limits<double>::infinity();
  for (int step = 0; step < kSteps && hull.nearest().norm() > 0; ++step) {
    const Vector<Dim> n = hull.nearest().normalized();
    const Vector<Dim> w = difference(n);
    best = std::max(best, n.dot(w));
    if (best > 0 || !hull.add(w)) break;
  }
  return best;
}

template double separation(const ConvexSurface<2>&, const Pose<2>&, const ConvexSurface<2>&, const Pose<2>&);
template double separation(const ConvexSurface<3>&, const Pose<3>&, const ConvexSurface<3>&, const Pose<3>&);

}  // namespace touchstone::certificate
