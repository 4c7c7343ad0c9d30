#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f(x) = (|x|^2 - R^2) / (2 R): the disc of Eq. 15 and the ball, as a length.
template <int Dim>
class SphereSurface final : public ConvexSurface<Dim> {
 public:
  explicit SphereSurface(const Sphere<Dim>& sphere) : radius_(sphere.radius) {}

  SurfaceJet<Dim> jet(int, const Vector<Dim>& x) const override {
    return {value(0, x), x / radius_, Matrix<Dim>::Identity() / radius_};
  }
  double value(int, const Vector<Dim>& x) const override {
    return 0.5 * (x.squaredNorm() / radius_ - radius_);
  }
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    return radius_ / direction.norm() * direction;
  }
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override {
    return {Vector<Dim>::Zero(), radius_};
  }
  bool is_ball() const override { return true; }

 private:
  double radius_;  ///< R [m]
};

}  // namespace touchstone
