#pragma once

#include <Eigen/Dense>
#include <vector>

/// Rotating bodies: torque-free rotation, Euler's disc, the tippe top's constant. SI units.
namespace touchstone::truth {

/// Jacobi's sn, cn, dn of u with parameter m = k^2 in [0, 1), by the arithmetic-geometric mean.
struct JacobiFunctions {
  double sn = 0.0, cn = 1.0, dn = 1.0;
};
JacobiFunctions jacobi(double u, double m);

/// A body that turns about its centre without torque.
struct FreeRotation {
  /// Principal, all different, > 0 [kg m^2]. The default is the box 1 x 4 x 9 of mass 1.
  Eigen::Vector3d inertia{97.0 / 12.0, 82.0 / 12.0, 17.0 / 12.0};
  Eigen::Vector3d omega_body{0.1, 1.0, 0.1};                        ///< at t = 0, body axes [rad/s]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< at t = 0, body to world

  /// Principal moments of a homogeneous box with these edge lengths.
  static Eigen::Vector3d box_inertia(double mass, const Eigen::Vector3d& edges);
};

struct FreeRotationState {
  double t = 0.0;
  Eigen::Vector3d omega_body;  ///< body axes
  Eigen::Vector3d omega;       ///< world axes
  Eigen::Quaterniond orientation;
};

/// Exact rotation at `times` ([s], increasing, >= 0), to about 1e-13 (1 + t).
///
/// omega by Jacobi's functions (Landau & Lifshitz I, 37): with the axis L turns
/// about counted third, omega_1 ~ cn, omega_2 ~ sn, omega_3 ~ dn. Orientation by
/// one quadrature: the line of nodes of L and a body axis f turns about L at
///   L (2 T - L_f omega_f) / (L^2 - L_f^2).
/// @throws std::invalid_argument if moments are equal, omega is zero, or m > 1 - 1e-10 (the separatrix)
std::vector<FreeRotationState> rotate_freely(const FreeRotation& body, const std::vector<double>& times);

/// Euler's disc in steady motion with its centre at rest, rolling on its rim, e_r = 0.
///
/// alpha is the angle of the disc's plane to the ground, Omega the rate at which contact and axis go round
/// the vertical. The material point in contact and the centre are at rest, so omega points from one to the
/// other: with r = -(a u + d e3), u the steepest upward direction in the disc's plane and e3 its axis,
///   omega = Omega sin(alpha) (u + (d/a) e3),  L' = Omega z x L = r x m g z
/// give
///   Omega^2 (I1 sin cos - I3 sin^2 d/a) = m g (a cos - d sin);
/// for a thin uniform disc Omega^2 sin(alpha) = 4 g / a.
struct EulerDisc {
  double mass = 1.0;
  double radius = 1.0;       ///< a > 0 [m]
  double half_height = 0.0;  ///< d >= 0 [m]
  double transverse = 0.25;  ///< I1, about a diameter: m (3 a^2 + (2 d)^2) / 12 if uniform [kg m^2]
  double axial = 0.5;        ///< I3: m a^2 / 2 if uniform
  double gravity = 9.81;

  static EulerDisc uniform(double mass, double radius, double half_height);

  /// Omega > 0 [rad/s] at alpha in (0, pi/2).
  /// @throws std::domain_error if there is no steady motion at this angle
  [[nodiscard]] double precession(double alpha) const;
  /// Angular velocity in (u, e3, e3 x u) at that motion [rad/s].
  [[nodiscard]] Eigen::Vector3d omega(double alpha) const;
  [[nodiscard]] double center_height(double alpha) const;
};

/// Jellett's constant of an axisymmetric top with a spherical foot [kg m^3/s],
///   -L.r = R L_z - l L_3,
/// constant in ANY motion with contact on a horizontal plane and e_r = 0: the
/// contact force has no moment about r, and the body's symmetry makes L.r' vanish.
/// @param inertia_axial, inertia_transverse  about the centre of mass
/// @param foot_radius  R, of the sphere
/// @param offset  l, from the centre of mass to the sphere's centre along +axis [m]; may be negative
/// @param axis  unit vector of the symmetry axis, world
double jellett_constant(double inertia_axial, double inertia_transverse, double foot_radius, double offset,
                        const Eigen::Vector3d& axis, const Eigen::Vector3d& omega);

}  // namespace touchstone::truth
