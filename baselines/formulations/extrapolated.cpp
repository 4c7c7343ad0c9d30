#include "baselines/formulations/extrapolated.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// The turn about world axes that takes `from` to `to` [rad]; in space the shortest one.
Angular<2> turn_between(const PlanarRotation& from, const PlanarRotation& to) {
  return Angular<2>(to.angle() - from.angle());
}
Angular<3> turn_between(const SpatialRotation& from, const SpatialRotation& to) {
  Eigen::Quaterniond q = to.quaternion() * from.quaternion().conjugate();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();  // of half the angle
  const double scale = sine > 0 ? 2 * std::atan2(sine, q.w()) / sine : 2.0;
  return scale * q.vec();
}

template <int Dim>
bool same_pair(const ContactImpulse<Dim>& x, const ContactImpulse<Dim>& y) {
  return x.body_a == y.body_a && x.body_b == y.body_b;
}

/// The only contact of its pair in `contacts`; null if there is none or more than one.
template <int Dim>
const ContactImpulse<Dim>* only_one(std::span<const ContactImpulse<Dim>> contacts,
                                    const ContactImpulse<Dim>& of_pair) {
  const auto is_of_pair = [&](const auto& c) { return same_pair(c, of_pair); };
  const auto found = std::find_if(contacts.begin(), contacts.end(), is_of_pair);
  if (found == contacts.end() || std::any_of(found + 1, contacts.end(), is_of_pair)) return nullptr;
  return &*found;
}

/// Adds the impulse of `c`, in its own frame, to that of `sum`. The frames differ by what the normal turns in
/// half a step.
template <int Dim>
void add_impulse(const ContactImpulse<Dim>& c, ContactImpulse<Dim>& sum) {
  sum.normal_impulse += c.normal_impulse;
  const Vector<Dim> along = c.tangents * c.friction_impulse.template head<Dim - 1>();
  sum.friction_impulse.template head<Dim - 1>() += sum.tangents.transpose() * along;
  if constexpr (Dim == 3) sum.friction_impulse[2] += c.friction_impulse[2];
}

}  // namespace

template <int Dim>
Extrapolated<Dim>::Extrapolated(MakeMethod<Dim> make, const Scene<Dim>& scene, const Options& options)
    : coarse_(make(scene, options)),
      fine_(make(scene, options)),
      state_(coarse_->state().begin(), coarse_->state().end()),
      error_(state_.size()) {}

template <int Dim>
Capabilities Extrapolated<Dim>::capabilities() const {
  Capabilities capabilities = coarse_->capabilities();
  capabilities.contact_impulses = false;
  capabilities.one_run = false;
  return capabilities;
}

template <int Dim>
StepReport Extrapolated<Dim>::step(double h) {
  if (parted_) return {StepStatus::not_converged, 0, 0.0, "a step failed before in one of the two runs"};
  StepReport all;
  const auto run = [&](Method<Dim>& method, double size) {
    const StepReport report = method.step(size);
    all.iterations += report.iterations;
    all.residual = std::max(all.residual, report.residual);
    all.status = report.status;
    all.reason = report.reason;
    return report.status == StepStatus::solved;
  };
  parted_ = true;
  if (!run(*coarse_, h) || !run(*fine_, h / 2)) return all;
  remember_first_half();
  if (!run(*fine_, h / 2)) return all;
  parted_ = false;
  add_first_half();
  combine();
  return all;
}

template <int Dim>
void Extrapolated<Dim>::remember_first_half() {
  const auto contacts = fine_->contacts();
  const auto joints = fine_->joints();
  first_half_.assign(contacts.begin(), contacts.end());
  joints_first_half_.assign(joints.begin(), joints.end());
}

template <int Dim>
void Extrapolated<Dim>::add_first_half() {
  const auto second = fine_->contacts();
  contacts_.assign(second.begin(), second.end());
  const std::span<const ContactImpulse<Dim>> first = first_half_;
  for (const ContactImpulse<Dim>& c : first) {
    if (only_one(first, c) != nullptr && only_one<Dim>(second, c) != nullptr) {
      add_impulse(c, *std::find_if(contacts_.begin(), contacts_.end(),
                                   [&](const auto& other) { return same_pair(c, other); }));
    } else {
      contacts_.push_back(c);
    }
  }
  const auto joints = fine_->joints();
  joints_.assign(joints.begin(), joints.end());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].on_a += joints_first_half_[i].on_a;
    joints_[i].on_b += joints_first_half_[i].on_b;
  }
}

template <int Dim>
void Extrapolated<Dim>::combine() {
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const BodyState<Dim>& c = coarse_->state()[i];
    const BodyState<Dim>& f = fine_->state()[i];
    StateError<Dim>& error = error_[i];
    error.position = f.pose.position - c.pose.position;
    error.turn = turn_between(c.pose.rotation, f.pose.rotation);
    error.velocity = f.velocity - c.velocity;
    state_[i].pose.position = f.pose.position + error.position;
    state_[i].pose.rotation = f.pose.rotation.turned(error.turn);
    state_[i].velocity = f.velocity + error.velocity;
  }
}

template class Extrapolated<2>;
template class Extrapolated<3>;

}  // namespace touchstone
