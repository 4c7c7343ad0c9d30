#pragma once

#include <Eigen/Core>
#include <array>

#include "core/complementarity/fischer_burmeister.h"
#include "core/complementarity/iterate.h"
#include "core/complementarity/normal_equations.h"
#include "core/complementarity/problem.h"
#include "core/complementarity/report.h"

namespace touchstone {

/// What the Newton methods have in common: when to stop and how far to step.
struct SearchOptions {
  /// Solved if natural_residual <= tolerance; > 0, in the unit of the problem's rows.
  double tolerance = 1e-10;
  int max_iterations = 100;  ///< Newton steps of a search; >= 1
  /// A step alpha d is taken if the merit falls below the reference by armijo alpha |slope|; in (0, 0.5].
  double armijo = 1e-4;
  double backtrack = 0.5;  ///< factor between trial steps; in (0, 0.9]
  double min_step = 1e-2;  ///< trial steps below this part of the first are not made; in (0, 1]
  /// The reference is the largest of this many last merits (1: monotone); in [1, 16].
  int memory = 4;
  double penalty = 0.95;  ///< weight of the Fischer-Burmeister term, see FischerBurmeister; in (0, 1]
  /// Longest step in any unknown, relative to 1 + max|z|: a nearly singular system must not throw the search
  /// away; > 0.
  double max_step = 1e3;
  /// Stalled after this many steps in a row without 1 % less merit; >= 1.
  int patience = 40;
  /// First weight mu of a regularised step, (H^T H + mu I) d = -H^T Phi, relative to |Phi| and the largest
  /// entry of diag(H^T H); > 0.
  double regularisation = 1e-3;
  /// A singular Newton system counts as consistent if its best step leaves at most this part of the residual;
  /// in [0, 0.5].
  double consistency = 0.1;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// The globalisation that both Newton methods share: iterates, their merit, the line search (nonmonotone,
/// Grippo, Lampariello & Lucidi 1986), regularised steps, the best point seen and the report. Directions come
/// from outside.
class MeritSearch {
 public:
  explicit MeritSearch(const SearchOptions& options);

  /// Binds the problem, which must outlive the solve, and evaluates it at z. False if F is not finite there.
  [[nodiscard]] bool start(const MixedComplementarityProblem& problem, const Eigen::VectorXd& z);
  /// Begins again at z; the report and the best point seen go on.
  [[nodiscard]] bool restart(const Eigen::VectorXd& z);

  [[nodiscard]] const Iterate& current() const { return current_; }
  [[nodiscard]] bool converged() const { return current_.residual.value <= options_.tolerance; }
  [[nodiscard]] FischerBurmeister& reformulation() { return reformulation_; }
  [[nodiscard]] SolveReport& report() { return report_; }
  [[nodiscard]] const SearchOptions& options() const { return options_; }

  /// Whether too many steps in a row brought next to nothing.
  [[nodiscard]] bool out_of_patience() const { return idle_steps_ >= options_.patience; }

  /// The largest step alpha <= 1 along d that max_step allows.
  [[nodiscard]] double longest_step(const Eigen::VectorXd& direction) const;
  /// Evaluates the trial point z + alpha d, put back into the bounds if `project`.
  void try_step(const Eigen::VectorXd& direction, double alpha, bool project);
  /// Whether F and its Jacobian are finite at the trial.
  [[nodiscard]] bool trial_is_usable();
  /// Whether besides the merit falls enough: below the reference, with the slope (< 0) of the merit along d.
  [[nodiscard]] bool trial_is_sufficient(double alpha, double slope);
  /// Moves to the trial. A `tentative` move does not enter the reference.
  void accept(bool tentative = false);

  /// Steps alpha = first, first * backtrack, ... along d until one is sufficient, and accepts it; false if
  /// none is.
  [[nodiscard]] bool backtrack(const Eigen::VectorXd& direction, double slope, double first, bool project);
  /// Levenberg-Marquardt steps on Phi with growing weight, towards the gradient, until one is accepted. False
  /// if none is; then merit_is_stationary() tells whether the point is a local minimum of the merit.
  [[nodiscard]] bool regularised_step();
  [[nodiscard]] bool merit_is_stationary() const { return stationary_; }

  /// Keeps the current point to come back to; restore() goes back to it.
  void save_checkpoint() { checkpoint_.copy(current_); }
  void restore_checkpoint();

  /// Completes the report; z becomes the current point if solved, else the best seen.
  SolveReport finish(SolveStatus status, Eigen::VectorXd& z);

 private:
  void resize(Eigen::Index n);
  void evaluate(Iterate& point, bool with_jacobian);
  void note_if_best();
  [[nodiscard]] double reference() const;

  SearchOptions options_;
  const MixedComplementarityProblem* problem_ = nullptr;
  FischerBurmeister reformulation_;
  Iterate current_, trial_, checkpoint_;
  Eigen::VectorXd best_z_;
  NaturalResidual best_;
  std::array<double, 16> merits_{};  // of the last accepted points, in a ring
  int merit_count_ = 0;
  double milestone_ = 0.0;  // the merit when the last real progress was made
  int idle_steps_ = 0;

  NormalEquations normal_equations_;
  Eigen::VectorXd step_;
  double regularisation_ = 0.0;
  bool stationary_ = false;
  SolveReport report_;
};

}  // namespace touchstone
