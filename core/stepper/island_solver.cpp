#include "core/stepper/island_solver.h"

#include <algorithm>
#include <array>

#include "core/contact/patch_middle.h"

namespace touchstone {

namespace {

/// Unknowns of the largest problem that is handed to the full problem's solvers, whose matrices are dense.
constexpr Eigen::Index kLargestDense = 3000;

/// Unknowns of the largest problem whose central path is followed: a second or so a path.
constexpr Eigen::Index kLargestPath = 600;
/// Where central paths begin, in this order, and down to where they are followed: epsilon of SmoothedStep.
constexpr std::array kPathStarts = {0.1, 0.03, 0.01, 0.3, 1.0};
constexpr std::array kPathEnds = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

/// Unknowns of the largest problem that path-following Newton is left with after central paths: above, it may
/// pivot for minutes.
constexpr Eigen::Index kLargestPivoted = 100;

/// Residual that is accepted of a step that nothing brings below kAcceptable: a tenth of what answers are
/// certified at.
constexpr double kLastAcceptable = 1e-11;

SearchOptions search_options(const ImplicitOptions& options) {
  SearchOptions search;
  search.tolerance = options.tolerance;
  search.max_iterations = options.max_iterations;
  return search;
}

PathNewtonOptions path_options(const ImplicitOptions& options) {
  PathNewtonOptions path;
  path.search = search_options(options);
  return path;
}

SemismoothNewtonOptions semismooth_options(const ImplicitOptions& options) {
  SemismoothNewtonOptions semismooth;
  semismooth.search = search_options(options);
  return semismooth;
}

/// A search that ended, for whatever reason, so near to a solution that rounding is what is left.
void accept_rounding(SolveReport& report) {
  if (report.residual <= ImplicitOptions::kAcceptable) report.status = SolveStatus::solved;
}

}  // namespace

template <int Dim>
IslandSolver<Dim>::IslandSolver(const ImplicitOptions& options)
    : options_(options),
      condensed_({options.tolerance, options.max_iterations, ImplicitOptions::kAcceptable}),
      path_(path_options(options)),
      semismooth_(semismooth_options(options)) {}

template <int Dim>
SolveReport IslandSolver<Dim>::solve(StepProblem<Dim>& problem, const Start& start, Eigen::VectorXd& z,
                                     const GivesWay& gives_way) {
  problem_ = &problem;
  jammed_ = false;
  SolveReport report = options_.solver == Solver::condensed
                           ? solve_condensed(start, z, gives_way)
                           : solve_full_problem(options_.solver, true, start, z);
  if (report.solved() && report.residual > options_.tolerance && !problem.contacts().empty()) {
    const int iterations = report.iterations;
    report = condensed_.settle(problem, z);
    if (report.residual > kLastAcceptable) {
      report = condensed_.relieve(problem, z);
      accept_rounding(report);
    }
    report.iterations += iterations;
  }
  if (report.solved() && choose_frames()) report = solve_again(z);
  return report;
}

/// Elimination from the warm start; where that fails, searches from central paths; then the full problem's
/// solvers.
template <int Dim>
SolveReport IslandSolver<Dim>::solve_condensed(const Start& start, Eigen::VectorXd& z,
                                               const GivesWay& gives_way) {
  start(z);
  SolveReport report = condensed_.solve(*problem_, z);
  accept_rounding(report);
  if (report.solved() || gives_way() || problem_->size() > kLargestDense) return report;
  ++fallbacks_;
  int iterations = report.iterations;
  const bool follows_paths = !problem_->contacts().empty() && problem_->size() <= kLargestPath;
  if (follows_paths) {
    report = follow_central_paths(z);
    report.iterations += iterations;
    if (report.solved() || jammed_) return report;
    iterations = report.iterations;
  }
  const bool pivots = !follows_paths || problem_->size() <= kLargestPivoted;
  report = solve_full_problem(Solver::semismooth, pivots, start, z);
  report.iterations += iterations;
  return report;
}

/// Newton's method from points of central paths, ever farther down, and at last, from the end of each, the
/// full problem's.
template <int Dim>
SolveReport IslandSolver<Dim>::follow_central_paths(Eigen::VectorXd& z) {
  using State = typename CentralPath<Dim>::State;
  SolveReport best;
  best_z_ = z.head(problem_->size());
  int iterations = 0;
  bool unbounded = false;
  bool arrived = false;
  const auto finish = [&](auto&& solver) {
    const SolveReport report = solver();
    iterations += report.iterations;
    if (report.residual < best.residual) {
      best = report;
      best_z_ = z.head(problem_->size());
    }
    accept_rounding(best);
    return best.solved();
  };
  const auto walk = [&](double start) {
    central_path_.begin(*problem_, start);
    State state = State::arrived;
    for (const double end : kPathEnds) {
      if (state != State::arrived) break;
      const int before = central_path_.factorisations();
      state = central_path_.follow_to(end);
      iterations += central_path_.factorisations() - before;
      for (const bool closed : {true, false}) {
        central_path_.estimate(z, closed);
        if (finish([&] { return condensed_.finish(*problem_, z); })) return true;
      }
    }
    unbounded = unbounded || state == State::unbounded;
    arrived = arrived || state == State::arrived;
    if (state == State::unbounded) return false;
    central_path_.estimate(z, false);
    return finish([&] { return run_solver(Solver::semismooth, z); });
  };
  const bool solved = std::any_of(kPathStarts.begin(), kPathStarts.end(), walk);
  z.head(problem_->size()) = best_z_;
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) problem_->evaluate_state(i, z);
  if (!solved && best.residual <= kLastAcceptable) best.status = SolveStatus::solved;
  jammed_ = !best.solved() && unbounded && !arrived;
  best.iterations = iterations;
  return best;
}

/// Each of the full problem's solvers from the warm start; then from cold, where closest points are those of
/// the predicted pose; then from the middle of the patches in which bodies lie flat on each other, because a
/// box that is about to tip may be out of reach from a corner of its base.
/// @param pivots  whether the other solver is tried too
template <int Dim>
SolveReport IslandSolver<Dim>::solve_full_problem(Solver first, bool pivots, const Start& start,
                                                  Eigen::VectorXd& z) {
  const Solver other = first == Solver::path ? Solver::semismooth : Solver::path;
  SolveReport report;
  int iterations = 0;
  const auto attempt = [&](Solver solver) {
    report = run_solver(solver, z);
    iterations += report.iterations;
  };
  for (const Solver solver : {first, other}) {
    start(z);
    attempt(solver);
    for (const FindClosest<Dim> find : {&closest_points<Dim>, &patch_middle<Dim>}) {
      if (report.solved()) break;
      start_cold(find, z);
      attempt(solver);
    }
    if (report.solved() || !pivots) break;
  }
  report.iterations = iterations;
  return report;
}

template <int Dim>
SolveReport IslandSolver<Dim>::run_solver(Solver solver, Eigen::VectorXd& z) {
  exact_z_ = z.head(problem_->size());
  SolveReport report =
      solver == Solver::path ? path_.solve(*problem_, exact_z_) : semismooth_.solve(*problem_, exact_z_);
  z.head(problem_->size()) = exact_z_;
  accept_rounding(report);
  for (std::size_t i = 0; i < problem_->contacts().size() && report.solved(); ++i) {
    problem_->evaluate_state(i, z);
    if (!problem_->is_spurious(i)) continue;
    report.status = SolveStatus::local_minimum;
    report.residual = StepProblem<Dim>::kSpuriousResidual;
  }
  return report;
}

template <int Dim>
void IslandSolver<Dim>::start_cold(FindClosest<Dim> find, Eigen::VectorXd& z) {
  z.head(problem_->size()).setZero();
  problem_->free_velocity(z);
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) problem_->find_points(i, z, find);
}

/// The direction that t is the projection of is chosen before a step is solved, for the normal expected then.
/// Where friction is not the same in all directions and the normal came out so that the law's own direction
/// serves, that one is to be it.
/// @return  whether one changed
template <int Dim>
bool IslandSolver<Dim>::choose_frames() {
  constexpr double kLeastSine = 0.2;  // well above that at which usable_reference() gives up the law's own
  bool changed = false;
  if constexpr (Dim == 3) {
    for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
      const ContactLaw<Dim>& law = problem_->contacts()[i].law;
      const Vector<Dim> direction = law.tangent.normalized();
      if (law.e_t == law.e_o || problem_->prepared(i).reference == direction) continue;
      const Vector<Dim> normal = problem_->impulse(i).normal;
      if (normal.cross(direction).norm() < kLeastSine) continue;
      problem_->set_normal_estimate(i, normal);
      changed = true;
    }
  }
  return changed;
}

/// From the last solution, in other frames.
template <int Dim>
SolveReport IslandSolver<Dim>::solve_again(Eigen::VectorXd& z) {
  constexpr int kTries = 5;  // of frames that may have to be chosen once more
  SolveReport report;
  int tries = 0;
  do {
    report = condensed_.finish(*problem_, z);
    accept_rounding(report);
  } while (report.solved() && ++tries < kTries && choose_frames());
  return report;
}

template class IslandSolver<2>;
template class IslandSolver<3>;

}  // namespace touchstone
