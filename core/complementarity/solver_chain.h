#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/proximal_problem.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/complementarity/solver.h"

namespace touchstone {

struct SolverChainOptions {
  PathNewtonOptions path;
  SemismoothNewtonOptions semismooth;
  SolverKind first = SolverKind::path_newton;  ///< the solver that begins; the other one follows
  bool second = true;                          ///< whether the other one is tried at all
  /// Number of weights w, w / 10, w / 100, ... of a proximal homotopy from the start, after which a solve
  /// without such a term is tried; in [0, 16], 0: none.
  int proximal_steps = 3;
  double proximal_weight = 1.0;  ///< the first of those weights, > 0, in units of F per unit of z
  int restarts = 8;              ///< perturbed starts, by the two solvers in turn; in [0, 64]
  /// The r-th perturbed start moves each unknown by up to perturbation * 2^r * (1 + |z_i|); > 0.
  double perturbation = 0.1;
  std::uint64_t seed = 1;  ///< of the perturbations

  /// The tolerance of both solvers.
  void set_tolerance(double tolerance) { path.search.tolerance = semismooth.search.tolerance = tolerance; }

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Solves by the first solver and, if that fails, by what is left to try: the other solver, a homotopy in a
/// proximal term, perturbed starts. Each attempt is a stage of the report, whose counts are those of all
/// attempts together; its history is that of the last one.
///
/// The ordinary case costs what the first solver costs. A problem without a solution costs all attempts.
class SolverChain final : public ComplementaritySolver {
 public:
  explicit SolverChain(const SolverChainOptions& options = {});

  [[nodiscard]] SolveReport solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) override;

 private:
  [[nodiscard]] bool attempt(SolverKind solver, StageStart start);
  [[nodiscard]] SolveReport run(SolverKind solver, const MixedComplementarityProblem& problem,
                                Eigen::VectorXd& z);
  [[nodiscard]] bool fall_back();
  void walk_proximal_homotopy();
  void perturb_start(int restart);

  SolverChainOptions options_;
  PathNewton path_;
  SemismoothNewton semismooth_;
  ProximalProblem proximal_;

  const MixedComplementarityProblem* problem_ = nullptr;
  Eigen::VectorXd start_, z_, best_z_;
  SolveReport report_;
  std::uint64_t random_state_ = 0;
};

}  // namespace touchstone
