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

}  // namespace

void SolverChainOptions::validate() const {
  path.validate();
  semismooth.validate();
  require::in_closed("SolverChainOptions.proximal_steps", proximal_steps, 0, 16);
  require::positive("SolverChainOptions.proximal_weight", proximal_weight);
  require::in_closed("SolverChainOptions.restarts", restarts, 0, 64);
  require::positive("SolverChainOptions.perturbation", perturbation);
}

SolverChain::SolverChain(const SolverChainOptions& options)
    : options_(options), path_(options.path), semismooth_(options.semismooth) {
  options_.validate();
}

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
  if (options_.proximal_steps > 0) {
    walk_proximal_homotopy();
    if (attempt(options_.first, StageStart::proximal)) return true;
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
  const SolveReport stage = run(solver, *problem_, z_);
  report_.stages.push({solver, start, stage.status, stage.iterations, stage.residual});
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

SolveReport SolverChain::run(SolverKind solver, const MixedComplementarityProblem& problem,
                             Eigen::VectorXd& z) {
  const SolveReport report =
      solver == SolverKind::path_newton ? path_.solve(problem, z) : semismooth_.solve(problem, z);
  report_.iterations += report.iterations;
  report_.pivots += report.pivots;
  report_.evaluations += report.evaluations;
  report_.jacobian_evaluations += report.jacobian_evaluations;
  return report;
}

// From the start, to whose surroundings a large weight ties the solution, with less and less of it. A weight
// that fails leaves its best point to the next one.
void SolverChain::walk_proximal_homotopy() {
  z_ = start_;
  double weight = options_.proximal_weight;
  for (int step = 0; step < options_.proximal_steps; ++step, weight *= 0.1) {
    proximal_.bind(*problem_, start_, weight);
    [[maybe_unused]] const SolveReport on_the_way = run(options_.first, proximal_, z_);
  }
}

void SolverChain::perturb_start(int restart) {
  const double size = std::ldexp(options_.perturbation, restart);
  for (Index i = 0; i < start_.size(); ++i) {
    z_[i] = start_[i] + size * (1.0 + std::abs(start_[i])) * next_random(random_state_);
  }
  z_ = z_.cwiseMax(problem_->lower()).cwiseMin(problem_->upper());
}

}  // namespace touchstone
