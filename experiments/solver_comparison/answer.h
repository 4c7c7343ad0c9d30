#pragma once

#include <string>
#include <vector>

#include "core/complementarity/problem.h"
#include "experiments/solver_comparison/task.h"

namespace touchstone::solver_comparison {

/// Solved means a natural residual of at most this, whatever a solver says.
constexpr double kSolved = 1e-10;

/// What became of one solve; of a trajectory the sums over its steps, unless said otherwise.
struct Answer {
  bool claims_solved = false;  ///< of a trajectory: every step
  std::string claim;           ///< the solver's own status; of a trajectory of the first step not solved
  double residual = 0.0;       ///< of what it returned, by natural_residual(); of a trajectory the worst
  long iterations = 0;         ///< Newton steps, sweeps, or pivots of a method that only pivots
  long evaluations = 0;        ///< of F, counted outside the solver; 0 if it is given the data instead
  long stages = 1;             ///< attempts of a chain of solvers
  long problems = 1;           ///< steps of a trajectory
  long solved_problems = 0;    ///< of those, within kSolved
  double solve_s = 0.0;        ///< processor time of one solve [s]; of a trajectory the median over its steps
  double total_s = 0.0;        ///< of all problems [s]

  [[nodiscard]] bool is_solved() const { return residual <= kSolved; }
};

/// Hands evaluations on and counts them.
class CountingProblem final : public MixedComplementarityProblem {
 public:
  explicit CountingProblem(const MixedComplementarityProblem& problem) : problem_(problem) {}
  [[nodiscard]] Eigen::Index size() const override { return problem_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return problem_.lower(); }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return problem_.upper(); }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    ++count_;
    problem_.evaluate(z, f, jacobian);
  }
  [[nodiscard]] long count() const { return count_; }
  void restart() { count_ = 0; }

 private:
  const MixedComplementarityProblem& problem_;
  mutable long count_ = 0;
};

/// Keys of our solvers. `elimination` solves steps alone, `lemke` linear problems alone, `implicit_stepper`
/// whole trajectories.
[[nodiscard]] std::vector<std::string> our_solvers();
/// @throws Unsupported if the solver is not for such a problem
[[nodiscard]] Answer solve_by_ours(const std::string& solver, const Task& task);

/// Keys of Siconos's solvers, also where it is not installed.
[[nodiscard]] std::vector<std::string> siconos_solvers();
/// Version of the library; empty if the program was built without it.
[[nodiscard]] std::string siconos_version();
/// In this process: it may print, crash or hang. @throws Unsupported as above
[[nodiscard]] Answer solve_by_siconos(const std::string& solver, const Task& task);

}  // namespace touchstone::solver_comparison
