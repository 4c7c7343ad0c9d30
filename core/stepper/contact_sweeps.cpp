#include "core/stepper/contact_sweeps.h"

#include <algorithm>

namespace touchstone {

namespace {

constexpr std::array<std::size_t, 2> kSides = {0, 1};

}  // namespace

template <int Dim>
void ContactSweeps<Dim>::run(const StepProblem<Dim>& problem, int sweeps, Eigen::VectorXd& z) {
  freeze_all(problem, z);
  for (int round = 0; round < sweeps; ++round) sweep_all(round % 2 == 0);
  write(problem, z);
}

/// Geometry and gaps at z, and the velocities that its impulses lead to.
template <int Dim>
void ContactSweeps<Dim>::freeze_all(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  bodies_.resize(static_cast<std::size_t>(problem.moving_bodies()));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int place = static_cast<int>(b);
    bodies_[b] = {problem.free_velocity_of(place), body_response(problem, place)};
  }
  contacts_.resize(problem.contacts().size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    problem.evaluate_state(i, z);
    freeze(problem, i, z);
    push(contacts_[i], contacts_[i].impulse());
  }
  freeze_joints(problem, z);
  for (const JointRow& row : joints_) {
    for (const std::size_t k : kSides) {
      if (row.place[k] >= 0)
        bodies_[static_cast<std::size_t>(row.place[k])].nu += row.impulse * row.response[k];
    }
  }
}

template <int Dim>
void ContactSweeps<Dim>::sweep_all(bool forward) {
  for (JointRow& row : joints_) sweep(row);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const std::size_t at = forward ? i : contacts_.size() - 1 - i;
    sweep(contacts_[at]);
  }
}

template <int Dim>
void ContactSweeps<Dim>::write(const StepProblem<Dim>& problem, Eigen::VectorXd& z) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) write_velocity(problem, b, z);
  for (std::size_t i = 0; i < contacts_.size(); ++i) write_impulse(problem, i, z);
  for (const JointRow& row : joints_) z[row.column] = row.impulse;
}

template <int Dim>
void ContactSweeps<Dim>::write_velocity(const StepProblem<Dim>& problem, std::size_t body,
                                        Eigen::VectorXd& z) const {
  z.template segment<kVelocity>(problem.layout().velocity(static_cast<int>(body))) = bodies_[body].nu;
}

template <int Dim>
void ContactSweeps<Dim>::write_impulse(const StepProblem<Dim>& problem, std::size_t i,
                                       Eigen::VectorXd& z) const {
  const ContactLayout& at = problem.layout().contact(i);
  z.template segment<kFriction>(at.friction) = contacts_[i].y;
  z[at.normal] = contacts_[i].p;
}

template <int Dim>
void ContactSweeps<Dim>::freeze(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z) {
  Contact& contact = contacts_[i];
  const ContactState<Dim>& state = problem.state(i);
  contact.unit = problem.prepared(i).mass * problem.scale().velocity;
  contact.mu = problem.contacts()[i].law.mu;
  contact.semi_axes = problem.prepared(i).semi_axes;
  contact.place = problem.places(i);
  contact.frame = state.frame;
  std::array<BodyResponse<Dim>, 2> responses{};
  Vector<Dim> moving = Vector<Dim>::Zero();  // velocity of body 1 against body 2 at z
  for (const std::size_t k : kSides) {
    contact.arm[k] = state.side[k].arm;
    if (contact.place[k] < 0) continue;
    responses[k] = bodies_[static_cast<std::size_t>(contact.place[k])].response;
    const Vector<Dim> point = point_velocity<Dim>(
        z.template segment<kVelocity>(problem.layout().velocity(contact.place[k])), contact.arm[k]);
    moving += (k == 0 ? 1 : -1) * point;
  }
  contact.gap_velocity = problem.separation(i) / problem.step_size() - contact.frame.normal.dot(moving);
  contact.step = sweep_steps(problem, i, state, responses);
  const ContactLayout& at = problem.layout().contact(i);
  contact.p = std::max(0.0, z[at.normal]);
  contact.y = z.template segment<kFriction>(at.friction);
  if (contact.p == 0) contact.y.setZero();
}

template <int Dim>
void ContactSweeps<Dim>::freeze_joints(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  joints_.clear();
  for (const int joint : problem.joints()) {
    problem.joint_block(joint, z, true, block_);
    for (Eigen::Index r = block_.own; r < block_.size; ++r) {
      JointRow row;
      row.place = block_.place;
      row.column = problem.joint_column(joint) + r - block_.own;
      row.impulse = z[row.column];
      row.constant = block_.f[r];
      double denominator = 0;
      for (const std::size_t k : kSides) {
        if (row.place[k] < 0) continue;
        const Body& body = bodies_[static_cast<std::size_t>(row.place[k])];
        row.gradient[k] = block_.j.row(r).template segment<kVelocity>(block_.column[k]).transpose();
        const Twist<Dim> wrench = -block_.j.col(r)
                                       .template segment<kVelocity>(block_.column[k])
                                       .cwiseQuotient(problem.momentum_scale(row.place[k]));
        row.response[k] << body.response.inverse_mass * wrench.template head<Dim>(),
            body.response.inverse_inertia * wrench.template tail<kAngular>();
        row.constant -= row.gradient[k].dot(z.template segment<kVelocity>(kVelocity * row.place[k]));
        denominator += row.gradient[k].dot(row.response[k]);
      }
      row.step = denominator != 0 ? 1 / denominator : 0.0;
      joints_.push_back(row);
    }
  }
}

/// Velocity of body 1 against body 2 at the contact, and how it turns against it.
template <int Dim>
Twist<Dim> ContactSweeps<Dim>::relative_velocity(const Contact& contact) const {
  Twist<Dim> relative = Twist<Dim>::Zero();
  for (const std::size_t k : kSides) {
    if (contact.place[k] < 0) continue;
    const Twist<Dim>& nu = bodies_[static_cast<std::size_t>(contact.place[k])].nu;
    const Angular<Dim> omega = nu.template tail<kAngular>();
    const Vector<Dim> velocity = point_velocity<Dim>(nu, contact.arm[k]);
    if (k == 0) {
      relative.template head<Dim>() = velocity;
      relative.template tail<kAngular>() = omega;
    } else {
      relative.template head<Dim>() -= velocity;
      relative.template tail<kAngular>() -= omega;
    }
  }
  return relative;
}

/// Adds what a change of a contact's impulses does to its bodies' velocities.
template <int Dim>
void ContactSweeps<Dim>::push(const Contact& contact, const Impulse& change) {
  const FrictionVector<Dim> friction = contact.semi_axes.cwiseProduct(change.template head<kFriction>());
  const Vector<Dim> force = contact.unit * (contact.frame.tangents * friction.template head<kTangent>() +
                                            change[kFriction] * contact.frame.normal);
  for (const std::size_t k : kSides) {
    if (contact.place[k] < 0) continue;
    Body& body = bodies_[static_cast<std::size_t>(contact.place[k])];
    Angular<Dim> torque = moment(contact.arm[k], force);
    if constexpr (Dim == 3) torque += contact.unit * friction[2] * contact.frame.normal;
    const double sign = k == 0 ? 1.0 : -1.0;
    body.nu.template head<Dim>() += sign * body.response.inverse_mass * force;
    body.nu.template tail<kAngular>() += sign * (body.response.inverse_inertia * torque);
  }
}

template <int Dim>
void ContactSweeps<Dim>::sweep(Contact& contact) {
  const Twist<Dim> relative = relative_velocity(contact);
  const double approach = contact.gap_velocity + contact.frame.normal.dot(relative.template head<Dim>());
  const double p = std::max(0.0, contact.p - contact.step.normal * approach);
  if (p == 0 && contact.p == 0 && contact.y == FrictionVector<Dim>::Zero()) return;  // most that are near
  const FrictionVector<Dim> slip = scaled_slip<Dim>(
      contact.frame, contact.semi_axes, relative.template head<Dim>(), relative.template tail<kAngular>());
  FrictionVector<Dim> y = contact.y - contact.step.friction * slip;
  const double length = y.norm();
  if (length > contact.mu * p) y *= contact.mu * p / length;
  Impulse change;
  change.template head<kFriction>() = y - contact.y;
  change[kFriction] = p - contact.p;
  contact.y = y;
  contact.p = p;
  push(contact, change);
}

template <int Dim>
void ContactSweeps<Dim>::sweep(JointRow& row) {
  double phi = row.constant;
  for (const std::size_t k : kSides) {
    if (row.place[k] >= 0) phi += row.gradient[k].dot(bodies_[static_cast<std::size_t>(row.place[k])].nu);
  }
  const double change = -row.step * phi;
  row.impulse += change;
  for (const std::size_t k : kSides) {
    if (row.place[k] >= 0) bodies_[static_cast<std::size_t>(row.place[k])].nu += change * row.response[k];
  }
}

template class ContactSweeps<2>;
template class ContactSweeps<3>;

}  // namespace touchstone
