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
  /// Path-following is left out for a problem with a sparse Jacobian and more unknowns than this: the
  /// pivoter's basis is dense; >= 0.
  int largest_pivoting = 1000;
  int crash_steps = 20;  ///< of path-following from a crash start; in [0, 100], 0: that is not tried
  /// Steps of the proximal outer loop of the semismooth method, after which a solve without proximal term is
  /// tried; in [0, 16], 0: none.
  int proximal_steps = 3;
  double proximal_weight = 1.0;  ///< of the first of these steps, > 0, in units of F per unit of z
  int restarts = 8;              ///< perturbed starts, by the two solvers in turn; in [0, 64]
  /// The r-th perturbed start moves each unknown by up to perturbation * 2^r * (1 + |z_i|); > 0.
  double perturbation = 0.1;
  std::uint64_t seed = 1;  ///< of the perturbations

  /// The tolerance of both solvers.
  void set_tolerance(double tolerance) { path.search.tolerance = semismooth.search.tolerance = tolerance; }

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Solves by the first solver and, if that fails, by what is left to try, in this order:
///   1. the first solver from the start given;
///   2. the other one;
///   3. path-following after a crash start (CrashStart);
///   4. the semismooth method with a proximal outer loop (Rockafellar 1976; for complementarity problems
///      Billups & Ferris 1997): z_{k+1} solves F(z) + w_k (z - z_k) = 0 with complementarity, w_{k+1} = w_k /
///      10 after a step that was solved and 10 w_k after one that was not; then without the term;
///   5. perturbed starts, by the two solvers in turn.
/// Each attempt is a stage of the report, whose counts are those of all attempts together; its history is
/// that of the last one.
///
/// The ordinary case costs what the first solver costs. A problem without a solution costs all attempts.
class SolverChain final : public ComplementaritySolver {
 public:
  explicit SolverChain(const SolverChainOptions& options = {});

  [[nodiscard]] SolveReport solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) override;

 private:
  [[nodiscard]] bool attempt(SolverKind solver, StageStart start);
  [[nodiscard]] SolveReport run(ComplementaritySolver& solver, const MixedComplementarityProblem& problem,
                                Eigen::VectorXd& z);
  [[nodiscard]] ComplementaritySolver& solver_for(SolverKind solver, StageStart start);
  [[nodiscard]] bool may_pivot() const;
  [[nodiscard]] bool fall_back();
  void walk_proximally();
  [[nodiscard]] const MixedComplementarityProblem& with_proximal_term(double weight);
  void perturb_start(int restart);

  SolverChainOptions options_;
  PathNewton path_, crashing_path_;
  SemismoothNewton semismooth_;
  ProximalProblem proximal_;
  SparseProximalProblem sparse_proximal_;

  const MixedComplementarityProblem* problem_ = nullptr;
  Eigen::VectorXd start_, z_, best_z_, center_;
  SolveReport report_;
  std::uint64_t random_state_ = 0;
};

}  // namespace touchstone
