#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <concepts>

/// The differences between the plane and space, in one place. Everything else is written once over `Dim`.
namespace touchstone {

template <int Dim>
struct Dimension;

template <>
struct Dimension<2> {
  static constexpr int angular = 1;   ///< components of an angular velocity
  static constexpr int velocity = 3;  ///< components of a generalised velocity, [v_x, v_y, omega]
  static constexpr int tangent = 1;   ///< directions of the contact plane: t
  static constexpr int friction = 1;  ///< components of the friction impulse: p_t
};

template <>
struct Dimension<3> {
  static constexpr int angular = 3;
  static constexpr int velocity = 6;  ///< [v; omega], both in the world frame
  static constexpr int tangent = 2;   ///< t, o
  static constexpr int friction = 3;  ///< p_t, p_o, p_r
};

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim>;
template <int Dim>
using Angular = Eigen::Matrix<double, Dimension<Dim>::angular, 1>;
/// Inertia about the centre of mass: 1x1 in the plane, 3x3 in space, [kg m^2].
template <int Dim>
using Inertia = Eigen::Matrix<double, Dimension<Dim>::angular, Dimension<Dim>::angular>;
/// nu = [v; omega] of one body, world frame, v at the centre of mass, [m/s] and [rad/s]; also [force; moment]
/// pairs.
template <int Dim>
using Twist = Eigen::Matrix<double, Dimension<Dim>::velocity, 1>;
/// Friction components in the order t, o, r (only t in the plane).
template <int Dim>
using FrictionVector = Eigen::Matrix<double, Dimension<Dim>::friction, 1>;
/// Columns t (and o): an orthonormal basis of the contact plane.
template <int Dim>
using TangentBasis = Eigen::Matrix<double, Dim, Dimension<Dim>::tangent>;
/// The matrix C with  C w = w x r.
template <int Dim>
using LeverMatrix = Eigen::Matrix<double, Dim, Dimension<Dim>::angular>;

/// C(r) with C(r) w = w x r: velocity of a point at r from the centre of mass under angular velocity w.
/// Its transpose maps a force at r to its moment: C(r)^T f = r x f.
inline LeverMatrix<2> lever(const Vector<2>& r) { return {-r.y(), r.x()}; }
inline LeverMatrix<3> lever(const Vector<3>& r) {
  LeverMatrix<3> c;
  c << 0, r.z(), -r.y(), -r.z(), 0, r.x(), r.y(), -r.x(), 0;
  return c;
}

/// omega x r without the matrix of lever(): what an angular velocity [rad/s] adds to the velocity [m/s] of a
/// point at `r` [m] from the centre of mass, world axes.
inline Vector<2> turning(const Angular<2>& omega, const Vector<2>& r) {
  return {-omega[0] * r.y(), omega[0] * r.x()};
}
inline Vector<3> turning(const Angular<3>& omega, const Vector<3>& r) { return omega.cross(r); }

/// r x f without the matrix of lever(): moment [N m] about the centre of mass of a force [N] at `r` [m] from
/// it, world axes; of an impulse [N s], its angular momentum [N m s]. One number in the plane, about z.
inline Angular<2> moment(const Vector<2>& r, const Vector<2>& f) {
  return Angular<2>(r.x() * f.y() - r.y() * f.x());
}
inline Angular<3> moment(const Vector<3>& r, const Vector<3>& f) { return r.cross(f); }

/// Velocity [m/s] of the material point at `r` (world axes, from the centre of mass) of a body moving with
/// `nu`.
template <int Dim>
Vector<Dim> point_velocity(const Twist<Dim>& nu, const Vector<Dim>& r) {
  const Angular<Dim> omega = nu.template tail<Dimension<Dim>::angular>();
  return nu.template head<Dim>() + turning(omega, r);
}

/// The wrench [f; r x f] about the centre of mass of a force `f` at `r`.
template <int Dim>
Twist<Dim> wrench(const Vector<Dim>& f, const Vector<Dim>& r) {
  Twist<Dim> w;
  w.template head<Dim>() = f;
  w.template tail<Dimension<Dim>::angular>() = moment(r, f);
  return w;
}

}  // namespace touchstone
