#include "core/stepper/condensed_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/stepper/fischer_burmeister.h"
#include "core/stepper/make_room.h"

namespace touchstone {

template <int Dim>
void CondensedContact<Dim>::bind(StepProblem<Dim>& problem, std::size_t i) {
  problem_ = &problem;
  i_ = i;
  // A gap that a step could close, as a velocity: what p_n, an impulse over mass, is compared with.
  gap_weight_ = problem.scale().length / (problem.step_size() * problem.scale().velocity);
  const ContactPair<Dim>& pair = problem.contacts()[i];
  const int multipliers = pair.side_1.multipliers() + pair.side_2.multipliers();
  const int points = pair.side_1.point_unknowns() + pair.side_2.point_unknowns() + multipliers;
  const auto count = static_cast<std::size_t>(points);
  by_motion_ = false;
  active_.reserve(static_cast<std::size_t>(multipliers));
  eliminated_.reserve(count);
  response_.reserve(count * 2 * kVelocity);
  for (Eigen::VectorXd* vector : {&offset_, &column_, &scratch_}) make_room(*vector, points);
  static_cast<void>(lu_.matrix(points));
  for (auto* list : {&part_.kept, &part_.place}) list->reserve(2 * kVelocity + kImpulses + count);
}

template <int Dim>
void CondensedContact<Dim>::evaluate(const CondensedForm& form, Eigen::VectorXd& z, ResidualAndMerit& total) {
  problem_->evaluate_state(i_, z);
  problem_->contact_block(i_, false, part_.block);
  const ContactLayout& in_z = problem_->layout().contact(i_);
  const StepBlock<Dim>& block = part_.block;
  z[in_z.slip] -= block.f[block.at.slip];  // sigma = |w|
  const auto take = [&](double value, Eigen::Index row) {
    total.account(value, row);
    total.merit += value * value;
  };
  geometry_residual_ = 0;
  const auto take_geometry = [&](double value, Eigen::Index row) {
    take(value, row);
    if (!(std::abs(value) <= geometry_residual_)) geometry_residual_ = std::abs(value);
  };
  for (Eigen::Index r = block.own; r < block.at.friction; ++r)
    take_geometry(block.f[r], in_z.point_1 + r - block.own);
  for (Eigen::Index r = block.at.friction; r < block.at.normal; ++r)
    take(block.f[r], in_z.point_1 + r - block.own);
  if (problem_->is_spurious(i_)) take_geometry(StepProblem<Dim>::kSpuriousResidual, in_z.point_1);
  const double p = z[in_z.normal];
  const double gap = block.f[block.at.normal];
  total.account(std::min(p, gap), in_z.normal);
  const auto term = [&form](double unknown, double row) {
    const double value = form.fischer_burmeister ? FischerBurmeisterTerm(unknown, row, form.smoothing).value
                                                 : std::min(unknown, row);
    return value * value;
  };
  total.merit += term(p, gap_weight_ * gap);
  for (Eigen::Index r = block.at.multipliers_1; r < block.size; ++r) {
    const Eigen::Index row = in_z.multipliers_1 + r - block.at.multipliers_1;
    const double least = std::min(z[row], block.f[r]);
    total.account(least, row);
    if (!(std::abs(least) <= geometry_residual_)) geometry_residual_ = std::abs(least);
    total.merit += form.multipliers_by_active_set() ? least * least : term(z[row], block.f[r]);
  }
}

/// Active set of the minimum function.
template <int Dim>
void CondensedContact<Dim>::choose_rows(const CondensedForm& form, const Eigen::VectorXd& z) {
  const ContactLayout& in_z = problem_->layout().contact(i_);
  const StepBlock<Dim>& block = part_.block;
  const double p = z[in_z.normal];
  touching_ = p > gap_weight_ * block.f[block.at.normal];
  // Without load and open a contact acts on nothing: its impulse is 0 and stays 0.
  loaded_ = form.smoothing > 0 || touching_ || p != 0 ||
            z.template segment<kFriction>(in_z.friction).squaredNorm() != 0;
  active_.resize(static_cast<std::size_t>(block.size - block.at.multipliers_1));
  for (std::size_t l = 0; l < active_.size(); ++l) {
    const auto offset = static_cast<Eigen::Index>(l);
    active_[l] = z[in_z.multipliers_1 + offset] > block.f[block.at.multipliers_1 + offset];
  }
}

/// The block with the rows that stand: z_i = 0 in place of those that do not.
template <int Dim>
void CondensedContact<Dim>::set_rows(const CondensedForm& form, const Eigen::VectorXd& z, bool derivatives) {
  const ContactLayout& in_z = problem_->layout().contact(i_);
  StepBlock<Dim>& block = part_.block;
  const auto replace = [&](Eigen::Index row, double value) {
    block.f[row] = value;
    if (!derivatives) return;
    if (by_motion_) motions_.scale_row(row, 0.0);
    block.j.row(row).head(block.size).setZero();
    block.j(row, row) = 1;
  };
  if (form.fischer_burmeister) {
    const auto combine = [&](Eigen::Index row, double unknown, double weight) {
      const FischerBurmeisterTerm term(unknown, weight * block.f[row], form.smoothing);
      block.f[row] = term.value;
      if (!derivatives) return;
      if (by_motion_) motions_.scale_row(row, weight * term.by_row);
      block.j.row(row).head(block.size) *= weight * term.by_row;
      block.j(row, row) += term.by_unknown;
    };
    combine(block.at.normal, z[in_z.normal], gap_weight_);
    if (!form.multipliers_by_active_set()) {
      for (Eigen::Index r = block.at.multipliers_1; r < block.size; ++r)
        combine(r, z[in_z.multipliers_1 + r - block.at.multipliers_1], 1.0);
      return;
    }
  } else if (!touching_) {
    replace(block.at.normal, z[in_z.normal]);
  }
  for (std::size_t l = 0; l < active_.size(); ++l) {
    const auto offset = static_cast<Eigen::Index>(l);
    if (!active_[l]) replace(block.at.multipliers_1 + offset, z[in_z.multipliers_1 + offset]);
  }
}

template <int Dim>
void CondensedContact<Dim>::condense(const CondensedForm& form, double hold, const Eigen::VectorXd& z,
                                     Eigen::Index& reduced_size) {
  choose_rows(form, z);
  const ContactPair<Dim>& pair = problem_->contacts()[i_];
  by_motion_ = PointElimination<Dim>::applies_to(pair);
  if (by_motion_) {
    problem_->contact_block_by_motion(i_, part_.block, motions_);
    by_motion_ = points_.factor(pair, problem_->state(i_), problem_->scale().length, problem_->step_size());
  }
  if (by_motion_) {
    set_rows(form, z, true);
    add_hold(hold);
    list_kept(reduced_size);
    keeps_points_ = false;
    add_motions();
    return;
  }
  problem_->contact_block(i_, true, part_.block);
  set_rows(form, z, true);
  add_hold(hold);
  list_points();
  list_kept(reduced_size);
  factor_points(reduced_size);
  if (keeps_points_) return;
  find_response();
  subtract_response();
}

template <int Dim>
void CondensedContact<Dim>::add_hold(double hold) {
  StepBlock<Dim>& block = part_.block;
  if (hold == 0) return;
  for (Eigen::Index r = block.at.friction; r <= block.at.normal; ++r) block.j(r, r) += hold;
}

template <int Dim>
void CondensedContact<Dim>::add_motions() {
  if (part_.block.own == kVelocity) {
    motions_.template add_motions<kVelocity>(points_.template motions<kVelocity>(), points_.normal_turns());
  } else {
    motions_.template add_motions<2 * kVelocity>(points_.template motions<2 * kVelocity>(),
                                                 points_.normal_turns());
  }
}

template <int Dim>
void CondensedContact<Dim>::list_points() {
  const StepBlock<Dim>& block = part_.block;
  eliminated_.clear();
  for (Eigen::Index c = block.own; c < block.at.friction; ++c) eliminated_.push_back(c);
  for (Eigen::Index c = block.at.multipliers_1; c < block.size; ++c) eliminated_.push_back(c);
}

template <int Dim>
void CondensedContact<Dim>::list_kept(Eigen::Index& reduced_size) {
  const StepBlock<Dim>& block = part_.block;
  part_.list_velocities();
  if (loaded_) {
    for (Eigen::Index c = block.at.friction; c <= block.at.normal; ++c) part_.keep(c, reduced_size);
  }
}

template <int Dim>
void CondensedContact<Dim>::add_right_side(Eigen::VectorXd& right_side) {
  const StepBlock<Dim>& block = part_.block;
  const std::vector<Eigen::Index>& kept = part_.kept;
  for (std::size_t m = 0; m < kept.size(); ++m) {
    if (kept[m] >= block.own) right_side[part_.place[m]] -= block.f[kept[m]];
  }
  if (keeps_points_) return;
  if (by_motion_) {
    rest_ = points_.motion_of(block.f.data() + block.own);
    const typename MotionJacobian<Dim>::Rows effect = motions_.effect(rest_);
    for (std::size_t m = 0; m < kept.size(); ++m)
      right_side[part_.place[m]] += effect[static_cast<Eigen::Index>(m)];
    return;
  }
  const std::size_t e = eliminated_.size();
  for (std::size_t r = 0; r < e; ++r) offset_[static_cast<Eigen::Index>(r)] = block.f[eliminated_[r]];
  solve_points(offset_.data());
  for (std::size_t m = 0; m < kept.size(); ++m) {
    double sum = 0;
    for (std::size_t r = 0; r < e; ++r)
      sum += block.j(kept[m], eliminated_[r]) * offset_[static_cast<Eigen::Index>(r)];
    right_side[part_.place[m]] += sum;
  }
}

template <int Dim>
void CondensedContact<Dim>::expand(const Eigen::VectorXd& solution, Eigen::VectorXd& step) const {
  const StepBlock<Dim>& block = part_.block;
  for (std::size_t m = 0; m < part_.kept.size(); ++m) {
    if (part_.kept[m] >= block.own) step[column_in_z(part_.kept[m])] = solution[part_.place[m]];
  }
  if (keeps_points_) return;
  if (by_motion_) {
    std::array<double, 2 * kVelocity> velocities;
    for (std::size_t c = 0; c < static_cast<std::size_t>(block.own); ++c)
      velocities[c] = solution[part_.place[c]];
    points_.read_unknowns(-rest_, velocities.data(), step.data() + column_in_z(block.own));
    return;
  }
  for (std::size_t r = 0; r < eliminated_.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    double change = -offset_[row];
    const double* const response = response_.data() + row * block.own;
    for (std::size_t c = 0; c < static_cast<std::size_t>(block.own); ++c)
      change -= response[c] * solution[part_.place[c]];
    step[column_in_z(eliminated_[r])] = change;
  }
}

/// Column in z of one of the contact's own unknowns of its block.
template <int Dim>
Eigen::Index CondensedContact<Dim>::column_in_z(Eigen::Index unknown) const {
  const ContactLayout& in_z = problem_->layout().contact(i_);
  const ContactLayout& at = part_.block.at;
  if (unknown < at.normal) return in_z.point_1 + unknown - at.point_1;
  if (unknown == at.normal) return in_z.normal;
  return in_z.multipliers_1 + unknown - at.multipliers_1;
}

template class CondensedContact<2>;
template class CondensedContact<3>;

}  // namespace touchstone
