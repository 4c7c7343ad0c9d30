#pragma once

#include <cmath>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f_0 = (x^2 + y^2 - R^2) / (2 R), the lateral surface as the sphere's f in its cross-section;
/// f_1 = z - h and f_2 = -z - h, the ends.
class CylinderSurface final : public ConvexSurface<3> {
 public:
  explicit CylinderSurface(const Cylinder& cylinder)
      : radius_(cylinder.radius), half_height_(cylinder.half_height) {}

  int count() const override { return 3; }
  SurfaceJet<3> jet(int i, const Vector<3>& x) const override {
    if (i > 0) return {value(i, x), end_sign(i) * Vector<3>::UnitZ(), Matrix<3>::Zero()};
    const Vector<3> across(1 / radius_, 1 / radius_, 0);
    return {value(0, x), across.cwiseProduct(x), across.asDiagonal()};
  }
  double value(int i, const Vector<3>& x) const override {
    if (i > 0) return end_sign(i) * x.z() - half_height_;
    return 0.5 * (x.head<2>().squaredNorm() / radius_ - radius_);
  }
  /// A point of a rim; the middle of the end or of the generator that `direction` is exactly normal to.
  Vector<3> support(const Vector<3>& direction) const override {
    const double across = direction.head<2>().norm();
    Vector<3> point = Vector<3>::Zero();
    if (across > 0) point.head<2>() = radius_ / across * direction.head<2>();
    if (direction.z() != 0) point.z() = std::copysign(half_height_, direction.z());
    return point;
  }
  BoundingBall bounding_ball() const override {
    return {Vector<3>::Zero(), std::hypot(radius_, half_height_)};
  }

 private:
  static double end_sign(int i) { return i == 1 ? 1.0 : -1.0; }

  double radius_;       ///< R [m]
  double half_height_;  ///< h [m]
};

}  // namespace touchstone
