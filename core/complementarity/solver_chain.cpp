#include "core/complementarity/solver_chain.h"

#include <cmath>

#include "core/complementarity/require.h"

namespace touchstone {

using Eigen::Index;

namespace {

SolverKind other(SolverKind kind) {
  return kind == SolverKind::path_newton ? SolverKind::semismooth_newton : SolverKind::path_newton;
}

// SplitMix64 (Steele, Lea & Flood 2014), to a number in [-1, 1): the same on every platform.
double next_random(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t x = state;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  x ^= x >> 31U;
  return std::ldexp(static_cast<double>(x >> 11U), -52) - 1.0;
}

const SolverChainOptions& validated(const SolverChainOptions& options) {
  options.validate();
  return options;
}

PathNewtonOptions with_crash(PathNewtonOptions options, int steps) {
  options.crash_steps = steps;
  return options;
}

}  // namespace

void SolverChainOptions::validate() const {
  path.validate();
  semismooth.validate();
  require::at_least("SolverChainOptions.largest_pivoting", largest_pivoting, 0);
  require::in_closed("SolverChainOptions.crash_steps", crash_steps, 0, 100);
  require::in_closed("SolverChainOptions.proximal_steps", proximal_steps, 0, 16);
  require::positive("SolverChainOptions.proximal_weight", proximal_weight);
  require::in_closed("SolverChainOptions.restarts", restarts, 0, 64);
  require::positive("SolverChainOptions.perturbation", perturbation);
}

SolverChain::SolverChain(const SolverChainOptions& options)
    : options_(validated(options)),
      path_(options.path),
      crashing_path_(with_crash(options.path, options.crash_steps)),
      semismooth_(options.semismooth) {}

SolveReport SolverChain::solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) {
  problem_ = &problem;
  report_ = {};
  start_ = z;
  z_ = z;
  best_z_ = z;
  if (attempt(options_.first, StageStart::given) || fall_back()) {
    z = z_;
  } else {
    z = best_z_;
  }
  return report_;
}

bool SolverChain::fall_back() {
  random_state_ = options_.seed;
  z_ = start_;
  if (options_.second && attempt(other(options_.first), StageStart::given)) return true;
  if (options_.crash_steps > 0) {
    z_ = start_;
    if (attempt(SolverKind::path_newton, StageStart::crash)) return true;
  }
  if (options_.proximal_steps > 0) {
    walk_proximally();
    if (attempt(SolverKind::semismooth_newton, StageStart::proximal)) return true;
  }
  for (int restart = 0; restart < options_.restarts; ++restart) {
    perturb_start(restart);
    const bool alternate = options_.second && restart % 2 == 1;
    if (attempt(alternate ? other(options_.first) : options_.first, StageStart::perturbed)) return true;
  }
  return false;
}

// One solve of the problem itself from z_, entered in the report. Of failures the report keeps the one that
// came closest.
bool SolverChain::attempt(SolverKind solver, StageStart start) {
  if (solver == SolverKind::path_newton && !may_pivot()) {
    if (start == StageStart::crash) return false;
    solver = SolverKind::semismooth_newton;
  }
  const SolveReport stage = run(solver_for(solver, start), *problem_, z_);
  report_.stages.push({solver, start, stage.status, stage.iterations, stage.residual, 0.0});
  report_.history = stage.history;
  const bool better =
      report_.status == SolveStatus::not_run || stage.solved() || stage.residual < report_.residual;
  if (better) {
    report_.status = stage.status;
    report_.residual = stage.residual;
    report_.worst_row = stage.worst_row;
    best_z_ = z_;
  }
  return stage.solved();
}

bool SolverChain::may_pivot() const {
  return problem_->sparse() == nullptr || problem_->size() <= options_.largest_pivoting;
}

ComplementaritySolver& SolverChain::solver_for(SolverKind solver, StageStart start) {
  if (solver == SolverKind::semismooth_newton) return semismooth_;
  return start == StageStart::crash ? crashing_path_ : path_;
}

SolveReport SolverChain::run(ComplementaritySolver& solver, const MixedComplementarityProblem& problem,
                             Eigen::VectorXd& z) {
  const SolveReport report = solver.solve(problem, z);
  report_.iterations += report.iterations;
  report_.pivots += report.pivots;
  report_.evaluations += report.evaluations;
  report_.jacobian_evaluations += report.jacobian_evaluations;
  return report;
}

// The proximal point method: a step that is solved moves the center and lets go of it a little, one that is
// not begins again with a firmer hold.
void SolverChain::walk_proximally() {
  center_ = start_;
  double weight = options_.proximal_weight;
  for (int step = 0; step < options_.proximal_steps; ++step) {
    z_ = center_;
    const SolveReport stage = run(semismooth_, with_proximal_term(weight), z_);
    report_.stages.push({SolverKind::semismooth_newton, StageStart::proximal, stage.status, stage.iterations,
                         stage.residual, weight});
    if (stage.solved()) center_ = z_;
    weight *= stage.solved() ? 0.1 : 10.0;
  }
  z_ = center_;
}

const MixedComplementarityProblem& SolverChain::with_proximal_term(double weight) {
  if (const SparseComplementarityProblem* sparse = problem_->sparse(); sparse != nullptr) {
    sparse_proximal_.bind(*sparse, center_, weight);
    return sparse_proximal_;
  }
  proximal_.bind(*problem_, center_, weight);
  return proximal_;
}

void SolverChain::perturb_start(int restart) {
  const double size = std::ldexp(options_.perturbation, restart);
  for (Index i = 0; i < start_.size(); ++i) {
    z_[i] = start_[i] + size * (1.0 + std::abs(start_[i])) * next_random(random_state_);
  }
  z_ = z_.cwiseMax(problem_->lower()).cwiseMin(problem_->upper());
}

}  // namespace touchstone
