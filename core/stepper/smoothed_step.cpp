#include "core/stepper/smoothed_step.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/contact/patch_middle.h"

namespace touchstone {

namespace {

/// a + b - sqrt(a^2 + b^2 + 2 epsilon^2), zero exactly where a, b > 0 and a b = epsilon^2.
struct SmoothedPair {
  SmoothedPair(double a, double b, double epsilon) {
    const double square = 2 * epsilon * epsilon;
    const double root = std::sqrt(a * a + b * b + square);
    // For a + b > 0 the difference cancels; this is the same without.
    value = a + b > 0 ? (2 * a * b - square) / (a + b + root) : a + b - root;
    by_a = 1 - a / root;
    by_b = 1 - b / root;
    by_log_epsilon = -square / root;
  }
  double value, by_a, by_b, by_log_epsilon;
};

/// Of an inequality whose multiplier is not positive at the start, over epsilon.
constexpr double kLeastMultiplier = 1e-3;

}  // namespace

template <int Dim>
void SmoothedStep<Dim>::begin(StepProblem<Dim>& problem, double epsilon) {
  problem_ = &problem;
  epsilon_ = epsilon;
  gap_weight_ = problem.scale().length / (problem.step_size() * problem.scale().velocity);
  list_pairs();
  offset_.setZero(size());
  find_start();
  // Equations keep what they miss at the start; pairs meet theirs by their shift.
  static_cast<void>(evaluate(start_, 0.0));
  offset_ = rows_;
}

template <int Dim>
void SmoothedStep<Dim>::list_pairs() {
  const Scale& scale = problem_->scale();
  const Eigen::Index n = size();
  pairs_.clear();
  dropped_.clear();
  is_impulse_.assign(static_cast<std::size_t>(n), false);
  unit_.setOnes(n);
  for (int b = 0; b < problem_->moving_bodies(); ++b) {
    const Eigen::Index at = problem_->layout().velocity(b);
    unit_.template segment<Dim>(at).setConstant(scale.velocity);
    unit_.template segment<Dimension<Dim>::angular>(at + Dim).setConstant(scale.velocity / scale.length);
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    const ContactPair<Dim>& contact = problem_->contacts()[i];
    const ContactLayout& at = problem_->layout().contact(i);
    unit_.segment(at.point_1, at.friction - at.point_1).setConstant(scale.length);
    is_impulse_[static_cast<std::size_t>(at.normal)] = true;
    pairs_.push_back({.row = at.normal, .weight = gap_weight_});
    if (contact.law.mu > 0) {
      pairs_.push_back({.row = at.slip, .slip_of = static_cast<int>(i)});
    } else {
      dropped_.push_back(at.slip);
    }
    for (int l = 0; l < contact.side_1.multipliers(); ++l) pairs_.push_back({.row = at.multipliers_1 + l});
    for (int l = 0; l < contact.side_2.multipliers(); ++l) pairs_.push_back({.row = at.multipliers_2 + l});
  }
}

/// Bodies at rest where the step starts, closest points of the rounded shapes, no friction, and impulses that
/// fit the gaps.
template <int Dim>
void SmoothedStep<Dim>::find_start() {
  start_.setZero(size());
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    const ContactLayout& at = problem_->layout().contact(i);
    const double mu = problem_->contacts()[i].law.mu;
    find_points(i);
    problem_->evaluate_state(i, start_);
    const double gap = gap_weight_ * problem_->separation(i) / problem_->scale().length;
    const double p = epsilon_ * epsilon_ / std::max(gap, epsilon_);
    start_[at.normal] = p;
    start_[at.slip] = mu > 0 ? epsilon_ * epsilon_ / (mu * p) : 1.0;
  }
  rows_.resize(size());
  problem_->set_form(FrictionForm::fritz_john);
  problem_->evaluate(start_, rows_, nullptr);
  problem_->set_form(FrictionForm::projection);
  for (Pair& pair : pairs_) {
    if (pair.slip_of >= 0) continue;
    double& a = start_[pair.row];
    if (!(a > 0)) a = kLeastMultiplier * epsilon_;
    pair.shift = epsilon_ * epsilon_ / a - pair.weight * rows_[pair.row];
  }
}

/// Newton's method with a line search on the rows of one contact's points and multipliers, poses given. What
/// it leaves over the shifts and offsets take.
template <int Dim>
void SmoothedStep<Dim>::find_points(std::size_t contact) {
  constexpr int kSteps = 60;
  constexpr double kSolved = 1e-24;
  constexpr double kShortest = 1e-6;
  problem_->find_points(contact, start_, &patch_middle<Dim>);
  const ContactLayout& in_z = problem_->layout().contact(contact);
  std::vector<Eigen::Index> own;
  std::vector<Eigen::Index> in_start;
  Eigen::VectorXd value;
  Eigen::MatrixXd by_own;
  const auto merit = [&](bool derivatives) {
    problem_->evaluate_state(contact, start_);
    problem_->contact_block(contact, derivatives, block_);
    own.clear();
    in_start.clear();
    const auto add = [&](Eigen::Index begin, Eigen::Index end, Eigen::Index first) {
      for (Eigen::Index r = begin; r < end; ++r) {
        own.push_back(r);
        in_start.push_back(first + r - begin);
      }
    };
    add(block_.own, block_.at.friction, in_z.point_1);
    add(block_.at.multipliers_1, block_.size, in_z.multipliers_1);
    value = block_.f(own);
    if (derivatives) by_own = block_.j(own, own);
    for (Eigen::Index r = block_.at.friction - block_.own; r < value.size(); ++r) {
      const SmoothedPair pair(start_[in_start[static_cast<std::size_t>(r)]], value[r], epsilon_);
      value[r] = pair.value;
      if (!derivatives) continue;
      by_own.row(r) *= pair.by_b;
      by_own(r, r) += pair.by_a;
    }
    return value.squaredNorm();
  };
  for (int k = 0; k < kSteps; ++k) {
    const double before = merit(true);
    if (before <= kSolved) return;
    const Eigen::VectorXd step = -by_own.partialPivLu().solve(value);
    if (!step.allFinite()) return;
    const Eigen::VectorXd last = start_(in_start);
    const double length = step.cwiseQuotient(unit_(in_start)).cwiseAbs().maxCoeff();
    double t = 1 / std::max(1.0, length);
    do {
      start_(in_start) = last + t * step;
      t /= 2;
    } while (!(merit(false) < before) && t > kShortest);
    if (t <= kShortest) {
      start_(in_start) = last;
      return;
    }
  }
}

template <int Dim>
bool SmoothedStep<Dim>::evaluate(const Eigen::VectorXd& z, double tau) {
  return compute(z, tau, false);
}

template <int Dim>
bool SmoothedStep<Dim>::differentiate(const Eigen::VectorXd& z, double tau) {
  return compute(z, tau, true);
}

template <int Dim>
bool SmoothedStep<Dim>::compute(const Eigen::VectorXd& z, double tau, bool derivatives) {
  const double eps = epsilon(tau);
  const double fade = std::exp(2 * tau);
  rows_.resize(size());
  if (derivatives) by_z_.resize(size(), size());
  problem_->set_form(FrictionForm::fritz_john);
  problem_->evaluate(z, rows_, derivatives ? &by_z_ : nullptr);
  problem_->set_form(FrictionForm::projection);
  if (derivatives) by_tau_.setZero(size());
  for (const Eigen::Index row : dropped_) {
    rows_[row] = z[row] - 1;
    if (!derivatives) continue;
    by_z_.row(row).setZero();
    by_z_(row, row) = 1;
  }
  for (const Pair& pair : pairs_) {
    double weight = pair.weight;
    double b = weight * rows_[pair.row];
    if (pair.slip_of >= 0) {  // (mu^2 p^2 - |y|^2) / (mu p)
      const auto contact = static_cast<std::size_t>(pair.slip_of);
      const Eigen::Index normal = problem_->layout().contact(contact).normal;
      const double p = z[normal];
      if (!(p > 0)) return false;
      weight = 1 / (problem_->contacts()[contact].law.mu * p);
      b = weight * rows_[pair.row];
      if (derivatives) by_z_(pair.row, normal) -= rows_[pair.row] / p;
    }
    const SmoothedPair smoothed(z[pair.row], b + fade * pair.shift, eps);
    rows_[pair.row] = smoothed.value;
    if (!derivatives) continue;
    by_z_.row(pair.row) *= weight * smoothed.by_b;
    by_z_(pair.row, pair.row) += smoothed.by_a;
    by_tau_[pair.row] = smoothed.by_log_epsilon + 2 * fade * pair.shift * smoothed.by_b;
  }
  rows_ -= fade * offset_;
  if (derivatives) by_tau_ -= 2 * fade * offset_;
  return rows_.allFinite();
}

template <int Dim>
void SmoothedStep<Dim>::close(Eigen::VectorXd& z) const {
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    const ContactLayout& at = problem_->layout().contact(i);
    problem_->evaluate_state(i, z);
    if (z[at.normal] > gap_weight_ * problem_->separation(i) / problem_->scale().length) continue;
    z.template segment<Dimension<Dim>::friction>(at.friction).setZero();
    z[at.normal] = 0;
    problem_->find_points(i, z);
  }
}

template class SmoothedStep<2>;
template class SmoothedStep<3>;

}  // namespace touchstone
