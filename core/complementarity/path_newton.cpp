#include "core/complementarity/path_newton.h"

#include "core/complementarity/require.h"
#include "core/complementarity/sparse_columns.h"

namespace touchstone {

void PathNewtonOptions::validate() const {
  search.validate();
  linear.validate();
  require::in_closed("PathNewtonOptions.crash_steps", crash_steps, 0, 100);
  require::in_closed("PathNewtonOptions.watchdog", watchdog, 0, 16);
}

PathNewton::PathNewton(const PathNewtonOptions& options)
    : options_(options), search_(options.search), path_(options.linear) {
  options_.validate();
}

SolveReport PathNewton::solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) {
  z = z.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  tentative_steps_ = 0;
  checkpoint_direction_.resize(z.size());
  if (options_.linear.max_pivots == 0) path_.limit_pivots(100 + static_cast<int>(z.size() / 2));
  if (!search_.start(problem, z)) return search_.finish(SolveStatus::non_finite, z);
  crash_.run(problem, options_.crash_steps, search_);
  while (!search_.converged()) {
    if (search_.report().iterations >= options_.search.max_iterations) {
      return search_.finish(SolveStatus::iteration_limit, z);
    }
    if (search_.out_of_patience()) return search_.finish(SolveStatus::stalled, z);
    const LinearPathResult linear = newton_point(problem);
    if (linear.solved() ? search_along_step() : search_from_checkpoint()) continue;
    if (search_.regularised_step()) continue;
    return search_.finish(failure(linear), z);
  }
  return search_.finish(SolveStatus::solved, z);
}

LinearPathResult PathNewton::newton_point(const MixedComplementarityProblem& problem) {
  const Iterate& at = search_.current();
  return at.is_sparse ? newton_point(problem, SparseColumns(at.sparse_jacobian))
                      : newton_point(problem, at.jacobian);
}

template <typename Matrix>
LinearPathResult PathNewton::newton_point(const MixedComplementarityProblem& problem,
                                          const Matrix& jacobian) {
  const Iterate& at = search_.current();
  newton_point_ = at.z.cwiseMax(problem.lower()).cwiseMin(problem.upper());
  const double misfit = options_.search.consistency * at.residual.value;
  LinearPathResult linear =
      path_.follow(jacobian, at.f, problem.lower(), problem.upper(), misfit, newton_point_);
  search_.report().pivots += linear.pivots;
  if (!linear.solved() && options_.lemke) {
    linear = path_.lemke(jacobian, at.f, problem.lower(), problem.upper(), at.z, newton_point_);
    search_.report().pivots += linear.pivots;
  }
  direction_ = newton_point_ - at.z;
  return linear;
}

// Full steps are taken for a while even without decrease; if none came the search goes back to where they
// began and looks along the step from there.
bool PathNewton::search_along_step() {
  const double full = search_.longest_step(direction_);
  search_.try_step(direction_, full, false);
  if (search_.trial_is_sufficient(full, slope())) {
    search_.accept();
    tentative_steps_ = 0;
    return true;
  }
  if (tentative_steps_ < options_.watchdog && search_.trial_is_usable()) {
    if (tentative_steps_ == 0) {
      search_.save_checkpoint();
      checkpoint_direction_ = direction_;
    }
    ++tentative_steps_;
    search_.accept(/*tentative=*/true);
    return true;
  }
  if (tentative_steps_ > 0) return search_from_checkpoint();
  return search_.backtrack(direction_, slope(), full * options_.search.backtrack, false);
}

bool PathNewton::search_from_checkpoint() {
  if (tentative_steps_ == 0) return false;
  tentative_steps_ = 0;
  search_.restore_checkpoint();
  const double full = search_.longest_step(checkpoint_direction_);
  return search_.backtrack(checkpoint_direction_, slope(), full * options_.search.backtrack, false);
}

// The slope that the merit 1/2 |Phi|^2 would have along a Newton direction for Phi itself: what a step is
// measured by.
double PathNewton::slope() const { return -2.0 * search_.current().merit; }

SolveStatus PathNewton::failure(const LinearPathResult& linear) const {
  if (search_.merit_is_stationary()) return SolveStatus::local_minimum;
  switch (linear.status) {
    case LinearPathStatus::ray:
      return SolveStatus::ray_termination;
    case LinearPathStatus::pivot_limit:
      return SolveStatus::pivot_limit;
    case LinearPathStatus::singular_basis:
      return SolveStatus::singular_jacobian;
    case LinearPathStatus::solved:
      break;
  }
  return SolveStatus::stalled;
}

}  // namespace touchstone
