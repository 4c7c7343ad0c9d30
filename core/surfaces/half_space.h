#pragma once

#include <limits>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f(x) = normal . x - offset, the distance itself.
template <int Dim>
class HalfSpaceSurface final : public ConvexSurface<Dim> {
 public:
  explicit HalfSpaceSurface(const HalfSpace<Dim>& half_space) : plane_(half_space) {}

  SurfaceJet<Dim> jet(int, const Vector<Dim>& x) const override {
    return {value(0, x), plane_.normal, Matrix<Dim>::Zero()};
  }
  double value(int, const Vector<Dim>& x) const override { return plane_.normal.dot(x) - plane_.offset; }
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    const bool bounded = (direction / direction.norm() - plane_.normal).norm() < 1e-14;
    return bounded ? Vector<Dim>(plane_.offset * plane_.normal)
                   : Vector<Dim>(Vector<Dim>::Constant(std::numeric_limits<double>::infinity()));
  }
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override {
    return {Vector<Dim>::Zero(), std::numeric_limits<double>::infinity()};
  }
  const HalfSpace<Dim>* plane() const override { return &plane_; }

 private:
  HalfSpace<Dim> plane_;
};

}  // namespace touchstone
