#include "core/complementarity/merit_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/complementarity/require.h"
#include "core/complementarity/sparse_problem.h"

namespace touchstone {

using Eigen::Index;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double stationary_gradient = 1e-8;  // relative to |H| |Phi|
constexpr double real_progress = 0.99;        // factor in the merit
constexpr int regularised_tries = 8;
constexpr double regularisation_growth = 10.0;

}  // namespace

void SearchOptions::validate() const {
  require::positive("SearchOptions.tolerance", tolerance);
  require::at_least("SearchOptions.max_iterations", max_iterations, 1);
  require::in_left_open("SearchOptions.armijo", armijo, 0.0, 0.5);
  require::in_left_open("SearchOptions.backtrack", backtrack, 0.0, 0.9);
  require::in_left_open("SearchOptions.min_step", min_step, 0.0, 1.0);
  require::in_closed("SearchOptions.memory", memory, 1, 16);
  require::in_left_open("SearchOptions.penalty", penalty, 0.0, 1.0);
  require::positive("SearchOptions.max_step", max_step);
  require::at_least("SearchOptions.patience", patience, 1);
  require::positive("SearchOptions.regularisation", regularisation);
  require::in_closed("SearchOptions.consistency", consistency, 0.0, 0.5);
}

MeritSearch::MeritSearch(const SearchOptions& options) : options_(options) { options_.validate(); }

void MeritSearch::resize(Index n) {
  const bool is_sparse = problem_->sparse() != nullptr;
  const Index rows = is_sparse ? 0 : n;  // of the dense matrices
  if (current_.z.size() == n && current_.is_sparse == is_sparse && current_.jacobian.rows() == rows) return;
  for (Iterate* point : {&current_, &trial_, &checkpoint_}) {
    point->is_sparse = is_sparse;
    point->z.resize(n);
    point->f.resize(n);
    point->phi.resize(n);
    point->jacobian.resize(rows, rows);
  }
  normal_equations_.reserve(rows);
  for (Eigen::VectorXd* v : {&step_, &best_z_}) v->resize(n);
}

bool MeritSearch::start(const MixedComplementarityProblem& problem, const Eigen::VectorXd& z) {
  assert(z.size() == problem.size());
  problem_ = &problem;
  resize(problem.size());
  reformulation_.bind(problem.lower(), problem.upper(), options_.penalty);
  report_ = {};
  best_ = {infinity, -1};
  best_z_ = z;
  return restart(z);
}

bool MeritSearch::restart(const Eigen::VectorXd& z) {
  current_.z = z;
  evaluate(current_, true);
  report_.history.push(current_.residual.value);
  note_if_best();
  merits_[0] = current_.merit;
  merit_count_ = 1;
  milestone_ = current_.merit;
  idle_steps_ = 0;
  regularisation_ = options_.regularisation;
  stationary_ = false;
  return std::isfinite(current_.merit) && (converged() || current_.has_finite_jacobian());
}

// A start whose F is not finite is kept too, so that the report can name the row.
void MeritSearch::note_if_best() {
  if (current_.residual.value >= best_.value && best_.worst_row >= 0) return;
  best_ = current_.residual;
  best_z_ = current_.z;
}

void MeritSearch::evaluate(Iterate& point, bool with_jacobian) {
  if (with_jacobian && point.is_sparse) {
    problem_->sparse()->evaluate_sparse(point.z, point.f, &point.sparse_jacobian);
  } else {
    problem_->evaluate(point.z, point.f, with_jacobian ? &point.jacobian : nullptr);
  }
  ++report_.evaluations;
  report_.jacobian_evaluations += with_jacobian ? 1 : 0;
  point.has_jacobian = with_jacobian;
  point.residual = natural_residual(problem_->lower(), problem_->upper(), point.z, point.f);
  if (!std::isfinite(point.residual.value)) {
    point.merit = infinity;
    return;
  }
  reformulation_.evaluate(point.z, point.f, point.phi);
  point.merit = 0.5 * point.phi.squaredNorm();
}

double MeritSearch::longest_step(const Eigen::VectorXd& direction) const {
  if (direction.size() == 0) return 1.0;
  const double allowed = options_.max_step * (1.0 + current_.z.lpNorm<Eigen::Infinity>());
  const double length = direction.lpNorm<Eigen::Infinity>();
  return length <= allowed ? 1.0 : allowed / length;
}

void MeritSearch::try_step(const Eigen::VectorXd& direction, double alpha, bool project) {
  trial_.z = current_.z + alpha * direction;
  if (project) trial_.z = trial_.z.cwiseMax(problem_->lower()).cwiseMin(problem_->upper());
  // A full step squares the residual in the end: if that is still too much the Jacobian will be asked for
  // next, and comes cheaper with F than after it.
  const double now = current_.residual.value;
  evaluate(trial_, alpha == 1.0 && now * now > options_.tolerance);
}

bool MeritSearch::trial_is_usable() {
  if (!std::isfinite(trial_.merit)) return false;
  if (trial_.residual.value <= options_.tolerance) return true;
  if (!trial_.has_jacobian) evaluate(trial_, true);
  return trial_.has_finite_jacobian();
}

double MeritSearch::reference() const {
  const int kept = std::min(merit_count_, options_.memory);
  double largest = 0.0;
  for (int i = 1; i <= kept; ++i) {
    largest = std::max(largest, merits_[static_cast<std::size_t>((merit_count_ - i) % options_.memory)]);
  }
  return largest;
}

bool MeritSearch::trial_is_sufficient(double alpha, double slope) {
  if (trial_.residual.value <= options_.tolerance) return true;
  return trial_.merit <= reference() + options_.armijo * alpha * slope && trial_is_usable();
}

void MeritSearch::accept(bool tentative) {
  current_.swap(trial_);
  ++report_.iterations;
  report_.history.push(current_.residual.value);
  note_if_best();
  if (current_.merit < real_progress * milestone_) {
    milestone_ = current_.merit;
    idle_steps_ = 0;
  } else {
    ++idle_steps_;
  }
  if (tentative) return;
  merits_[static_cast<std::size_t>(merit_count_ % options_.memory)] = current_.merit;
  ++merit_count_;
}

bool MeritSearch::backtrack(const Eigen::VectorXd& direction, double slope, double first, bool project) {
  double alpha = first;
  while (alpha >= options_.min_step * first) {
    try_step(direction, alpha, project);
    if (trial_is_sufficient(alpha, slope)) {
      accept();
      return true;
    }
    alpha *= options_.backtrack;
  }
  return false;
}

bool MeritSearch::regularised_step() {
  normal_equations_.form(reformulation_, current_);
  const Eigen::VectorXd& gradient = normal_equations_.gradient();
  stationary_ =
      gradient.norm() <= stationary_gradient * normal_equations_.matrix_norm() * current_.phi.norm();
  if (stationary_) return false;
  const double scale = normal_equations_.largest_diagonal() * std::min(1.0, current_.phi.norm());
  for (int attempt = 0; attempt < regularised_tries; ++attempt) {
    const bool solved = normal_equations_.solve(regularisation_ * scale, step_);
    const double slope = solved ? gradient.dot(step_) : 0.0;
    if (slope < 0.0 && backtrack(step_, slope, longest_step(step_), false)) {
      regularisation_ = std::max(options_.regularisation * 1e-6, regularisation_ / regularisation_growth);
      return true;
    }
    regularisation_ *= regularisation_growth;
  }
  return false;
}

void MeritSearch::restore_checkpoint() { current_.swap(checkpoint_); }

SolveReport MeritSearch::finish(SolveStatus status, Eigen::VectorXd& z) {
  report_.status = status;
  if (status == SolveStatus::solved) {
    z = current_.z;
    best_ = current_.residual;
  } else {
    z = best_z_;
  }
  report_.residual = best_.value;
  report_.worst_row = best_.worst_row;
  return report_;
}

}  // namespace touchstone
