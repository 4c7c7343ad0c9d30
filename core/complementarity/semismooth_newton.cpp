#include "core/complementarity/semismooth_newton.h"

namespace touchstone {

using Eigen::Index;

namespace {

constexpr double singular_pivot = 1e-12;  // relative to the column, or to the largest pivot

}  // namespace

void SemismoothNewtonOptions::validate() const { search.validate(); }

SemismoothNewton::SemismoothNewton(const SemismoothNewtonOptions& options)
    : options_(options), search_(options.search) {}

SolveReport SemismoothNewton::solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) {
  if (!search_.start(problem, z)) return search_.finish(SolveStatus::non_finite, z);
  direction_.resize(z.size());
  misfit_.resize(z.size());
  SolveStatus status = search(options_.project);
  if (status != SolveStatus::solved && options_.second_search && search_.restart(z))
    status = search(!options_.project);
  return search_.finish(status, z);
}

SolveStatus SemismoothNewton::search(bool project) {
  const int last_iteration = search_.report().iterations + options_.search.max_iterations;
  while (!search_.converged()) {
    if (search_.report().iterations >= last_iteration) return SolveStatus::iteration_limit;
    if (search_.out_of_patience()) return SolveStatus::stalled;
    const bool regular = newton_direction();
    // Along a Newton direction the merit 1/2 |Phi|^2 has the slope Phi^T H d = -|Phi|^2.
    const double slope = -2.0 * search_.current().merit;
    if (regular && search_.backtrack(direction_, slope, search_.longest_step(direction_), project)) continue;
    if (search_.regularised_step()) continue;
    if (search_.merit_is_stationary()) return SolveStatus::local_minimum;
    return regular ? SolveStatus::stalled : SolveStatus::singular_jacobian;
  }
  return SolveStatus::solved;
}

void SemismoothNewton::fill_newton_matrix() {
  const Iterate& at = search_.current();
  search_.reformulation().jacobian(at.z, at.f, at.jacobian, lu_.matrix(at.z.size()));
}

bool SemismoothNewton::newton_direction() {
  if (search_.current().is_sparse) return sparse_newton_direction();
  fill_newton_matrix();
  if (!lu_.factor(singular_pivot)) return least_norm_direction();
  direction_ = -search_.current().phi;
  lu_.solve(direction_.data());
  return direction_.allFinite();
}

bool SemismoothNewton::sparse_newton_direction() {
  const Iterate& at = search_.current();
  search_.reformulation().jacobian(at.z, at.f, at.sparse_jacobian, sparse_matrix_);
  sparse_lu_.compute(sparse_matrix_);
  if (sparse_lu_.info() != Eigen::Success) return false;
  misfit_ = -at.phi;
  direction_ = sparse_lu_.solve(misfit_);
  if (!direction_.allFinite()) return false;
  misfit_ -= sparse_matrix_ * direction_;  // a matrix that is singular but for rounding shows here
  return misfit_.norm() <= options_.search.consistency * at.phi.norm();
}

// The shortest solution of H d = -Phi, if there is one up to what linearisation hides.
bool SemismoothNewton::least_norm_direction() {
  fill_newton_matrix();
  [[maybe_unused]] const Index rank = lu_.factor_rank_revealing(singular_pivot);
  misfit_ = -search_.current().phi;
  lu_.solve_least_norm(misfit_.data(), direction_.data());
  if (!direction_.allFinite()) return false;
  fill_newton_matrix();
  misfit_ = search_.current().phi;
  misfit_.noalias() += lu_.matrix(misfit_.size()) * direction_;
  return misfit_.norm() <= options_.search.consistency * search_.current().phi.norm();
}

}  // namespace touchstone
