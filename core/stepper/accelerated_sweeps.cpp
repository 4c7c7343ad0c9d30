#include "core/stepper/accelerated_sweeps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace touchstone {

namespace {

constexpr std::array<std::size_t, 2> kSides = {0, 1};
/// Least unit of changes, in those of the problem: squares of impulses of 1e5 over it are far from the
/// largest number in single precision, and so are squares of changes of 1e-26 from the smallest.
constexpr double kLeastSize = 1e-8;
/// Of mu p: a shorter anchor counts as 0, which is less than single precision tells of friction that slides;
/// mu p over its length might not be a number any more.
constexpr double kLeastAnchor = 1e-7;

template <typename Derived>
std::array<float, 3> in_space(const Eigen::MatrixBase<Derived>& v) {
  std::array<float, 3> result{};
  const auto values = in_floats(v);
  std::copy(values.data(), values.data() + values.size(), result.begin());
  return result;
}

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
  bodies_of_contact_.resize(contacts_.size());
  last_change_.resize(contacts_.size());
  starts_.resize(contacts_.size());
}

template <int Dim>
void AcceleratedSweeps<Dim>::freeze(const StepProblem<Dim>& problem, std::size_t i,
                                    const ContactState<Dim>& state, const Eigen::VectorXd& z) {
  const PreparedContact<Dim>& prepared = problem.prepared(i);
  const double mu = problem.contacts()[i].law.mu;
  const std::array<int, 2> place = problem.places(i);
  Contact<float>& contact = contacts_[i];
  contact.unit = static_cast<float>(prepared.mass * problem.scale().velocity);
  contact.mu = static_cast<float>(mu);
  contact.normal = in_space(state.frame.normal);
  contact.along = in_space(prepared.semi_axes[0] * state.frame.tangents.col(0));
  if constexpr (Dim == 3) {
    contact.across = in_space(prepared.semi_axes[1] * state.frame.tangents.col(1));
    contact.spinning = static_cast<float>(prepared.semi_axes[2]);
  }
  std::array<BodyResponse<Dim>, 2> responses;
  for (const std::size_t k : kSides) {
    contact.arm[k] = in_space(state.side[k].arm);
    bodies_of_contact_[i][k] = static_cast<std::size_t>(place[k] + 1);
    responses[k] = responses_[bodies_of_contact_[i][k]];
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
    Contact<float>& contact = contacts_[i];
    const Start& start = starts_[i];
    const FrictionVector<Dim> stick = -start.steps.friction * start.w;
    FrictionVector<Dim> anchor = start.y + stick;
    if (anchor.norm() <= kLeastAnchor * start.radius) anchor.setZero();
    const double length = anchor.norm();
    const double part = length > 0 ? start.radius / length : 0.0;
    contact.friction_step = static_cast<float>(start.steps.friction);
    contact.normal_step = static_cast<float>(start.steps.normal);
    const std::array<float, 3> friction = in_space(stick / size_);
    std::copy(friction.begin(), friction.end(), contact.stick.begin());
    contact.stick[3] = static_cast<float>(-start.steps.normal * start.gap / size_);
    contact.anchor = in_space(anchor / size_);
    contact.slide = in_space((part * anchor - start.y) / size_);
    contact.length = static_cast<float>(length / size_);
    contact.excess = static_cast<float>((length - start.radius) * (length + start.radius) / (size_ * size_));
    contact.load = static_cast<float>(start.p / size_);
    contact.part = static_cast<float>(part);
    contact.change = {};
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
  group(contacts);
  acceleration_.begin(kind);
  int sweeps = 0;
  for (;;) {
    sweeps += 2;
    for (Group& group : groups_) {
      group.before = group.contact.change;
      sweep(group);
    }
    Lanes largest_change = no_lanes();
    for (std::size_t g = groups_.size(); g-- > 0;) {
      Group& group = groups_[g];
      sweep(group);
      for (std::size_t r = 0; r < 4; ++r) {
        group.before[r] = group.contact.change[r] - group.before[r];
        largest_change = larger(largest_change, sizes(group.before[r]));
      }
      courses_[g].record(acceleration_, entries(group.before));
    }
    if (!(largest(largest_change) > small) || sweeps >= limit) break;
    acceleration_.decide();
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Course::Short all = courses_[g].step(acceleration_);
      std::array<Lanes, 4> step;
      std::memcpy(&step, all.data(), sizeof step);
      for (std::size_t r = 0; r < 4; ++r) groups_[g].contact.change[r] += step[r];
      push(groups_[g], step);
    }
  }
  ungroup();
  return sweeps;
}

template <int Dim>
typename AcceleratedSweeps<Dim>::Course::Short AcceleratedSweeps<Dim>::entries(
    const std::array<Lanes, 4>& change) {
  typename Course::Short all;
  std::memcpy(all.data(), &change, sizeof change);
  return all;
}

/// Puts contacts into groups, in which they go on from where they are.
template <int Dim>
void AcceleratedSweeps<Dim>::group(std::span<const std::size_t> contacts) {
  order_.begin(bodies_.size());
  groups_.clear();
  for (const std::size_t i : contacts) {
    const std::size_t place = order_.place(bodies_of_contact_[i]);
    if (place / kLanes == groups_.size()) groups_.emplace_back();
    Group& group = groups_[place / kLanes];
    group.member[place % kLanes] = i;
    for (const std::size_t k : kSides) group.body[k][place % kLanes] = bodies_of_contact_[i][k];
  }
  courses_.assign(groups_.size(), {});
  constexpr std::size_t kFours = sizeof(Contact<float>) / sizeof(Lanes);
  using Fours = std::array<Lanes, kFours>;
  for (Group& group : groups_) {
    std::array<std::array<Lanes, kLanes>, kFours> rows{};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (group.member[lane] == kNone) continue;
      const auto fours = std::bit_cast<Fours>(contacts_[group.member[lane]]);
      for (std::size_t r = 0; r < kFours; ++r) rows[r][lane] = fours[r];
    }
    for (std::array<Lanes, kLanes>& four : rows) transpose(four);
    group.contact = std::bit_cast<Contact<Lanes>>(rows);
  }
}

/// What has changed of contacts, back from their groups.
template <int Dim>
void AcceleratedSweeps<Dim>::ungroup() {
  for (const Group& group : groups_) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = group.member[lane];
      if (i == kNone) continue;
      last_change_[i] = 0;
      for (std::size_t r = 0; r < 4; ++r) {
        contacts_[i].change[r] = group.contact.change[r][lane];
        last_change_[i] = std::max(last_change_[i], std::abs(group.before[r][lane]));
      }
    }
  }
}

/// The impulses that a contact's own rows ask for. They may be much larger than what changes of them, so that
/// no change may be the difference of two terms of their size.
template <int Dim>
inline void AcceleratedSweeps<Dim>::sweep(Group& group) {
  Contact<Lanes>& contact = group.contact;
  std::array<Lanes, kLanes> velocity, spin_1, spin_2;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const Body& first = bodies_[group.body[0][lane]];
    const Body& second = bodies_[group.body[1][lane]];
    velocity[lane] = first.velocity - second.velocity;
    spin_1[lane] = first.spin;
    spin_2[lane] = second.spin;
  }
  transpose(velocity);
  transpose(spin_1);
  transpose(spin_2);
  const Space turn_1 = cross({spin_1[0], spin_1[1], spin_1[2]}, contact.arm[0]);
  const Space turn_2 = cross({spin_2[0], spin_2[1], spin_2[2]}, contact.arm[1]);
  Space relative, spin;
  for (std::size_t c = 0; c < 3; ++c) {
    relative[c] = velocity[c] + turn_1[c] - turn_2[c];
    spin[c] = spin_1[c] - spin_2[c];
  }
  const Space slip = {dot(contact.along, relative), dot(contact.across, relative),
                      contact.spinning * dot(contact.normal, spin)};
  const Lanes closing = dot(contact.normal, relative);
  const Lanes p = larger(contact.change[3] - contact.normal_step * closing + contact.stick[3], -contact.load);
  const LaneMask is_off = (p == contact.change[3]) & (p == -contact.load);
  if (all(is_off)) return;  // most that are near

  // Of anchor + moved, with which y is bounded, how much longer it is than anchor, and than mu p.
  Space moved;
  Lanes lengthening_2 = no_lanes();  // of squares
  Lanes length_2 = no_lanes();
  for (std::size_t c = 0; c < 3; ++c) {
    moved[c] = contact.change[c] - contact.friction_step * slip[c];
    lengthening_2 += moved[c] * (2 * contact.anchor[c] + moved[c]);
    length_2 += (contact.anchor[c] + moved[c]) * (contact.anchor[c] + moved[c]);
  }
  const Lanes widening = contact.mu * p;
  const Lanes radius = contact.mu * contact.load;
  const Lanes excess = contact.excess + lengthening_2 - widening * (2 * radius + widening);
  const Lanes length = roots(length_2);
  const LaneMask slides = (excess > 0) & (length > 0);
  const Lanes growth = widening - contact.part * (lengthening_2 / (length + contact.length));
  std::array<Lanes, 4> change;
  for (std::size_t c = 0; c < 3; ++c) {
    const Lanes bounded =
        ((radius + widening) * moved[c] + growth * contact.anchor[c]) / length + contact.slide[c];
    const Lanes y = slides ? bounded : moved[c] + contact.stick[c];
    change[c] = is_off ? no_lanes() : y - contact.change[c];
    contact.change[c] += change[c];
  }
  change[3] = p - contact.change[3];
  contact.change[3] = p;
  push(group, change);
}

/// Adds what changes of the contacts' impulses do to their bodies' velocities.
template <int Dim>
inline void AcceleratedSweeps<Dim>::push(const Group& group, const std::array<Lanes, 4>& change) {
  const Contact<Lanes>& contact = group.contact;
  std::array<Lanes, 4> impulse;
  for (std::size_t r = 0; r < 4; ++r) impulse[r] = contact.unit * change[r];
  Space push, moment;
  for (std::size_t c = 0; c < 3; ++c) {
    push[c] = impulse[0] * contact.along[c] + impulse[1] * contact.across[c] + impulse[3] * contact.normal[c];
    moment[c] = impulse[2] * contact.spinning * contact.normal[c];
  }
  const Space lever_1 = cross(contact.arm[0], push);
  const Space lever_2 = cross(contact.arm[1], push);
  std::array<Lanes, kLanes> force = {push[0], push[1], push[2], no_lanes()};
  std::array<Lanes, kLanes> torque_1 = {lever_1[0] + moment[0], lever_1[1] + moment[1],
                                        lever_1[2] + moment[2], no_lanes()};
  std::array<Lanes, kLanes> torque_2 = {lever_2[0] + moment[0], lever_2[1] + moment[1],
                                        lever_2[2] + moment[2], no_lanes()};
  transpose(force);
  transpose(torque_1);
  transpose(torque_2);
  const auto turn = [](const Body& body, Lanes torque) {
    return torque[0] * body.inverse_inertia[0] + torque[1] * body.inverse_inertia[1] +
           torque[2] * body.inverse_inertia[2];
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    Body& first = bodies_[group.body[0][lane]];
    Body& second = bodies_[group.body[1][lane]];
    first.velocity += first.inverse_mass * force[lane];
    first.spin += turn(first, torque_1[lane]);
    second.velocity -= second.inverse_mass * force[lane];
    second.spin -= turn(second, torque_2[lane]);
  }
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
    const Contact<float>& contact = contacts_[i];
    const ContactLayout& at = problem.layout().contact(i);
    auto y = z.template segment<kFriction>(at.friction);
    if (contact.change[3] == -contact.load) {
      z[at.normal] = 0;
      y.setZero();
    } else {
      z[at.normal] = std::max(0.0, z[at.normal] + size_ * static_cast<double>(contact.change[3]));
      for (int c = 0; c < kFriction; ++c)
        y[c] += size_ * static_cast<double>(contact.change[static_cast<std::size_t>(c)]);
    }
  }
}

template class AcceleratedSweeps<2>;
template class AcceleratedSweeps<3>;

}  // namespace touchstone
