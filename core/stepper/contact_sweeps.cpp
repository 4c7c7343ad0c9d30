#include "core/stepper/contact_sweeps.h"

#include <Eigen/LU>
#include <algorithm>

namespace touchstone {

namespace {

constexpr double kRise = 1.1;  ///< factor of changes at which conjugate gradients begin anew
/// Where more contacts stick than the motion needs, some combination of impulses grows at the same rate in
/// each sweep until one of its contacts slides: where changes stay at more than this factor of the last ones
/// ...
constexpr double kSteady = 0.98;
constexpr double kGrowth = 1.05;  ///< ... the step is lengthened by this one

}  // namespace

template <int Dim>
void ContactSweeps<Dim>::run(const StepProblem<Dim>& problem, int sweeps, Eigen::VectorXd& z) {
  freeze(problem, z);
  for (int round = 0; round < sweeps; ++round) sweep_all(problem, round % 2 == 0);
  write(problem, z);
}

template <int Dim>
int ContactSweeps<Dim>::run_accelerated(const StepProblem<Dim>& problem, int limit, double tolerance,
                                        Eigen::VectorXd& z) {
  freeze(problem, z);
  for (Contact& contact : contacts_) {
    contact.before = contact.impulse();
    contact.direction.setZero();
  }
  last_change_ = 0;
  int sweeps = 0;
  while (sweeps < limit) {
    sweep_all(problem, true);
    sweep_all(problem, false);
    sweeps += 2;
    if (accelerate() <= tolerance) break;
  }
  write(problem, z);
  return sweeps;
}

/// Geometry and gaps at z, and the velocities that its impulses lead to.
template <int Dim>
void ContactSweeps<Dim>::freeze(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  const auto bodies = static_cast<std::size_t>(problem.moving_bodies());
  inverse_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    inverse_[b] = problem.momentum_matrix(static_cast<int>(b)).inverse();
  }
  contacts_.resize(problem.contacts().size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) freeze_contact(problem, i, z);
  freeze_joints(problem, z);

  nu_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) nu_[b] = problem.free_velocity_of(static_cast<int>(b));
  for (const Contact& contact : contacts_) push(contact, contact.impulse());
  for (const JointRow& row : joints_) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      if (row.place[k] >= 0) nu_[static_cast<std::size_t>(row.place[k])] += row.impulse * row.response[k];
    }
  }
}

template <int Dim>
void ContactSweeps<Dim>::sweep_all(const StepProblem<Dim>& problem, bool forward) {
  const double velocity = problem.scale().velocity;
  for (JointRow& row : joints_) sweep(row);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const std::size_t at = forward ? i : contacts_.size() - 1 - i;
    sweep(contacts_[at], problem.contacts()[at].law.mu, velocity);
  }
}

template <int Dim>
void ContactSweeps<Dim>::write(const StepProblem<Dim>& problem, Eigen::VectorXd& z) const {
  for (std::size_t b = 0; b < nu_.size(); ++b)
    z.template segment<kVelocity>(problem.layout().velocity(static_cast<int>(b))) = nu_[b];
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactLayout& at = problem.layout().contact(i);
    z.template segment<kFriction>(at.friction) = contacts_[i].y;
    z[at.normal] = contacts_[i].p;
  }
  for (const JointRow& row : joints_) z[row.column] = row.impulse;
}

template <int Dim>
void ContactSweeps<Dim>::freeze_contact(const StepProblem<Dim>& problem, std::size_t i,
                                        const Eigen::VectorXd& z) {
  problem.evaluate_state(i, z);
  Contact& contact = contacts_[i];
  const double velocity = problem.scale().velocity;
  contact.unit = problem.prepared(i).mass * velocity;
  contact.place = problem.places(i);
  contact.gap_velocity = problem.separation(i) / problem.step_size();
  Eigen::Matrix<double, kFriction + 1, kFriction + 1> delassus;
  delassus.setZero();
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (contact.place[k] < 0) continue;
    const auto body = static_cast<std::size_t>(contact.place[k]);
    contact.wrench[k] = problem.unit_wrenches(i, k);
    contact.response[k] =
        inverse_[body] * problem.momentum_scale(contact.place[k]).asDiagonal() * contact.wrench[k];
    delassus += contact.wrench[k].transpose() * contact.response[k] / contact.unit;
    contact.gap_velocity -=
        contact.wrench[k].col(kFriction).dot(z.template segment<kVelocity>(kVelocity * contact.place[k])) /
        contact.unit;
  }
  contact.normal_step = 1 / delassus(kFriction, kFriction);
  const double largest =
      delassus.template topLeftCorner<kFriction, kFriction>().cwiseAbs().rowwise().sum().maxCoeff();
  contact.friction_step = largest > 0 ? velocity / largest : 0.0;
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
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
        if (row.place[k] < 0) continue;
        row.gradient[k] = block_.j.row(r).template segment<kVelocity>(block_.column[k]).transpose();
        row.response[k] = -inverse_[static_cast<std::size_t>(row.place[k])] *
                          block_.j.col(r).template segment<kVelocity>(block_.column[k]);
        row.constant -= row.gradient[k].dot(z.template segment<kVelocity>(kVelocity * row.place[k]));
        denominator += row.gradient[k].dot(row.response[k]);
      }
      row.step = denominator != 0 ? 1 / denominator : 0.0;
      joints_.push_back(row);
    }
  }
}

/// A step of nonlinear conjugate gradients (Silcowitz, Niebe & Erleben 2010): the change that the last pair
/// of sweeps made is taken as the residual of a symmetric system, and the last direction goes on for as long
/// as changes fall.
/// @return  the largest change of an impulse in that pair
template <int Dim>
double ContactSweeps<Dim>::accelerate() {
  double change = 0;
  double largest = 0;
  for (const Contact& contact : contacts_) {
    const Impulse swept = contact.impulse() - contact.before;
    change += swept.squaredNorm();
    largest = std::max(largest, swept.cwiseAbs().maxCoeff());
  }
  const bool goes_on = last_change_ > 0 && change <= kRise * last_change_;
  double beta = goes_on ? change / last_change_ : 0.0;
  if (beta > kSteady) beta = kGrowth;
  last_change_ = change;
  for (Contact& contact : contacts_) {
    const Impulse swept = contact.impulse() - contact.before;
    if (goes_on) {
      const Impulse step = beta * contact.direction;
      contact.y += step.template head<kFriction>();
      contact.p += step[kFriction];
      push(contact, step);
      contact.direction = step + swept;
    } else {
      contact.direction.setZero();
    }
    contact.before = contact.impulse();
  }
  return largest;
}

template <int Dim>
void ContactSweeps<Dim>::push(const Contact& contact, const Impulse& change) {
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (contact.place[k] >= 0)
      nu_[static_cast<std::size_t>(contact.place[k])] += contact.response[k] * change;
  }
}

template <int Dim>
void ContactSweeps<Dim>::sweep(Contact& contact, double mu, double velocity) {
  double approach = contact.gap_velocity;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (contact.place[k] >= 0) {
      approach += contact.wrench[k].col(kFriction).dot(nu_[static_cast<std::size_t>(contact.place[k])]) /
                  contact.unit;
    }
  }
  const double p = std::max(0.0, contact.p - contact.normal_step * approach);
  if (p == 0 && contact.p == 0) return;  // most of those that are near: neither has friction
  Impulse speed = Impulse::Zero();
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (contact.place[k] >= 0) {
      speed += contact.wrench[k].transpose() * nu_[static_cast<std::size_t>(contact.place[k])] / contact.unit;
    }
  }
  FrictionVector<Dim> y = contact.y - contact.friction_step / velocity * speed.template head<kFriction>();
  const double length = y.norm();
  if (length > mu * p) y *= mu * p / length;
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
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (row.place[k] >= 0) phi += row.gradient[k].dot(nu_[static_cast<std::size_t>(row.place[k])]);
  }
  const double change = -row.step * phi;
  row.impulse += change;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (row.place[k] >= 0) nu_[static_cast<std::size_t>(row.place[k])] += change * row.response[k];
  }
}

template class ContactSweeps<2>;
template class ContactSweeps<3>;

}  // namespace touchstone
