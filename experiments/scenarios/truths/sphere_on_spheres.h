#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

/// A ball that rolls, slides and spins on two fixed balls:
/// the smooth motion between its changes of contact mode.
namespace touchstone::truth {

struct FixedBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 1.0;                               ///< > 0 [m]
};

/// SI units, world frame. The defaults are the paper's third example; its mass and
/// inertia, not printed, are a solid unit ball's. Friction is the ellipsoid
/// (p_t/e_t)^2 + (p_o/e_o)^2 + (p_r/e_r)^2 <= (mu p_n)^2 with e_t = e_o.
struct SphereOnSpheres {
  double mass = 1.0;                       ///< > 0 [kg]
  double inertia = 0.4;                    ///< > 0, about every axis [kg m^2]
  double radius = 1.0;                     ///< > 0 [m]
  double mu = 0.2;                         ///< > 0
  double e_slip = 1.0;                     ///< e_t = e_o > 0
  double e_r = 0.3;                        ///< > 0 [m]
  Eigen::Vector3d force{1.0, 2.6, -9.81};  ///< constant, at the centre, weight included [N]
  Eigen::Vector3d position{0.0, 6.62105263157895, 8.78417110772903};  ///< at rest; touches both balls to 1e-9
  std::array<FixedBall, 2> supports{FixedBall{{0.0, 0.0, 0.0}, 10.0}, FixedBall{{0.0, 11.4, 0.0}, 9.0}};
};

enum class BallContactMode {
  sticking,  ///< no slip and no spin: w = (e_t v_t, e_o v_o, e_r w_r) is zero, which is rolling without spin
  sliding,   ///< w is not zero, or is about to grow from zero; friction lies ON the ellipsoid
  apart
};

/// Everything about one contact at one time. While it is apart the forces are
/// zero, and slip and spin are those of the ball's point nearest to the support.
struct BallContactSample {
  BallContactMode mode = BallContactMode::apart;
  double gap = 0.0;                                    ///< [m]
  double normal = 0.0;                                 ///< lambda_n [N]
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< tangential force on the ball [N]
  double torsion = 0.0;                                ///< moment on the ball about the normal [N m]
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();  ///< velocity of the ball's material point in contact [m/s]
  double spin = 0.0;                               ///< angular velocity about the normal [rad/s]
  double friction_norm = 0.0;                      ///< |E^-1 p_f|, at most mu lambda_n [N]
  double sigma = 0.0;                              ///< |w|
};

struct SphereOnSpheresSample {
  double t = 0.0;
  Eigen::Vector3d position, velocity, omega;
  Eigen::Quaterniond orientation;
  std::array<BallContactSample, 2> contacts;
};

enum class BallEventKind { slip_begins, separates };

struct BallEvent {
  double t = 0.0;
  int contact = 0;  ///< 0 or 1: index of the supporting ball
  BallEventKind kind = BallEventKind::slip_begins;
};

enum class SphereOnSpheresStatus {
  completed,
  slip_ends,      ///< a sliding contact came to rest: what follows is not modelled
  touches_again,  ///< a separated contact closed: an impact, not modelled
  no_start,  ///< both contacts stick at the start, so that their forces are undetermined; or no modes were
             ///< found
  integration_failed
};

struct SphereOnSpheresResult {
  SphereOnSpheresStatus status = SphereOnSpheresStatus::completed;
  double end = 0.0;  ///< how far the truth reaches [s]
  std::array<BallContactMode, 2> start_modes{};
  std::vector<BallEvent> events;
  std::vector<SphereOnSpheresSample> samples;
};

/// Integrates from rest to the last of `times` ([s],
/// increasing, >= 0). Event times and states are good to about 1e-11.
///
/// Sticking contacts are constraints on accelerations (v_c' = 0 and
/// (omega.n)' = 0, v_c the velocity of the material point in contact), sliding
/// ones on the normal acceleration alone, with friction by maximum dissipation
///   p_f = -mu p_n E w / |w|,  w = E v_f.
/// At the start nothing slips yet. There the accelerations take the place of the
/// velocities in that law: the modes, and the direction in which slip begins,
/// come from the nonlinear complementarity problem in accelerations.
/// @param tolerance  of each integration step, relative
/// @throws std::invalid_argument on parameters out of range or a start that does not touch both balls
SphereOnSpheresResult roll_on_spheres(const SphereOnSpheres& scene, const std::vector<double>& times,
                                      double tolerance = 1e-14);

}  // namespace touchstone::truth
