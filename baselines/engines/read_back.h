#pragma once

#include "core/contact/frame.h"
#include "core/method.h"

/// Pieces of reading back that adapters share.
namespace touchstone::engines {

/// t (and o) of the project's contact frame at `normal`, for a pair with `law`.
template <int Dim>
TangentBasis<Dim> contact_tangents(const Vector<Dim>& normal, const ContactLaw<Dim>& law) {
  return contact_frame(normal, usable_reference(normal, law.tangent)).tangents;
}

/// Where and between whom a contact acts. `normal` is a unit vector, world frame, from body_b into body_a.
template <int Dim>
struct ContactPlace {
  int body_a = 0;
  int body_b = 0;
  Vector<Dim> point_a = Vector<Dim>::Zero();  ///< world frame [m]
  Vector<Dim> point_b = Vector<Dim>::Zero();
  Vector<Dim> normal = Vector<Dim>::Zero();
};

/// The contact at `place` with the impulse that body_a got.
/// @param impulse  world frame [N s]
/// @param torsion  impulsive moment on body_a about the normal [N m s]; not read in the plane
template <int Dim>
ContactImpulse<Dim> contact_impulse(const Scene<Dim>& scene, const ContactPlace<Dim>& place,
                                    const Vector<Dim>& impulse, double torsion = 0.0);

/// The angle equal to `wrapped` up to whole turns that is nearest to `expected` [rad].
double unwrapped(double wrapped, double expected);

}  // namespace touchstone::engines
