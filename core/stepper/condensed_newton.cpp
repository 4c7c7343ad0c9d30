#include "core/stepper/condensed_newton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/contact/patch_middle.h"
#include "core/stepper/make_room.h"

namespace touchstone {

namespace {

/// Contacts above which rounds of sweeps come first: of smooth bodies, and of others, whose faces and edges
/// have to be found.
constexpr std::size_t kMany = 12;
constexpr std::size_t kManyOfAnyBodies = 60;
/// Contacts of the largest problem of which an interior path is tried: with 1000 to 3000 spheres that takes a
/// third to a tenth of the time of Newton's methods.
constexpr std::size_t kLargestInterior = 12'000;
constexpr double kRelaxed = 0.5;         ///< of the tolerance, that they are asked for
constexpr double kNear = 1e-3;           ///< residual after them from which Newton's method goes on
constexpr int kFullSteps = 15;           ///< tried before anything else
constexpr int kFinishSteps = 30;         ///< from near a solution
constexpr int kSettlingSteps = 20;       ///< for the least of what rounding leaves
constexpr int kRelievingSweeps = 500;    ///< from no impulses
constexpr int kRescueSteps = 60;         ///< of each rescue
constexpr int kUndamped = 8;             ///< of those, before every other one is shortened
constexpr double kDamping = 0.3;         ///< to this part
constexpr double kAstray = 1e3;          ///< residual at which a search without a line search is given up
constexpr double kRestore = 1e-3;        ///< residual of closest points above which they are found anew
constexpr std::size_t kMeritMemory = 5;  ///< of the nonmonotone line search
constexpr double kShortest = 1.0 / 128;  ///< its shortest step, relative to a Newton step
constexpr double kDecrease = 1e-4;       ///< Armijo's
constexpr double kTarget = 0.05;         ///< of the tolerance: where a search that still gains ends
constexpr double kWorthwhile = 0.1;      ///< factor of the residual that counts as a gain
constexpr int kIdle = 3;  ///< steps without a gain within what rounding explains that end a search
/// Below this residual the last factors are used once more, which costs less than half of a Newton step.
constexpr double kChordBelow = 1e-5;
/// Factor of the residual that such a step must bring. What a Newton step leaves is mostly in the rows of
/// closest points, lengths that are small for the velocities they stand for; it then goes over to the
/// momentum rows, so that the first of these steps gains more than the residual tells.
constexpr double kChordGain = 0.5;
constexpr int kMonotoneAfter = 8;  ///< steps of a line search

}  // namespace

template <int Dim>
SolveReport CondensedNewton<Dim>::solve(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  const Eigen::Index n = problem.size();
  make_room(start_, n);
  start_.head(n) = z.head(n);
  int iterations = 0;
  const auto attempt = [&](auto&& way) {
    const SolveReport report = way();
    iterations += report.iterations;
    return report;
  };
  const std::size_t contacts = problem.contacts().size();
  const bool is_simple = contacts > kMany && InteriorPath<Dim>::applies_to(problem);
  if (is_simple || (contacts > kManyOfAnyBodies && problem.joints().empty())) {
    SolveReport report = attempt([&] { return approach(problem, z); });
    // What rounding explains is one step of Newton's method away, if any.
    if (!is_acceptable(report) && is_simple && contacts <= kLargestInterior) {
      bind(problem);
      report = attempt([&] { return interior_search(z); });
      if (is_acceptable(report)) report.status = SolveStatus::solved;
    }
    report.iterations = iterations;
    if (report.solved()) return report;
    if (relaxation_.residual() <= kNear) {
      z.head(n) = relaxed_.head(n);
      start_.head(n) = relaxed_.head(n);
    } else {
      z.head(n) = start_.head(n);
    }
  }
  bind(problem);
  SolveReport report =
      attempt([&] { return search({.limit = std::min(kFullSteps, options_.max_iterations)}, z); });
  for (const Rescue& way : kRescues) {
    if (is_acceptable(report) || problem.contacts().empty()) break;
    z.head(n) = start_.head(n);
    report = attempt([&] { return rescue(way, z); });
  }
  report.iterations = iterations;
  return report;
}

template <int Dim>
const std::array<typename CondensedNewton<Dim>::Rescue, 15> CondensedNewton<Dim>::kRescues = {{
    {.sweeps = 0, .search = Rescue::Search::smoothed},
    {.sweeps = 0, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::smoothed},
    {.sweeps = 50, .search = Rescue::Search::smoothed},
    {.sweeps = 0, .search = Rescue::Search::line_search},
    {.sweeps = 50, .search = Rescue::Search::full_steps},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::full_steps},
    {.sweeps = 500, .search = Rescue::Search::smoothed},
    {.sweeps = 500, .search = Rescue::Search::line_search},
    {.sweeps = 500, .search = Rescue::Search::full_steps},
    {.sweeps = 500, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 5, .from_cold = true, .search = Rescue::Search::smoothed},
    {.sweeps = 5, .search = Rescue::Search::full_steps},
    {.sweeps = 5000, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
}};

template <int Dim>
SolveReport CondensedNewton<Dim>::rescue(const Rescue& way, Eigen::VectorXd& z) {
  for (std::size_t i = 0; way.from_cold && i < problem_->contacts().size(); ++i)
    problem_->find_points(i, z, &patch_middle<Dim>);
  if (way.sweeps > 0) {
    system_.evaluate(z);
    static_cast<void>(restore(z));
    sweeps_.run(*problem_, way.sweeps, z);
    system_.evaluate(z);
    static_cast<void>(restore(z));
  }
  if (way.search == Rescue::Search::smoothed) return smoothed_search(z);
  const bool line_search = way.search == Rescue::Search::line_search;
  return search(
      {.line_search = line_search,
       .restores = !line_search,
       .follows = way.damps,
       .damps = way.damps,
       .limit = std::min(line_search ? options_.max_iterations : kRescueSteps, options_.max_iterations)},
      z);
}

template <int Dim>
SolveReport CondensedNewton<Dim>::finish(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  bind(problem);
  const Eigen::Index n = problem.size();
  start_.head(n) = z.head(n);
  SolveReport report = search({.limit = std::min(kFinishSteps, options_.max_iterations)}, z);
  if (report.solved() || report.residual <= options_.acceptable) return report;
  z.head(n) = start_.head(n);
  return search({.line_search = true, .limit = options_.max_iterations}, z);
}

template <int Dim>
SolveReport CondensedNewton<Dim>::settle(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  bind(problem);
  set_strategy({});
  for (std::size_t i = 0; i < problem.contacts().size(); ++i)
    problem.expect_load(i, z[problem.layout().contact(i).normal]);
  SolveReport report;
  report.status = SolveStatus::solved;
  const Eigen::Index n = problem.size();
  system_.evaluate(z);
  const auto keep = [&] {
    report.residual = system_.residual();
    report.worst_row = system_.worst_row();
    start_.head(n) = z.head(n);
  };
  keep();
  while (report.residual > options_.acceptable && report.iterations < kSettlingSteps &&
         system_.newton_step(z)) {
    ++report.iterations;
    z.head(n) += system_.step().head(n);
    system_.evaluate(z);
    if (system_.residual() < report.residual) keep();
  }
  z.head(n) = start_.head(n);
  system_.evaluate(z);
  return report;
}

template <int Dim>
SolveReport CondensedNewton<Dim>::relieve(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    const ContactLayout& at = problem.layout().contact(i);
    z.template segment<Dimension<Dim>::friction>(at.friction).setZero();
    z[at.normal] = 0;
    problem.expect_load(i, 1.0);
  }
  bind(problem);
  system_.evaluate(z);
  sweeps_.run(problem, kRelievingSweeps, z);
  return search({.damps = true, .limit = std::min(kRescueSteps, options_.max_iterations)}, z);
}

template <int Dim>
void CondensedNewton<Dim>::bind(StepProblem<Dim>& problem) {
  problem_ = &problem;
  system_.bind(problem);
  recent_merits_.reserve(kMeritMemory);
  for (Eigen::VectorXd* vector : {&start_, &trial_, &best_}) make_room(*vector, problem.size());
}

template <int Dim>
void CondensedNewton<Dim>::set_strategy(const Strategy& strategy) {
  strategy_ = strategy;
  system_.set_form({.fischer_burmeister = strategy.line_search,
                    .chooses_faces = strategy.follows,
                    .damps = strategy.damps,
                    .hold = strategy.hold});
}

/// Rounds of sweeps from z, which is left where they end.
template <int Dim>
SolveReport CondensedNewton<Dim>::approach(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  SolveReport report;
  report.iterations = relaxation_.run(problem, kRelaxed * options_.tolerance, z);
  report.residual = relaxation_.residual();
  report.status = report.residual <= options_.tolerance ? SolveStatus::solved : SolveStatus::stalled;
  const Eigen::Index n = problem.size();
  make_room(relaxed_, n);
  relaxed_.head(n) = z.head(n);
  return report;
}

template <int Dim>
SolveReport CondensedNewton<Dim>::search(const Strategy& strategy, Eigen::VectorXd& z) {
  set_strategy(strategy);
  SolveReport report;
  recent_merits_.clear();
  if (strategy.follows) follow_points(z);
  system_.evaluate(z);
  report.history.push(system_.residual());
  const Eigen::Index n = problem_->size();
  bool factors_are_good = false;
  double before = std::numeric_limits<double>::infinity();
  double best = before;  // residual of best_, the nearest point to a solution within what rounding explains
  int idle = 0;
  const auto ended = [&](SolveStatus status) {
    if (status != SolveStatus::solved && best < system_.residual()) {
      z.head(n) = best_.head(n);
      system_.evaluate(z);
    }
    return report_of(status, report);
  };
  while (true) {
    if (!std::isfinite(system_.merit()) || (!strategy.line_search && system_.residual() > kAstray))
      return ended(SolveStatus::non_finite);
    // Within the tolerance is solved; but a step that still gains much is cheaper than what its rest does to
    // the steps that follow.
    const bool gains = system_.residual() < kWorthwhile * before;
    if (system_.residual() <= (gains ? kTarget : 1.0) * options_.tolerance) return ended(SolveStatus::solved);
    if (report.iterations == strategy.limit) return ended(SolveStatus::iteration_limit);
    idle = best <= options_.acceptable && system_.residual() > kWorthwhile * best ? idle + 1 : 0;
    if (system_.residual() <= options_.acceptable && system_.residual() < best) {
      best = system_.residual();
      best_.head(n) = z.head(n);
    }
    if (idle > kIdle) return ended(SolveStatus::stalled);
    before = system_.residual();
    const bool chord = factors_are_good && system_.residual() < kChordBelow;
    if (chord) {
      system_.chord_step(z);
    } else if (!system_.newton_step(z)) {
      return ended(SolveStatus::singular_jacobian);
    }
    ++report.iterations;
    if (!advance(chord, report.iterations, z)) return ended(SolveStatus::stalled);
    report.history.push(system_.residual());
    // Points that are followed leave their contacts' factors where the last trial was, off the other ones.
    factors_are_good = !strategy.follows && (!chord || system_.residual() <= kChordGain * before);
  }
}

/// What a search says of z, where it was evaluated last.
template <int Dim>
SolveReport CondensedNewton<Dim>::report_of(SolveStatus status, const SolveReport& search) const {
  SolveReport report = search;
  report.status = status;
  report.residual = system_.residual();
  report.worst_row = system_.worst_row();
  report.evaluations = system_.evaluations();
  report.jacobian_evaluations = system_.factorisations();
  return report;
}

/// Takes the step, or the longest part of it that the line search allows. False if that allows none.
template <int Dim>
bool CondensedNewton<Dim>::advance(bool chord, int iteration, Eigen::VectorXd& z) {
  const Eigen::Index n = problem_->size();
  if (chord || !strategy_.line_search) {
    // A search that goes around in a circle is slowed down at every other step.
    const bool damped = strategy_.restores && iteration > kUndamped && iteration % 2 == 0;
    z.head(n) += (damped ? kDamping : 1.0) * system_.step().head(n);
    system_.evaluate(z);
    if (strategy_.restores && restore(z)) system_.evaluate(z);
    return true;
  }
  // A line search that may go up goes around in circles among active sets.
  if (iteration > kMonotoneAfter) recent_merits_.clear();
  if (recent_merits_.size() == kMeritMemory) recent_merits_.erase(recent_merits_.begin());
  recent_merits_.push_back(system_.merit());
  const double reference = *std::max_element(recent_merits_.begin(), recent_merits_.end());
  trial_.head(n) = z.head(n);
  for (double t = 1.0; t >= kShortest; t /= 2) {
    z.head(n) = trial_.head(n) + t * system_.step().head(n);
    if (strategy_.follows) follow_points(z);
    system_.evaluate(z);
    if (system_.merit() <= (1 - 2 * kDecrease * t) * reference) return true;
  }
  return false;
}

/// Finds closest points anew where a step has left them far from their rows: an active set of faces and edges
/// that is guessed by complementarity from afar can lead anywhere, while the search from cold is certain.
template <int Dim>
bool CondensedNewton<Dim>::restore(Eigen::VectorXd& z) {
  bool any = false;
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    if (system_.geometry_residual(i) <= kRestore) continue;
    problem_->find_points(i, z);
    any = true;
  }
  return any;
}

template class CondensedNewton<2>;
template class CondensedNewton<3>;

}  // namespace touchstone
