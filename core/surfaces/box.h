#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f_2k(x) = x_k - b_k and f_2k+1(x) = -x_k - b_k, the distances to the 2 Dim faces.
template <int Dim>
class BoxSurface final : public ConvexSurface<Dim> {
 public:
  explicit BoxSurface(const Box<Dim>& box) : half_extents_(box.half_extents) {}

  int count() const override { return 2 * Dim; }
  SurfaceJet<Dim> jet(int i, const Vector<Dim>& x) const override {
    return {value(i, x), sign(i) * Vector<Dim>::Unit(i / 2), Matrix<Dim>::Zero()};
  }
  double value(int i, const Vector<Dim>& x) const override {
    return sign(i) * x[i / 2] - half_extents_[i / 2];
  }
  /// A corner; the middle of an edge or a face that `direction` is exactly normal to.
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    return half_extents_.cwiseProduct(direction.cwiseSign());
  }
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override {
    return {Vector<Dim>::Zero(), half_extents_.norm()};
  }

 private:
  static double sign(int i) { return i % 2 == 0 ? 1.0 : -1.0; }

  Vector<Dim> half_extents_;  ///< b_k [m]
};

}  // namespace touchstone
