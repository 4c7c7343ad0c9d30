// Continuation in a smoothing, the search of CondensedNewton for piles near rest, and the search of closest
// points that goes with it.
//
// Near rest Newton's method goes around among guesses of which contacts stick, slip or open, and of which
// vertex or edge of a nearly flat face bears: the impulses of a pile at rest are not unique, and one guess
// changes them all. With tau > 0 nothing is left to guess:
//   p_n psi = tau^2,  l_i (-f_i) = tau^2   in units of the rows, by the smoothed function of Fischer and
//   Burmeister, friction                               by the smoothed projection (friction_law.cpp),
// so contacts push from afar, friction is viscous at low speeds, and shapes are rounded. Its solutions for
// tau -> 0 lead to the middle of the set of solutions, where few contacts are at the limit of what they can
// bear. Continuation methods of this kind: Chen & Mangasarian, Comput. Optim. Appl. 5, 1996; Hayashi,
// Yamashita & Fukushima, SIAM J. Optim. 15, 2005, for cones as that of friction.
#include <algorithm>
#include <cmath>

#include "core/stepper/condensed_newton.h"

namespace touchstone {

namespace {

constexpr double kFirstSmoothing = 1e-2;  ///< a third of what carries a body's weight for a few milliseconds
constexpr double kLastSmoothing = 1e-12;  ///< its error is what rounding leaves
constexpr double kSharpest = 0.1;         ///< least ratio of a smoothing to the last one
constexpr double kGentlest = 0.8;         ///< ratio at which the path is given up
constexpr double kGentle = 0.5;           ///< largest ratio after a stage that was solved
constexpr int kQuick = 2;                 ///< Newton steps of a stage after which the next one is sharper
constexpr int kSlow = 4;                  ///< and above which it is gentler
constexpr int kPathSteps = 100;           ///< Newton steps of all stages
constexpr int kLastSteps = 8;             ///< from the end of the path
constexpr double kLost = 1e-2;      ///< residual of closest points that a line search should not have to mend
constexpr double kPoints = 1e-13;   ///< residual to which they are found
constexpr int kPointSteps = 10;     ///< Newton steps to them
constexpr double kHopeless = 10.0;  ///< residual from which Newton's method is not tried

}  // namespace

/// Newton's method at smoothings that fall to nothing, each from the solution of the last one, and a few
/// steps on the problem as it is. A stage is solved when what is left of it is less than what the smoothing
/// itself does.
template <int Dim>
SolveReport CondensedNewton<Dim>::smoothed_search(Eigen::VectorXd& z) {
  SolveReport report;
  Stage stage;
  set_strategy({.line_search = true, .follows = true});
  set_smoothing(kFirstSmoothing);
  follow_points(z);
  system_.evaluate(z);
  const int limit = std::min(kPathSteps, options_.max_iterations);
  while (smoothing() >= kLastSmoothing && report.iterations < limit && std::isfinite(system_.merit())) {
    if (!system_.newton_step(z)) break;
    ++report.iterations;
    ++stage.steps;
    if (!(advance(false, stage.steps, z) ? sharpen(stage, z) : retreat(stage, z))) break;
  }
  set_smoothing(0.0);
  system_.evaluate(z);
  const int path = report.iterations;
  report = search({.damps = true, .limit = std::min(kLastSteps, options_.max_iterations)}, z);
  report.iterations += path;
  return report;
}

template <int Dim>
void CondensedNewton<Dim>::set_smoothing(double smoothing) {
  CondensedForm form = system_.form();
  form.smoothing = smoothing;
  system_.set_form(form);
  recent_merits_.clear();
}

/// On to the next stage if this one is solved.
template <int Dim>
bool CondensedNewton<Dim>::sharpen(Stage& stage, Eigen::VectorXd& z) {
  if (!(std::sqrt(2 * system_.merit()) <= smoothing())) return true;
  best_.head(problem_->size()) = z.head(problem_->size());
  if (stage.steps <= kQuick) stage.ratio = std::max(kSharpest, stage.ratio * std::sqrt(stage.ratio));
  if (stage.steps > kSlow) stage.ratio = std::min(kGentle, std::sqrt(stage.ratio));
  stage.steps = 0;
  stage.solved = smoothing();
  set_smoothing(stage.ratio * stage.solved);
  system_.evaluate(z);
  return true;
}

/// Back to the last solution, for a next stage that is nearer to it. False if there is none.
template <int Dim>
bool CondensedNewton<Dim>::retreat(Stage& stage, Eigen::VectorXd& z) {
  stage.ratio = std::sqrt(stage.ratio);
  if (stage.solved == 0 || stage.ratio > kGentlest) return false;
  z.head(problem_->size()) = best_.head(problem_->size());
  stage.steps = 0;
  set_smoothing(stage.ratio * stage.solved);
  system_.evaluate(z);
  return true;
}

/// Finds the closest points of contacts where a step, linear in them, has lost them: where surfaces curve
/// much within the step, or where it leads to another face.
template <int Dim>
void CondensedNewton<Dim>::follow_points(Eigen::VectorXd& z) {
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) follow(i, z);
}

/// By Newton's method from where they are, and else from the closest points as a cold search finds them.
/// Where they are not unique any will do.
template <int Dim>
void CondensedNewton<Dim>::follow(std::size_t i, Eigen::VectorXd& z) {
  double residual = system_.points_residual(i, z);
  if (residual <= kLost) return;
  for (const bool cold : {false, true}) {
    if (cold) {
      problem_->find_points(i, z);
      residual = system_.points_residual(i, z);
    }
    for (int k = 0; k < kPointSteps && residual > kPoints && residual < kHopeless; ++k) {
      if (problem_->is_spurious(i) || !system_.points_step(i, z)) break;
      residual = system_.points_residual(i, z);
    }
    if (residual <= kPoints) return;
  }
}

template SolveReport CondensedNewton<2>::smoothed_search(Eigen::VectorXd&);
template SolveReport CondensedNewton<3>::smoothed_search(Eigen::VectorXd&);
template void CondensedNewton<2>::follow_points(Eigen::VectorXd&);
template void CondensedNewton<3>::follow_points(Eigen::VectorXd&);

}  // namespace touchstone
