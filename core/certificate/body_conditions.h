#pragma once

#include <cmath>
#include <numbers>

#include "core/method.h"

/// Momentum and motion of one body, for the checker: cross products and rotations written out anew.
namespace touchstone::certificate {

inline double cross(const Vector<2>& r, const Vector<2>& f) { return r.x() * f.y() - r.y() * f.x(); }
inline Vector<3> cross(const Vector<3>& r, const Vector<3>& f) { return r.cross(f); }

/// w x r.
inline Vector<2> turning(const Angular<2>& w, const Vector<2>& r) { return {-w[0] * r.y(), w[0] * r.x()}; }
inline Vector<3> turning(const Angular<3>& w, const Vector<3>& r) { return w.cross(r); }

template <int Dim>
Angular<Dim> omega(const BodyState<Dim>& state) {
  return state.velocity.template tail<Dimension<Dim>::angular>();
}

/// [kg m/s] and, about the centre of mass, [kg m^2/s].
template <int Dim>
struct Momentum {
  Vector<Dim> linear = Vector<Dim>::Zero();
  Angular<Dim> angular = Angular<Dim>::Zero();

  Momentum& operator+=(const Momentum& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
  Momentum& operator-=(const Momentum& other) {
    linear -= other.linear;
    angular -= other.angular;
    return *this;
  }
};

/// I at an orientation, world frame.
inline Inertia<2> turned_inertia(const Body<2>& body, const BodyState<2>&) { return body.inertia; }
inline Inertia<3> turned_inertia(const Body<3>& body, const BodyState<3>& state) {
  const Matrix<3> r = state.pose.rotation.quaternion().toRotationMatrix();
  return r * body.inertia * r.transpose();
}

template <int Dim>
Momentum<Dim> change_of_momentum(const Body<Dim>& body, const BodyState<Dim>& before,
                                 const BodyState<Dim>& after) {
  return {body.mass * (after.velocity - before.velocity).template head<Dim>(),
          turned_inertia(body, before) * (omega(after) - omega(before))};
}

/// -w x I w, at the start of the step.
inline Angular<2> gyroscopic_moment(const Body<2>&, const BodyState<2>&) { return Angular<2>::Zero(); }
inline Angular<3> gyroscopic_moment(const Body<3>& body, const BodyState<3>& state) {
  const Vector<3> w = omega(state);
  return Vector<3>(turned_inertia(body, state) * w).cross(w);
}

/// What a contact gives to body a at `arm` from its centre of mass; body b gets the opposite at its own arm.
inline Momentum<2> contact_impulse(const ContactImpulse<2>& c, const Vector<2>& arm) {
  const Vector<2> p = c.normal_impulse * c.normal + c.friction_impulse[0] * c.tangents.col(0);
  return {p, Angular<2>(cross(arm, p))};
}
inline Momentum<3> contact_impulse(const ContactImpulse<3>& c, const Vector<3>& arm) {
  const Vector<3> p = c.normal_impulse * c.normal + c.friction_impulse[0] * c.tangents.col(0) +
                      c.friction_impulse[1] * c.tangents.col(1);
  return {p, Angular<3>(cross(arm, p) + c.friction_impulse[2] * c.normal)};
}

template <int Dim>
Momentum<Dim> joint_impulse(const Twist<Dim>& on_body) {
  return {on_body.template head<Dim>(), on_body.template tail<Dimension<Dim>::angular>()};
}

/// Angle between `after` and `before` turned by h w' [rad].
inline double turn_error(const BodyState<2>& before, const BodyState<2>& after, double h) {
  return std::abs(after.pose.rotation.angle() - before.pose.rotation.angle() - h * omega(after)[0]);
}
inline double turn_error(const BodyState<3>& before, const BodyState<3>& after, double h) {
  const Vector<3> turn = h * omega(after);
  const double angle = turn.norm();
  Eigen::Quaterniond step = Eigen::Quaterniond::Identity();
  if (angle > 0) step = Eigen::AngleAxisd(angle, turn / angle);
  const Eigen::Quaterniond difference =
      (step * before.pose.rotation.quaternion()) * after.pose.rotation.quaternion().conjugate();
  return 2 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

/// ||q| - 1|; an angle has none.
inline double norm_error(const PlanarRotation&) { return 0.0; }
inline double norm_error(const SpatialRotation& r) { return std::abs(r.quaternion().norm() - 1); }

}  // namespace touchstone::certificate
