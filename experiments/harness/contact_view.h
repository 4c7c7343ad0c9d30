#pragma once

#include <optional>
#include <span>

#include "core/method.h"

/// A contact's load and motion as one of its bodies sees them, from read-back states and impulses.
namespace touchstone::harness {

/// World frame, end of the step. Friction in the scale of its ellipsoid: y = E^-1 p_f, w = E v_f (Eq. 5);
/// components with a semi-axis of 0 are left out of both.
struct ContactView {
  Vector<3> point = Vector<3>::Zero();               ///< on the body [m]
  Vector<3> normal = Vector<3>::Zero();              ///< unit, from the other body into this one
  double normal_impulse = 0.0;                       ///< p_n [N s]
  Vector<3> tangential_impulse = Vector<3>::Zero();  ///< on this body [N s]
  double torsional_impulse = 0.0;                    ///< on this body, about `normal` [N m s]
  double friction_norm = 0.0;                        ///< |y|, at most `friction_limit` [N s]
  double friction_limit = 0.0;                       ///< mu p_n [N s]
  double slip = 0.0;   ///< speed of this body's material point against the other's, across the normal [m/s]
  double spin = 0.0;   ///< of this body against the other, about `normal` [rad/s]
  double sigma = 0.0;  ///< |w| [m/s]
};

/// The contact of `body` with `other` that carries the largest normal impulse.
/// @param state  of all bodies at the end of the step
/// @returns none if no contact of the two carries one
std::optional<ContactView> strongest_contact(const Scene<3>& scene, std::span<const BodyState<3>> state,
                                             std::span<const ContactImpulse<3>> contacts, int body,
                                             int other);

}  // namespace touchstone::harness
