#include "experiments/harness/contact_view.h"

#include "experiments/harness/ledger.h"

namespace touchstone::harness {

namespace {

ContactView view(const ContactLaw<3>& law, std::span<const BodyState<3>> state,
                 const ContactImpulse<3>& contact, int body) {
  const bool is_a = contact.body_a == body;
  const double sign = is_a ? 1.0 : -1.0;
  const RelativeMotion<3> motion = relative_motion(contact, state, state);
  const FrictionVector<3> velocity = motion.friction(contact.tangents);
  const FrictionVector<3> e = law.semi_axes();
  FrictionVector<3> y = FrictionVector<3>::Zero();
  for (int i = 0; i < y.size(); ++i) y[i] = e[i] > 0 ? contact.friction_impulse[i] / e[i] : 0.0;

  ContactView seen;
  seen.point = is_a ? contact.point_a : contact.point_b;
  seen.normal = sign * contact.normal;
  seen.normal_impulse = contact.normal_impulse;
  seen.tangential_impulse = sign * (contact.tangents * contact.friction_impulse.head<2>());
  seen.torsional_impulse = contact.friction_impulse[2];  // both it and the normal change sign with the body
  seen.friction_norm = y.norm();
  seen.friction_limit = law.mu * contact.normal_impulse;
  seen.slip = velocity.head<2>().norm();
  seen.spin = motion.spin;
  seen.sigma = e.cwiseProduct(velocity).norm();
  return seen;
}

}  // namespace

std::optional<ContactView> strongest_contact(const Scene<3>& scene, std::span<const BodyState<3>> state,
                                             std::span<const ContactImpulse<3>> contacts, int body,
                                             int other) {
  const ContactImpulse<3>* strongest = nullptr;
  for (const ContactImpulse<3>& contact : contacts) {
    const bool meant = (contact.body_a == body && contact.body_b == other) ||
                       (contact.body_a == other && contact.body_b == body);
    if (!meant || !(contact.normal_impulse > 0.0)) continue;
    if (strongest == nullptr || contact.normal_impulse > strongest->normal_impulse) strongest = &contact;
  }
  if (strongest == nullptr) return std::nullopt;
  return view(scene.law(body, other), state, *strongest, body);
}

}  // namespace touchstone::harness
