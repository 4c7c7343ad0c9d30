#pragma once

#include "core/surfaces/convex_surface.h"

/// The Minkowski difference C = {a_1 - a_2} of two bodies. Their signed distance is that of the origin from
/// C, and all that the searches need of C is its support mapping.
namespace touchstone {

/// A body where it stands. Positions are relative to an origin near both bodies, so that no digits are lost
/// far from the world's.
template <int Dim>
class StandingBody {
 public:
  StandingBody(const ConvexSurface<Dim>& surface, const Pose<Dim>& pose, const Vector<Dim>& origin)
      : surface_(&surface), rotation_(pose.rotation.matrix()), position_(pose.position - origin) {}

  [[nodiscard]] const ConvexSurface<Dim>& surface() const { return *surface_; }
  [[nodiscard]] const Matrix<Dim>& rotation() const { return rotation_; }
  [[nodiscard]] Vector<Dim> to_body(const Vector<Dim>& x) const {
    return rotation_.transpose() * (x - position_);
  }
  [[nodiscard]] Vector<Dim> to_world(const Vector<Dim>& x_body) const {
    return position_ + rotation_ * x_body;
  }
  [[nodiscard]] Vector<Dim> turned_to_body(const Vector<Dim>& direction) const {
    return rotation_.transpose() * direction;
  }
  [[nodiscard]] StandingBody moved(const Vector<Dim>& by) const {
    StandingBody body = *this;
    body.position_ += by;
    return body;
  }
  /// The body's point farthest along `direction`.
  [[nodiscard]] Vector<Dim> support(const Vector<Dim>& direction) const {
    return to_world(surface_->support(turned_to_body(direction)));
  }
  /// max_i f_i: how far `x` is outside, to first order [m].
  [[nodiscard]] double outside(const Vector<Dim>& x) const {
    const Vector<Dim> x_body = to_body(x);
    double largest = surface_->value(0, x_body);
    for (int i = 1; i < surface_->count(); ++i) largest = std::max(largest, surface_->value(i, x_body));
    return largest;
  }

 private:
  const ConvexSurface<Dim>* surface_;
  Matrix<Dim> rotation_;
  Vector<Dim> position_;
};

/// A point of C and the points of the bodies that it is the difference of.
template <int Dim>
struct Difference {
  Vector<Dim> w = Vector<Dim>::Zero();  ///< a_1 - a_2
  Vector<Dim> a_1 = Vector<Dim>::Zero();
  Vector<Dim> a_2 = Vector<Dim>::Zero();
};

template <int Dim>
struct BodyPair {
  StandingBody<Dim> body_1;
  StandingBody<Dim> body_2;
  double size;  ///< sum of the bounding radii, the unit of every tolerance [m]

  /// The point of C farthest along `direction`.
  [[nodiscard]] Difference<Dim> support(const Vector<Dim>& direction) const {
    Difference<Dim> found;
    found.a_1 = body_1.support(direction);
    found.a_2 = body_2.support(-direction);
    found.w = found.a_1 - found.a_2;
    return found;
  }
  /// s(n) = min n.(a_1 - a_2), n a unit vector: how far apart the planes normal to n hold the bodies. A lower
  /// bound of their signed distance, which is its maximum over n.
  [[nodiscard]] double separation(const Vector<Dim>& n) const { return n.dot(support(-n).w); }
};

}  // namespace touchstone
