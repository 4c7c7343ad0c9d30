#pragma once

#include <Eigen/Dense>
#include <optional>
#include <vector>

/// An ellipsoid that rolls without slip on a plane or on a fixed ellipsoid: the nonholonomic motion.
namespace touchstone::truth {

/// The fixed body. SI units, world frame.
struct FixedEllipsoid {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Ones();  ///< > 0 [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct RollingEllipsoid {
  double mass = 1.0;                                    ///< > 0 [kg]
  Eigen::Vector3d semi_axes = Eigen::Vector3d::Ones();  ///< > 0, along the body's axes [m]
  /// Of the ellipsoid, from the centre of mass, body axes [m].
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// About the centre of mass, body axes; positive definite [kg m^2]. Need not be diagonal: then it is a
  /// rattleback.
  Eigen::Matrix3d inertia = 0.4 * Eigen::Matrix3d::Identity();
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< acceleration [m/s^2]; tilted for an incline
  std::optional<FixedEllipsoid> support;     ///< none: the plane z = 0, solid below
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< at t = 0, body to world
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();                  ///< at t = 0, world [rad/s]
  /// Contact normal at t = 0, from the support to the ellipsoid, and where the contact is in the plane
  /// z = 0. On a support the normal says where the contact is; on the plane it must be (0, 0, 1).
  Eigen::Vector3d normal{0.0, 0.0, 1.0};
  Eigen::Vector2d contact = Eigen::Vector2d::Zero();  ///< x, y [m]; not used with a support

  /// Inertia of a homogeneous ellipsoid: m (b^2 + c^2) / 5 and so on.
  static Eigen::Matrix3d solid_inertia(double mass, const Eigen::Vector3d& semi_axes);
  /// @throws std::invalid_argument naming the field and the bound
  void validate() const;
};

struct EllipsoidSample {
  double t = 0.0;
  Eigen::Vector3d position, velocity, omega;  ///< of the centre of mass; world
  Eigen::Quaterniond orientation;
  Eigen::Vector3d normal;         ///< from the support to the ellipsoid
  Eigen::Vector3d contact_point;  ///< on the ellipsoid, world [m]
  Eigen::Vector3d force;          ///< on the ellipsoid at the contact [N]
  double energy = 0.0;            ///< kinetic - m g.x [J]: constant

  [[nodiscard]] double normal_force() const { return force.dot(normal); }
  /// The least mu for which the contact does not slip here.
  [[nodiscard]] double needed_friction() const {
    return (force - normal_force() * normal).norm() / normal_force();
  }
};

enum class EllipsoidStatus { completed, lifts_off, integration_failed };

struct EllipsoidResult {
  EllipsoidStatus status = EllipsoidStatus::completed;
  double end = 0.0;  ///< how far the truth reaches: the last time asked for, or the lift-off [s]
  std::vector<EllipsoidSample> samples;
};

/// Integrates the rolling to the last of `times` ([s], increasing, >= 0), or until
/// the normal force vanishes. No torsional friction (e_r = 0): spin about the normal
/// is free. Enough Coulomb friction is assumed; see needed_friction().
///
/// With s = sqrt(n.D n), D = R diag(a^2, b^2, c^2) R^T the support function of each body, the ellipsoid's
/// contact point is at r = R c - D n / s from its centre of mass, R c leading to its middle. Rolling:
/// v = -omega x r. The normal turns by
///   (K_A + K_B) n' = K_A (omega x n),  K = D/s - D n (D n)^T / s^3,
/// from equality of the velocities of the contact point along both surfaces (K is the derivative of D
/// n / s; on the plane n' = 0). Newton and Euler, with the contact force F = m (v' - g) eliminated:
///   [I + m (|r|^2 1 - r r^T)] omega' = -omega x I omega - m r x (omega x r' + g).
EllipsoidResult roll_ellipsoid(const RollingEllipsoid& scene, const std::vector<double>& times,
                               double tolerance = 1e-14);

}  // namespace touchstone::truth
