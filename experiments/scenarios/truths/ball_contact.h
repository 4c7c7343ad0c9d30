#pragma once

#include <Eigen/Dense>
#include <array>

#include "experiments/scenarios/truths/sphere_on_spheres.h"

/// Accelerations and contact forces of a ball on fixed balls at one instant.
namespace touchstone::truth::ball {

using Twist = Eigen::Matrix<double, 6, 1>;  ///< (v, omega) or its rate, world frame
using Surface = Eigen::Vector4d;  ///< a vector in the world and a component about the contact normal:
                                  ///< velocity (v_c, omega.n), force (F, moment about n)

struct Motion {
  Eigen::Vector3d x, v, omega;
};

/// The geometry and kinematics of one contact.
class Contact {
 public:
  Contact(const SphereOnSpheres& scene, const FixedBall& support, const Motion& motion);

  Eigen::Vector3d normal;  ///< from the support to the ball
  double gap = 0.0;        ///< [m]
  /// J with (v_c, omega.n) = J (v, omega), v_c the velocity of the ball's material point in contact. Its
  /// transpose maps a force at that point and a moment about the normal to the wrench at the centre.
  Eigen::Matrix<double, 4, 6> jacobian;
  Surface drift;              ///< (v_c, omega.n)' = J (v, omega)' + drift
  double normal_drift = 0.0;  ///< (n.v)' = n.v' + normal_drift
  Surface slip;               ///< (v_c, omega.n) without the part of v_c along n

  /// Without the part along n.
  [[nodiscard]] Surface tangential(const Surface& s) const;
  /// Replaces the slip by a more accurate value.
  void set_slip(const Surface& value) { slip = tangential(value); }
  /// w = E v_f of a relative velocity, or of an acceleration that takes its place.
  [[nodiscard]] Surface scaled_velocity(const Surface& velocity) const;
  /// y = E^-1 p_f of a contact force; its part along n is left out.
  [[nodiscard]] Surface scaled_force(const Surface& force) const;
  /// The inverse: p_f = E y.
  [[nodiscard]] Surface friction(const Surface& y) const;

 private:
  double e_slip_, e_r_;
};

std::array<Contact, 2> contacts_of(const SphereOnSpheres& scene, const Motion& motion);

/// How a contact moves. The direction w / |w| of slip follows from the velocities,
/// except while w is still zero, or while the direction is prescribed.
struct ContactState {
  BallContactMode mode = BallContactMode::apart;
  Surface direction = Surface::Zero();
  bool prescribed = false;
};
using ContactStates = std::array<ContactState, 2>;

struct Dynamics {
  Twist rate;                    ///< (v', omega')
  std::array<Surface, 2> force;  ///< on the ball; the part along n is the normal force
};

/// Newton and Euler with the constraints of each contact's mode: sticking (v_c,
/// omega.n)' = 0; sliding (n.v)' = 0 with friction -mu lambda_n E w / |w|. At most one
/// contact may stick: two sticking contacts leave the forces undetermined.
Dynamics dynamics(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts,
                  const ContactStates& states);

/// The direction d in which slip of the sliding contact `index` grows from zero: E v_f' = s d with
/// s > 0 while friction is -mu lambda_n E d. By projected iteration from states[index].direction.
Surface growing_slip_direction(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts,
                               ContactStates states, std::size_t index);

/// The modes in which a ball at rest, touching both supports, begins to move: the solution of
///   0 <= lambda_n _|_ (n.v)' >= 0,  y = proj_{|y| <= mu lambda_n}(y - rho E v_f'),
/// found by projected Gauss-Seidel sweeps to rounding. `start`
/// (y of both contacts) allows to look for other solutions.
/// @return false if the sweeps did not converge
bool start_states(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts, ContactStates& states,
                  const std::array<Surface, 2>& start = {Surface::Zero(), Surface::Zero()});

}  // namespace touchstone::truth::ball
