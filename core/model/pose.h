#pragma once

#include <cmath>

#include "core/model/dimension.h"

namespace touchstone {

/// Orientation of a body. In the plane an angle [rad], not wrapped, so that revolutions are counted.
class PlanarRotation {
 public:
  PlanarRotation() = default;
  explicit PlanarRotation(double angle) : angle_(angle), cos_(std::cos(angle)), sin_(std::sin(angle)) {}

  [[nodiscard]] double angle() const { return angle_; }
  [[nodiscard]] Matrix<2> matrix() const { return (Matrix<2>() << cos_, -sin_, sin_, cos_).finished(); }
  /// Turned further by `turn` [rad].
  [[nodiscard]] PlanarRotation turned(const Angular<2>& turn) const {
    return PlanarRotation(angle_ + turn[0]);
  }
  [[nodiscard]] PlanarRotation operator*(const PlanarRotation& inner) const {
    return PlanarRotation(angle_ + inner.angle_);
  }
  [[nodiscard]] bool is_finite() const { return std::isfinite(angle_); }

 private:
  double angle_ = 0.0;
  double cos_ = 1.0;
  double sin_ = 0.0;
};

/// exp of a rotation vector [rad] as a unit quaternion, exact to rounding for any length.
Eigen::Quaterniond exp_rotation(const Vector<3>& turn);

/// J with  d exp(theta) = [J d theta]_x exp(theta): maps a change of a rotation vector to a small turn about
/// world axes.
Matrix<3> left_jacobian(const Vector<3>& theta);

/// Orientation of a body in space: a unit quaternion, body frame to world frame.
class SpatialRotation {
 public:
  SpatialRotation() = default;
  /// Normalises `q`, which must not be zero.
  explicit SpatialRotation(const Eigen::Quaterniond& q)
      : q_(q.normalized()), matrix_(q_.toRotationMatrix()) {}

  [[nodiscard]] const Eigen::Quaterniond& quaternion() const { return q_; }
  [[nodiscard]] const Matrix<3>& matrix() const { return matrix_; }
  /// Turned further by the rotation vector `turn` [rad], world axes (Eq. 2 integrated on the group: the norm
  /// stays 1).
  [[nodiscard]] SpatialRotation turned(const Vector<3>& turn) const {
    return SpatialRotation(exp_rotation(turn) * q_);
  }
  [[nodiscard]] SpatialRotation operator*(const SpatialRotation& inner) const {
    return SpatialRotation(q_ * inner.q_);
  }
  [[nodiscard]] bool is_finite() const { return q_.coeffs().allFinite(); }

 private:
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
  Matrix<3> matrix_ = Matrix<3>::Identity();
};

template <int Dim>
using Rotation = std::conditional_t<Dim == 2, PlanarRotation, SpatialRotation>;

/// Where a body frame stands in the world: origin at the centre of mass [m], axes turned by `rotation`.
template <int Dim>
struct Pose {
  Vector<Dim> position = Vector<Dim>::Zero();
  Rotation<Dim> rotation{};

  [[nodiscard]] Vector<Dim> to_world(const Vector<Dim>& x_body) const {
    return position + rotation.matrix() * x_body;
  }
  [[nodiscard]] Vector<Dim> to_body(const Vector<Dim>& x_world) const {
    return rotation.matrix().transpose() * (x_world - position);
  }
  [[nodiscard]] bool is_finite() const { return position.allFinite() && rotation.is_finite(); }
};

/// q' = q (+) h nu, the kinematic map of Eqs. 2 and 4 with the rotation's exponential.
template <int Dim>
Pose<Dim> advanced(const Pose<Dim>& q, const Twist<Dim>& nu, double h) {
  return {q.position + h * nu.template head<Dim>(),
          q.rotation.turned(h * nu.template tail<Dimension<Dim>::angular>())};
}

/// d(small turn of q' about world axes) / d omega at q' = q (+) h nu; 1x1 [h] in the plane.
inline Inertia<2> turn_jacobian(const Angular<2>&, double h) { return Inertia<2>(h); }
inline Inertia<3> turn_jacobian(const Angular<3>& omega, double h) { return h * left_jacobian(h * omega); }

}  // namespace touchstone
