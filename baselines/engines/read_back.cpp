#include "baselines/engines/read_back.h"

#include <cmath>
#include <numbers>

namespace touchstone::engines {

template <int Dim>
ContactImpulse<Dim> contact_impulse(const Scene<Dim>& scene, const ContactPlace<Dim>& place,
                                    const Vector<Dim>& impulse, double torsion) {
  ContactImpulse<Dim> contact;
  contact.body_a = place.body_a;
  contact.body_b = place.body_b;
  contact.point_a = place.point_a;
  contact.point_b = place.point_b;
  contact.normal = place.normal;
  contact.tangents = contact_tangents(place.normal, scene.law(place.body_a, place.body_b));
  contact.normal_impulse = impulse.dot(place.normal);
  contact.friction_impulse.template head<Dim - 1>() = contact.tangents.transpose() * impulse;
  if constexpr (Dim == 3) contact.friction_impulse[2] = torsion;
  return contact;
}

template ContactImpulse<2> contact_impulse(const Scene<2>&, const ContactPlace<2>&, const Vector<2>&, double);
template ContactImpulse<3> contact_impulse(const Scene<3>&, const ContactPlace<3>&, const Vector<3>&, double);

double unwrapped(double wrapped, double expected) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return wrapped + kTurn * std::round((expected - wrapped) / kTurn);
}

}  // namespace touchstone::engines
