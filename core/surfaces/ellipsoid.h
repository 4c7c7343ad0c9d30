#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f(x) = s/2 (sum (x_i/a_i)^2 - 1), s the geometric mean of the semi-axes a_i: the paper's ellipsoid
/// (section V.C) as a length.
template <int Dim>
class EllipsoidSurface final : public ConvexSurface<Dim> {
 public:
  explicit EllipsoidSurface(const Ellipsoid<Dim>& ellipsoid)
      : semi_axes_(ellipsoid.semi_axes),
        scale_(std::pow(semi_axes_.prod(), 1.0 / Dim)),
        curvature_(scale_ * semi_axes_.array().square().inverse()) {}

  SurfaceJet<Dim> jet(int, const Vector<Dim>& x) const override {
    const Vector<Dim> gradient = curvature_.cwiseProduct(x);
    return {0.5 * (x.dot(gradient) - scale_), gradient, curvature_.asDiagonal()};
  }
  double value(int, const Vector<Dim>& x) const override {
    return 0.5 * (x.dot(curvature_.cwiseProduct(x)) - scale_);
  }
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    const Vector<Dim> stretched = semi_axes_.cwiseProduct(direction);
    return semi_axes_.cwiseProduct(stretched) / stretched.norm();
  }
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override {
    return {Vector<Dim>::Zero(), semi_axes_.maxCoeff()};
  }

 private:
  Vector<Dim> semi_axes_;  ///< a_i [m]
  double scale_;           ///< s [m]
  Vector<Dim> curvature_;  ///< s / a_i^2, the diagonal of the Hessian [1/m]
};

}  // namespace touchstone
