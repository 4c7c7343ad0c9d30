#include "core/stepper/accelerated_sweeps.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr std::array<std::size_t, 2> kSides = {0, 1};
/// Least unit of changes, in those of the problem: squares of impulses of 1e5 over it are far from the
/// largest number in single precision, and so are squares of changes of 1e-26 from the smallest.
constexpr double kLeastSize = 1e-8;
/// Of mu p: a shorter anchor counts as 0, which is less than single precision tells of friction that slides;
/// mu p over its length might not be a number any more.
constexpr double kLeastAnchor = 1e-7;

}  // namespace

template <int Dim>
void AcceleratedSweeps<Dim>::bind(const StepProblem<Dim>& problem) {
  const auto count = static_cast<std::size_t>(problem.moving_bodies()) + 1;
  responses_.assign(count, {});
  bodies_.assign(count, {});
  for (std::size_t b = 1; b < count; ++b) {
    responses_[b] = body_response(problem, static_cast<int>(b) - 1);
    bodies_[b].inverse_mass = static_cast<float>(responses_[b].inverse_mass);
    for (int c = 0; c < kAngular; ++c)
      bodies_[b].inverse_inertia[static_cast<std::size_t>(kFirstTurn + c)] =
          in_lanes<kFirstTurn>(responses_[b].inverse_inertia.col(c));
  }
  contacts_.resize(problem.contacts().size());
  starts_.resize(contacts_.size());
  courses_.resize(contacts_.size());
}

template <int Dim>
void AcceleratedSweeps<Dim>::freeze(const StepProblem<Dim>& problem, std::size_t i,
                                    const ContactState<Dim>& state, const Eigen::VectorXd& z) {
  const PreparedContact<Dim>& prepared = problem.prepared(i);
  const double mu = problem.contacts()[i].law.mu;
  const std::array<int, 2> place = problem.places(i);
  Contact& contact = contacts_[i];
  contact.unit = static_cast<float>(prepared.mass * problem.scale().velocity);
  contact.mu = static_cast<float>(mu);
  contact.normal = in_lanes(state.frame.normal);
  contact.along = in_lanes(prepared.semi_axes[0] * state.frame.tangents.col(0));
  if constexpr (Dim == 3) {
    contact.across = in_lanes(prepared.semi_axes[1] * state.frame.tangents.col(1));
    contact.spinning = static_cast<float>(prepared.semi_axes[2]);
  }
  std::array<BodyResponse<Dim>, 2> responses;
  for (const std::size_t k : kSides) {
    contact.arm[k] = in_lanes(state.side[k].arm);
    contact.body[k] = static_cast<std::size_t>(place[k] + 1);
    responses[k] = responses_[contact.body[k]];
  }

  Start& start = starts_[i];
  const ContactLayout& at = problem.layout().contact(i);
  start.y = z.template segment<kFriction>(at.friction);
  start.p = z[at.normal];
  start.radius = mu * start.p;
  start.w = scaled_slip(state.frame, prepared.semi_axes, state.slip_velocity, state.spin_velocity);
  start.gap = state.distance() / problem.step_size();
  start.steps = sweep_steps(problem, i, state, responses);
}

template <int Dim>
void AcceleratedSweeps<Dim>::start(std::span<const std::size_t> contacts, double size) {
  size_ = std::max(size, kLeastSize);
  for (const std::size_t i : contacts) {
    Contact& contact = contacts_[i];
    const Start& start = starts_[i];
    const FrictionVector<Dim> stick = -start.steps.friction * start.w;
    FrictionVector<Dim> anchor = start.y + stick;
    if (anchor.norm() <= kLeastAnchor * start.radius) anchor.setZero();
    const double length = anchor.norm();
    const double part = length > 0 ? start.radius / length : 0.0;
    const auto step = static_cast<float>(start.steps.friction);
    contact.steps = Lanes{step, step, step, static_cast<float>(start.steps.normal)};
    contact.stick = in_lanes(stick / size_);
    contact.stick[3] = static_cast<float>(-start.steps.normal * start.gap / size_);
    contact.anchor = in_lanes(anchor / size_);
    contact.slide = in_lanes((part * anchor - start.y) / size_);
    contact.length = static_cast<float>(length / size_);
    contact.excess = static_cast<float>((length - start.radius) * (length + start.radius) / (size_ * size_));
    contact.load = static_cast<float>(start.p / size_);
    contact.change = no_lanes();
  }
}

template <int Dim>
void AcceleratedSweeps<Dim>::restore_momentum(const StepProblem<Dim>& problem, std::size_t body,
                                              const Twist<Dim>& row) {
  const BodyResponse<Dim>& response = responses_[body + 1];
  const Twist<Dim> missing = row.cwiseQuotient(problem.momentum_scale(static_cast<int>(body))) / -size_;
  bodies_[body + 1].velocity = in_lanes(response.inverse_mass * missing.template head<Dim>());
  bodies_[body + 1].spin = in_lanes<kFirstTurn>(response.inverse_inertia * missing.template tail<kAngular>());
}

template <int Dim>
int AcceleratedSweeps<Dim>::run(std::span<const std::size_t> contacts, int limit, double tolerance,
                                SweepAcceleration::Kind kind) {
  const auto small = static_cast<float>(tolerance / size_);
  acceleration_.begin(kind);
  for (int sweeps = 2;; sweeps += 2) {
    for (const std::size_t i : contacts) {
      contacts_[i].before = contacts_[i].change;
      sweep(contacts_[i]);
    }
    float largest = 0;
    for (auto at = contacts.rbegin(); at != contacts.rend(); ++at) {
      Contact& contact = contacts_[*at];
      sweep(contact);
      const Lanes change = contact.change - contact.before;
      courses_[*at].record(acceleration_, of_lanes<4>(change));
      largest = std::max(largest, largest_size(change));
    }
    if (!(largest > small) || sweeps >= limit) return sweeps;
    acceleration_.decide();
    for (const std::size_t i : contacts) {
      const Eigen::Vector4f all = courses_[i].step(acceleration_);
      const Lanes step{all[0], all[1], all[2], all[3]};
      contacts_[i].change += step;
      push(contacts_[i], step);
    }
  }
}

/// The impulses that a contact's own rows ask for. They may be much larger than what changes of them, so that
/// no change may be the difference of two terms of their size.
template <int Dim>
inline void AcceleratedSweeps<Dim>::sweep(Contact& contact) {
  const Body& first = bodies_[contact.body[0]];
  const Body& second = bodies_[contact.body[1]];
  const Lanes velocity = first.velocity - second.velocity + cross(first.spin, contact.arm[0]) -
                         cross(second.spin, contact.arm[1]);
  const Lanes spin = first.spin - second.spin;
  const Lanes relative = sums(contact.along * velocity, contact.across * velocity,
                              contact.spinning * contact.normal * spin, contact.normal * velocity);
  const Lanes move = contact.change - contact.steps * relative;
  const Lanes free = move + contact.stick;
  const float p = std::max(-contact.load, free[3]);
  if (p == contact.change[3] && p == -contact.load) return;  // most that are near

  // Of anchor + move, with which y is bounded, how much longer it is than anchor, and than mu p.
  const Lanes moved = of_space(move);
  const float lengthening_2 = sum(moved * (2 * contact.anchor + moved));  // of squares
  const float widening = contact.mu * p;
  const float radius = contact.mu * contact.load;
  const float excess = contact.excess + lengthening_2 - widening * (2 * radius + widening);
  const Lanes whole = contact.anchor + moved;
  const float length = excess > 0 ? std::sqrt(sum(whole * whole)) : 0.0F;
  Lanes impulse = of_space(free);
  if (length > 0) {
    const float part = contact.length > 0 ? radius / contact.length : 0.0F;
    const float growth = widening - part * (lengthening_2 / (length + contact.length));
    impulse = ((radius + widening) * moved + growth * contact.anchor) / length + contact.slide;
  }
  impulse += Lanes{0, 0, 0, p};
  const Lanes change = impulse - contact.change;
  contact.change = impulse;
  push(contact, change);
}

/// Adds what a change of a contact's impulses does to its bodies' velocities.
template <int Dim>
inline void AcceleratedSweeps<Dim>::push(const Contact& contact, Lanes change) {
  const Lanes impulse = contact.unit * change;
  const Lanes force = impulse[0] * contact.along + impulse[1] * contact.across + impulse[3] * contact.normal;
  const Lanes moment = impulse[2] * contact.spinning * contact.normal;
  const auto turn = [](const Body& body, Lanes torque) {
    return torque[0] * body.inverse_inertia[0] + torque[1] * body.inverse_inertia[1] +
           torque[2] * body.inverse_inertia[2];
  };
  Body& first = bodies_[contact.body[0]];
  Body& second = bodies_[contact.body[1]];
  first.velocity += first.inverse_mass * force;
  first.spin += turn(first, cross(contact.arm[0], force) + moment);
  second.velocity -= second.inverse_mass * force;
  second.spin -= turn(second, cross(contact.arm[1], force) + moment);
}

template <int Dim>
void AcceleratedSweeps<Dim>::write(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
                                   std::span<const std::size_t> bodies, Eigen::VectorXd& z) const {
  for (const std::size_t b : bodies) {
    const Eigen::Index at = problem.layout().velocity(static_cast<int>(b));
    z.template segment<Dim>(at) += size_ * of_lanes<Dim>(bodies_[b + 1].velocity).template cast<double>();
    z.template segment<kAngular>(at + Dim) +=
        size_ * of_lanes<kAngular, kFirstTurn>(bodies_[b + 1].spin).template cast<double>();
  }
  for (const std::size_t i : contacts) {
    const Contact& contact = contacts_[i];
    const ContactLayout& at = problem.layout().contact(i);
    auto y = z.template segment<kFriction>(at.friction);
    if (contact.change[3] == -contact.load) {
      z[at.normal] = 0;
      y.setZero();
    } else {
      z[at.normal] = std::max(0.0, z[at.normal] + size_ * static_cast<double>(contact.change[3]));
      y += size_ * of_lanes<kFriction>(contact.change).template cast<double>();
    }
  }
}

template class AcceleratedSweeps<2>;
template class AcceleratedSweeps<3>;

}  // namespace touchstone
