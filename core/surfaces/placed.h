#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// A surface moved by `placement` in the body frame.
template <int Dim>
class PlacedSurface final : public ConvexSurface<Dim> {
 public:
  PlacedSurface(std::shared_ptr<const ConvexSurface<Dim>> inner, const Pose<Dim>& placement)
      : inner_(std::move(inner)), placement_(placement) {
    if (const HalfSpace<Dim>* plane = inner_->plane()) {
      plane_.normal = placement_.rotation.matrix() * plane->normal;
      plane_.offset = plane->offset + plane_.normal.dot(placement_.position);
    }
  }

  int count() const override { return inner_->count(); }
  SurfaceJet<Dim> jet(int i, const Vector<Dim>& x) const override {
    const Matrix<Dim> rotation = placement_.rotation.matrix();
    const SurfaceJet<Dim> jet = inner_->jet(i, placement_.to_body(x));
    return {jet.value, rotation * jet.gradient, rotation * jet.hessian * rotation.transpose()};
  }
  double value(int i, const Vector<Dim>& x) const override { return inner_->value(i, placement_.to_body(x)); }
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    return placement_.to_world(inner_->support(placement_.rotation.matrix().transpose() * direction));
  }
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override {
    const auto ball = inner_->bounding_ball();
    return {placement_.to_world(ball.center), ball.radius};
  }
  bool is_ball() const override { return inner_->is_ball(); }
  const HalfSpace<Dim>* plane() const override { return inner_->plane() == nullptr ? nullptr : &plane_; }

 private:
  std::shared_ptr<const ConvexSurface<Dim>> inner_;
  Pose<Dim> placement_;
  HalfSpace<Dim> plane_{};  ///< placed; only if inner_ is a plane
};

}  // namespace touchstone
