#include "core/stepper/contact_sweeps.h"

#include <Eigen/Cholesky>
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

/// Velocities are L^T nu' in here, M = L L^T: what an impulse changes of them and what it feels of them are
/// then the same numbers.
template <int Dim>
void ContactSweeps<Dim>::bind(const StepProblem<Dim>& problem) {
  const auto bodies = static_cast<std::size_t>(problem.moving_bodies());
  root_.resize(bodies);
  for (std::size_t b = 0; b < bodies; ++b) {
    const int place = static_cast<int>(b);
    const MotionMatrix<Dim> mass =
        problem.momentum_scale(place).cwiseInverse().asDiagonal() * problem.momentum_matrix(place);
    root_[b] = mass.llt().matrixL();
  }
  nu_.resize(bodies);
  moves_.resize(bodies);
  contacts_.resize(problem.contacts().size());
  joints_.clear();
}

template <int Dim>
void ContactSweeps<Dim>::start_free(const StepProblem<Dim>& problem, std::size_t body) {
  nu_[body] = root_[body].transpose() * problem.free_velocity_of(static_cast<int>(body));
}

template <int Dim>
void ContactSweeps<Dim>::write_velocity(const StepProblem<Dim>& problem, std::size_t body,
                                        Eigen::VectorXd& z) const {
  z.template segment<kVelocity>(problem.layout().velocity(static_cast<int>(body))) =
      root_[body].transpose().template triangularView<Eigen::Upper>().solve(nu_[body]);
}

template <int Dim>
void ContactSweeps<Dim>::freeze(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
                                std::span<const std::size_t> bodies, const Eigen::VectorXd& z) {
  std::fill(moves_.begin(), moves_.end(), false);
  for (const std::size_t b : bodies) {
    start_free(problem, b);
    moves_[b] = true;
  }
  for (const std::size_t i : contacts) {
    freeze_contact(problem, i, z);
    const Contact& contact = contacts_[i];
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      if (contact.place[k] < 0 || !moves_[static_cast<std::size_t>(contact.place[k])]) continue;
      nu_[static_cast<std::size_t>(contact.place[k])] += contact.wrench[k] * contact.impulse();
    }
  }
}

template <int Dim>
int ContactSweeps<Dim>::run_accelerated(const StepProblem<Dim>& problem,
                                        std::span<const std::size_t> contacts, int limit, double tolerance) {
  const double velocity = problem.scale().velocity;
  const auto sweep_one = [&](std::size_t i) { sweep(contacts_[i], problem.contacts()[i].law.mu, velocity); };
  for (const std::size_t i : contacts) {
    contacts_[i].before = contacts_[i].impulse();
    contacts_[i].direction.setZero();
  }
  last_change_ = 0;
  int sweeps = 0;
  while (sweeps < limit) {
    std::for_each(contacts.begin(), contacts.end(), sweep_one);
    std::for_each(contacts.rbegin(), contacts.rend(), sweep_one);
    sweeps += 2;
    if (accelerate(contacts) <= tolerance) break;
  }
  return sweeps;
}

template <int Dim>
void ContactSweeps<Dim>::write(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
                               std::span<const std::size_t> bodies, Eigen::VectorXd& z) const {
  for (const std::size_t b : bodies) write_velocity(problem, b, z);
  for (const std::size_t i : contacts) write_contact(problem, i, z);
}

/// Geometry and gaps at z, and the velocities that its impulses lead to.
template <int Dim>
void ContactSweeps<Dim>::freeze(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  bind(problem);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    problem.evaluate_state(i, z);
    freeze_contact(problem, i, z);
  }
  freeze_joints(problem, z);

  for (std::size_t b = 0; b < nu_.size(); ++b) start_free(problem, b);
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
  for (std::size_t b = 0; b < nu_.size(); ++b) write_velocity(problem, b, z);
  for (std::size_t i = 0; i < contacts_.size(); ++i) write_contact(problem, i, z);
  for (const JointRow& row : joints_) z[row.column] = row.impulse;
}

template <int Dim>
void ContactSweeps<Dim>::write_contact(const StepProblem<Dim>& problem, std::size_t i,
                                       Eigen::VectorXd& z) const {
  const ContactLayout& at = problem.layout().contact(i);
  z.template segment<kFriction>(at.friction) = contacts_[i].y;
  z[at.normal] = contacts_[i].p;
}

template <int Dim>
void ContactSweeps<Dim>::freeze_contact(const StepProblem<Dim>& problem, std::size_t i,
                                        const Eigen::VectorXd& z) {
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
    const Wrenches wrench = problem.unit_wrenches(i, k);
    contact.wrench[k] = root_[body].template triangularView<Eigen::Lower>().solve(wrench);
    delassus += contact.wrench[k].transpose() * contact.wrench[k] / contact.unit;
    contact.gap_velocity -=
        wrench.col(kFriction).dot(z.template segment<kVelocity>(kVelocity * contact.place[k])) / contact.unit;
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
        const auto body = static_cast<std::size_t>(row.place[k]);
        const auto lower = root_[body].template triangularView<Eigen::Lower>();
        const Twist<Dim> gradient = block_.j.row(r).template segment<kVelocity>(block_.column[k]).transpose();
        const Twist<Dim> wrench = block_.j.col(r).template segment<kVelocity>(block_.column[k]);
        row.gradient[k] = lower.solve(gradient);
        row.response[k] = -lower.solve(wrench.cwiseQuotient(problem.momentum_scale(row.place[k])).eval());
        row.constant -= gradient.dot(z.template segment<kVelocity>(kVelocity * row.place[k]));
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
double ContactSweeps<Dim>::accelerate(std::span<const std::size_t> contacts) {
  double change = 0;
  double largest = 0;
  for (const std::size_t i : contacts) {
    Contact& contact = contacts_[i];
    const Impulse swept = contact.impulse() - contact.before;
    change += swept.squaredNorm();
    contact.change = swept.cwiseAbs().maxCoeff();
    largest = std::max(largest, contact.change);
  }
  const bool goes_on = last_change_ > 0 && change <= kRise * last_change_;
  double beta = goes_on ? change / last_change_ : 0.0;
  if (beta > kSteady) beta = kGrowth;
  last_change_ = change;
  for (const std::size_t i : contacts) {
    Contact& contact = contacts_[i];
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
    if (contact.place[k] >= 0) nu_[static_cast<std::size_t>(contact.place[k])] += contact.wrench[k] * change;
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
