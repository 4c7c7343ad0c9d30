#include "experiments/harness/ledger.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

/// p . (u + u')/2 of the wrench p on one body.
template <int Dim>
double work(const Twist<Dim>& wrench, const BodyState<Dim>& before, const BodyState<Dim>& after) {
  return wrench.dot(before.velocity + after.velocity) / 2;
}

/// The inequalities of a surface that hold with equality at `x`, body frame, or that are as near to it.
template <int Dim>
std::vector<int> features_at(const ConvexSurface<Dim>& surface, const Vector<Dim>& x) {
  constexpr double kSame = 1e-7;  // of the size: far above rounding, far below a corner of a polygon of 1000
  if (surface.count() == 1) return {0};
  std::vector<double> values;
  for (int i = 0; i < surface.count(); ++i) values.push_back(surface.value(i, x));
  const double largest = *std::max_element(values.begin(), values.end());
  const double tolerance = kSame * surface.bounding_ball().radius;
  std::vector<int> features;
  for (int i = 0; i < surface.count(); ++i) {
    if (values[static_cast<std::size_t>(i)] >= largest - tolerance) features.push_back(i);
  }
  return features;
}

/// max_i f_i(x): about the distance of x from the surface, < 0 inside [m].
template <int Dim>
double height(const ConvexSurface<Dim>& surface, const Vector<Dim>& x) {
  double largest = surface.value(0, x);
  for (int i = 1; i < surface.count(); ++i) largest = std::max(largest, surface.value(i, x));
  return largest;
}

}  // namespace

template <>
FrictionVector<2> RelativeMotion<2>::friction(const TangentBasis<2>& tangents) const {
  return tangents.transpose() * velocity;
}
template <>
FrictionVector<3> RelativeMotion<3>::friction(const TangentBasis<3>& tangents) const {
  const Eigen::Vector2d slip = tangents.transpose() * velocity;
  return {slip[0], slip[1], spin};
}

template <int Dim>
RelativeMotion<Dim> relative_motion(const ContactImpulse<Dim>& contact, std::span<const BodyState<Dim>> at,
                                    std::span<const BodyState<Dim>> velocities) {
  const auto a = static_cast<std::size_t>(contact.body_a);
  const auto b = static_cast<std::size_t>(contact.body_b);
  const Twist<Dim>& nu_a = velocities[a].velocity;
  const Twist<Dim>& nu_b = velocities[b].velocity;
  RelativeMotion<Dim> motion;
  motion.velocity = point_velocity<Dim>(nu_a, contact.point_a - at[a].pose.position) -
                    point_velocity<Dim>(nu_b, contact.point_b - at[b].pose.position);
  motion.normal = contact.normal.dot(motion.velocity);
  if constexpr (Dim == 3) motion.spin = contact.normal.dot((nu_a - nu_b).template tail<3>());
  return motion;
}

template <int Dim>
EnergyLedger<Dim>::EnergyLedger(const Scene<Dim>& scene, const Judge<Dim>& judge,
                                std::span<const BodyState<Dim>> start)
    : scene_(scene), judge_(judge), start_(judge.energy(start)), energy_(start_) {
  for (const auto& body : scene.bodies) surfaces_.push_back(make_surface(body.shape));
}

template <int Dim>
auto EnergyLedger<Dim>::known(const ContactImpulse<Dim>& contact, std::span<const BodyState<Dim>> state) const
    -> Known {
  const auto a = static_cast<std::size_t>(contact.body_a);
  const auto b = static_cast<std::size_t>(contact.body_b);
  const Vector<Dim> on_a = state[a].pose.to_body(contact.point_a);
  const Vector<Dim> on_b = state[b].pose.to_body(contact.point_b);
  // Also right for a method that puts both points in the middle of an overlap.
  const double gap =
      height(*surfaces_[a], on_a) + height(*surfaces_[b], state[b].pose.to_body(contact.point_a));
  return {{contact.body_a, contact.body_b},
          features_at(*surfaces_[a], on_a),
          features_at(*surfaces_[b], on_b),
          on_a,
          gap,
          relative_motion(contact, state, state)};
}

/// The nearest of the last step's contacts on the same features; null if there was none.
template <int Dim>
auto EnergyLedger<Dim>::in_last_step(const Known& contact) const -> const Known* {
  const Known* nearest = nullptr;
  const auto distance = [&](const Known& other) { return (other.point - contact.point).norm(); };
  const auto [first, end] = std::equal_range(last_.begin(), last_.end(), contact, &in_order);
  for (auto other = first; other != end; ++other) {
    const bool same = other->features_a == contact.features_a && other->features_b == contact.features_b;
    if (same && (nearest == nullptr || distance(*other) < distance(*nearest))) nearest = &*other;
  }
  return nearest;
}

template <int Dim>
void EnergyLedger<Dim>::book(double h, std::span<const BodyState<Dim>> before,
                             std::span<const BodyState<Dim>> after,
                             std::span<const ContactImpulse<Dim>> contacts,
                             std::span<const JointImpulse<Dim>> joints) {
  now_.clear();
  for (const auto& contact : contacts) {
    Known now = known(contact, after);
    RelativeMotion<Dim> start = relative_motion(contact, after, before);
    if (const Known* last = in_last_step(now)) {
      start = last->motion;
      now.motion.normal = (now.gap - last->gap) / h;
    }
    const FrictionVector<Dim> slip = start.friction(contact.tangents) + now.motion.friction(contact.tangents);
    account_.friction_loss -= contact.friction_impulse.dot(slip) / 2;
    account_.impact_loss -= contact.normal_impulse * (start.normal + now.motion.normal) / 2;
    now_.push_back(std::move(now));
  }
  std::swap(last_, now_);
  std::stable_sort(last_.begin(), last_.end(), &in_order);
  book_joints(before, after, joints);
  energy_ = judge_.energy(after);
  account_.applied_work = start_.potential - energy_.potential;
  // From the totals and not step by step, so that its rounding does not add up.
  account_.drift = energy_.total() - start_.total() + account_.friction_loss + account_.impact_loss;
}

template <int Dim>
void EnergyLedger<Dim>::book_joints(std::span<const BodyState<Dim>> before,
                                    std::span<const BodyState<Dim>> after,
                                    std::span<const JointImpulse<Dim>> joints) {
  for (const auto& impulse : joints) {
    const Joint<Dim>& joint = scene_.joints[static_cast<std::size_t>(impulse.joint)];
    const auto a = static_cast<std::size_t>(joint.body_a);
    const auto b = static_cast<std::size_t>(joint.body_b);
    account_.joint_work += work(impulse.on_a, before[a], after[a]) + work(impulse.on_b, before[b], after[b]);
  }
}

template RelativeMotion<2> relative_motion(const ContactImpulse<2>&, std::span<const BodyState<2>>,
                                           std::span<const BodyState<2>>);
template RelativeMotion<3> relative_motion(const ContactImpulse<3>&, std::span<const BodyState<3>>,
                                           std::span<const BodyState<3>>);
template class EnergyLedger<2>;
template class EnergyLedger<3>;

}  // namespace touchstone
