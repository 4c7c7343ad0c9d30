#include "core/stepper/condensed_system.h"

#include <algorithm>
#include <cmath>

#include "core/stepper/make_room.h"
#include "core/stepper/momentum_matrices.h"

namespace touchstone {

namespace {

constexpr double kRegularisation = 1e-9;  ///< see newton_step()
constexpr double kHold = 0.1;             ///< see hold()

}  // namespace

template <int Dim>
void CondensedSystem<Dim>::bind(StepProblem<Dim>& problem) {
  problem_ = &problem;
  const std::size_t contacts = problem.contacts().size();
  if (contacts_.size() < contacts) contacts_.resize(contacts);
  if (joints_.size() < problem.joints().size()) joints_.resize(problem.joints().size());
  for (std::size_t i = 0; i < contacts; ++i) contacts_[i].bind(problem, i);
  const Eigen::Index reduced = problem.layout().contacts_begin() +
                               static_cast<Eigen::Index>(contacts) * CondensedContact<Dim>::kImpulses;
  make_room(solution_, reduced);
  reduced_.reserve(reduced);
  make_room(step_, problem.size());
  make_room(momentum_, problem.layout().joints());
  evaluations_ = 0;
  factorisations_ = 0;
}

template <int Dim>
void CondensedSystem<Dim>::set_form(const CondensedForm& form) {
  form_ = form;
  problem_->set_smoothing(form.smoothing);
}

template <int Dim>
void CondensedSystem<Dim>::evaluate(Eigen::VectorXd& z) {
  ++evaluations_;
  total_ = {};
  for (int b = 0; b < problem_->moving_bodies(); ++b)
    momentum_.template segment<kVelocity>(kVelocity * b) = problem_->momentum_row(b, z);
  evaluate_joints(z);
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    contacts_[i].evaluate(form_, z, total_);
    add_wrenches(contacts_[i].block());
  }
  for (Eigen::Index r = 0; r < kVelocity * problem_->moving_bodies(); ++r) {
    total_.account(momentum_[r], r);
    total_.merit += momentum_[r] * momentum_[r];
  }
  total_.merit *= 0.5;
}

template <int Dim>
void CondensedSystem<Dim>::evaluate_joints(const Eigen::VectorXd& z) {
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    StepBlock<Dim>& block = joints_[j].block;
    const int joint = problem_->joints()[j];
    problem_->joint_block(joint, z, false, block);
    add_wrenches(block);
    for (Eigen::Index r = block.own; r < block.size; ++r) {
      total_.account(block.f[r], problem_->joint_column(joint) + r - block.own);
      total_.merit += block.f[r] * block.f[r];
    }
  }
}

/// What a contact or joint does to its bodies, to their rows.
template <int Dim>
void CondensedSystem<Dim>::add_wrenches(const StepBlock<Dim>& block) {
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (block.place[k] < 0) continue;
    momentum_.template segment<kVelocity>(kVelocity * block.place[k]) +=
        block.f.template segment<kVelocity>(block.column[k]);
  }
}

/// Rows that stand, closest points eliminated, and the places of what is left.
template <int Dim>
void CondensedSystem<Dim>::condense(const Eigen::VectorXd& z) {
  ++factorisations_;
  reduced_size_ = problem_->layout().joints();
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    CondensedPart<Dim>& joint = joints_[j];
    problem_->joint_block(problem_->joints()[j], z, true, joint.block);
    joint.list_velocities();
    for (Eigen::Index c = joint.block.own; c < joint.block.size; ++c) joint.keep(c, reduced_size_);
  }
  const double held = form_.damps ? hold() : 0.0;
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i)
    contacts_[i].condense(form_, held, z, reduced_size_);
}

/// Where contacts are more than the motion needs their impulses are not unique, and a step that nothing but
/// rounding ties down leads far from modes of contact that were right. This multiple of the impulses' change
/// is added to their rows, as in Levenberg and Marquardt's method; it goes with the root of the residual, so
/// that what it allows of the change and what it costs in convergence both vanish at a solution.
template <int Dim>
double CondensedSystem<Dim>::hold() const {
  if (form_.hold > 0) return form_.hold;
  return kHold * std::sqrt(std::min(total_.residual, 1.0));
}

/// @param regularisation  added to the diagonal of the impulses' rows
template <int Dim>
bool CondensedSystem<Dim>::factor(double regularisation) {
  reduced_.start(reduced_size_);
  add_momentum_matrices(*problem_, reduced_);
  const auto add = [this](const CondensedPart<Dim>& part) {
    reduced_.add(part.kept, part.place, part.block.j);
  };
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) add(joints_[j]);
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) add(contacts_[i].part());
  if (regularisation > 0) reduced_.add_to_diagonal(problem_->layout().joints(), regularisation);
  return reduced_.factor();
}

/// Where more contacts act than the motion needs (a body between several others, at rest) impulses are not
/// unique and the rows dependent. A small multiple of the impulses' change makes the system regular and
/// vanishes as the search converges.
template <int Dim>
bool CondensedSystem<Dim>::newton_step(const Eigen::VectorXd& z) {
  condense(z);
  if (!(reduced_.is_dense(reduced_size_) && factor(0.0)) && !factor(kRegularisation)) return false;
  solve_reduced();
  expand();
  return true;
}

template <int Dim>
void CondensedSystem<Dim>::chord_step(const Eigen::VectorXd& z) {
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) contacts_[i].update_rows(form_, z);
  solve_reduced();
  expand();
}

/// Right side and solution of the reduced system.
template <int Dim>
void CondensedSystem<Dim>::solve_reduced() {
  make_room(solution_, reduced_size_);
  solution_.head(reduced_size_).setZero();
  const Eigen::Index velocities = problem_->layout().joints();
  solution_.head(velocities) = -momentum_.head(velocities);
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    const StepBlock<Dim>& block = joints_[j].block;
    for (Eigen::Index r = block.own; r < block.size; ++r)
      solution_[joints_[j].place[static_cast<std::size_t>(r)]] = -block.f[r];
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) contacts_[i].add_right_side(solution_);
  reduced_.solve(solution_);
}

/// Step in z from the solution of the reduced system.
template <int Dim>
void CondensedSystem<Dim>::expand() {
  step_.head(problem_->size()).setZero();
  const Eigen::Index head = problem_->layout().joints();
  step_.head(head) = solution_.head(head);
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    const CondensedPart<Dim>& joint = joints_[j];
    const Eigen::Index column = problem_->joint_column(problem_->joints()[j]);
    for (Eigen::Index r = joint.block.own; r < joint.block.size; ++r)
      step_[column + r - joint.block.own] = solution_[joint.place[static_cast<std::size_t>(r)]];
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) contacts_[i].expand(solution_, step_);
}

template class CondensedSystem<2>;
template class CondensedSystem<3>;

}  // namespace touchstone
