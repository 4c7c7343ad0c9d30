#pragma once

#include <array>

#include "core/model/dimension.h"

namespace touchstone {

/// An orthonormal contact frame as a function of the unit normal n.
///
/// In space t is the projection on the contact plane of a reference direction u, normalised, and o = n x t;
/// in the plane t is n turned by -90 degrees (n = y gives t = x), so that (t, n) is right-handed.
template <int Dim>
struct ContactFrame {
  Vector<Dim> normal = Vector<Dim>::Zero();
  TangentBasis<Dim> tangents = TangentBasis<Dim>::Zero();
};

/// Of the tangents of a frame by its normal: entry i maps dn to the change of tangent i.
template <int Dim>
using FrameDerivative = std::array<Matrix<Dim>, Dimension<Dim>::tangent>;

/// @param n          unit normal
/// @param reference  direction whose projection is t; not parallel to n (see usable_reference); not read in
/// the plane
inline ContactFrame<2> contact_frame(const Vector<2>& n, const Vector<2>& /*reference*/) {
  return {n, {n.y(), -n.x()}};
}

inline ContactFrame<3> contact_frame(const Vector<3>& n, const Vector<3>& reference) {
  ContactFrame<3> frame;
  frame.normal = n;
  frame.tangents.col(0) = (reference - reference.dot(n) * n).normalized();
  frame.tangents.col(1) = n.cross(Vector<3>(frame.tangents.col(0)));
  return frame;
}

/// @param frame      contact_frame(n, reference)
inline FrameDerivative<2> frame_derivative(const ContactFrame<2>& /*frame*/, const Vector<2>& /*reference*/) {
  return {(Matrix<2>() << 0, 1, -1, 0).finished()};
}

inline FrameDerivative<3> frame_derivative(const ContactFrame<3>& frame, const Vector<3>& reference) {
  const Vector<3>& n = frame.normal;
  const Vector<3> t = frame.tangents.col(0);
  const double along = reference.dot(n);
  const double length = (reference - along * n).norm();
  // dt = (I - t t^T) d(projected) / |projected|,  d(projected) = -(u.dn) n - (u.n) dn;  (I - t t^T) n = n.
  const Matrix<3> first =
      -(n * reference.transpose() + along * (Matrix<3>::Identity() - t * t.transpose())) / length;
  // do = dn x t + n x dt; lever(t) dn = dn x t, and n x dt = -lever(n)... written through the same map.
  return {first, lever(t) - lever(n) * first};
}

/// `reference`, or the coordinate axis least aligned with n where the reference is too close to n to define a
/// direction.
inline Vector<2> usable_reference(const Vector<2>&, const Vector<2>& reference) { return reference; }
inline Vector<3> usable_reference(const Vector<3>& n, const Vector<3>& reference) {
  constexpr double kLeastSine = 0.1;
  const Vector<3> u = reference.normalized();
  if (u.cross(n).norm() > kLeastSine) return u;
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  return Vector<3>::Unit(axis);
}

}  // namespace touchstone
