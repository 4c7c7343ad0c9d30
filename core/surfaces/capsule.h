#pragma once

#include <algorithm>
#include <cmath>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f(x) = (d^2 - R^2) / (2 R), d the distance from x to the segment |z| <= h on the axis.
///
/// One inequality rather than an intersection: d^2 is convex as the squared distance to a convex set. It is
/// C1 and piecewise quadratic; on |z| = h, where cylinder and caps meet, the Hessian jumps and the one-sided
/// value of the cylinder is given, an element of the generalised Hessian as semismooth Newton asks.
class CapsuleSurface final : public ConvexSurface<3> {
 public:
  explicit CapsuleSurface(const Capsule& capsule)
      : radius_(capsule.radius), half_height_(capsule.half_height) {}

  SurfaceJet<3> jet(int, const Vector<3>& x) const override {
    const double along = std::abs(x.z()) > half_height_ ? 1 / radius_ : 0.0;
    return {value(0, x), from_segment(x) / radius_, Vector<3>(1 / radius_, 1 / radius_, along).asDiagonal()};
  }
  double value(int, const Vector<3>& x) const override {
    return 0.5 * (from_segment(x).squaredNorm() / radius_ - radius_);
  }
  Vector<3> support(const Vector<3>& direction) const override {
    Vector<3> point = radius_ / direction.norm() * direction;
    if (direction.z() != 0) point.z() += std::copysign(half_height_, direction.z());
    return point;
  }
  BoundingBall bounding_ball() const override { return {Vector<3>::Zero(), radius_ + half_height_}; }

 private:
  /// x minus the segment's point closest to it.
  [[nodiscard]] Vector<3> from_segment(const Vector<3>& x) const {
    return {x.x(), x.y(), x.z() - std::clamp(x.z(), -half_height_, half_height_)};
  }

  double radius_;       ///< R [m]
  double half_height_;  ///< h [m]
};

}  // namespace touchstone
