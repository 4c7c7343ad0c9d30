#pragma once

#include <array>

#include "core/model/dimension.h"

namespace touchstone {

/// An orthonormal contact frame as a function of the unit normal n, with its derivative.
///
/// In space t is the projection on the contact plane of a reference direction u, normalised, and o = n x t;
/// in the plane t is n turned by -90 degrees (n = y gives t = x), so that (t, n) is right-handed.
template <int Dim>
struct ContactFrame {
  Vector<Dim> normal = Vector<Dim>::Zero();
  TangentBasis<Dim> tangents = TangentBasis<Dim>::Zero();
  /// derivative[i] maps dn to the change of tangent i.
  std::array<Matrix<Dim>, Dimension<Dim>::tangent> derivative{};
};

/// @param n          unit normal
/// @param reference  direction whose projection is t; not parallel to n (see usable_reference); not read in
/// the plane
inline ContactFrame<2> contact_frame(const Vector<2>& n, const Vector<2>& /*reference*/) {
  const Matrix<2> turn = (Matrix<2>() << 0, 1, -1, 0).finished();
  return {n, turn * n, {turn}};
}

inline ContactFrame<3> contact_frame(const Vector<3>& n, const Vector<3>& reference) {
  const double along = reference.dot(n);
  const Vector<3> projected = reference - along * n;
  const double length = projected.norm();
  const Vector<3> t = projected / length;
  ContactFrame<3> frame;
  frame.normal = n;
  frame.tangents.col(0) = t;
  frame.tangents.col(1) = n.cross(t);
  // dt = (I - t t^T) d(projected) / |projected|,  d(projected) = -(u.dn) n - (u.n) dn;  (I - t t^T) n = n.
  frame.derivative[0] =
      -(n * reference.transpose() + along * (Matrix<3>::Identity() - t * t.transpose())) / length;
  // do = dn x t + n x dt; lever(t) dn = dn x t, and n x dt = -lever(n)... written through the same map.
  frame.derivative[1] = lever(t) - lever(n) * frame.derivative[0];
  return frame;
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
