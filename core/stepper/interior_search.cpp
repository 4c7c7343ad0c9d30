// The search of CondensedNewton for heaps at rest: by an interior-point method (interior_path.h) to where it
// is told which contacts slip, and Newton's method from there.
#include <algorithm>
#include <array>
#include <limits>

#include "core/stepper/condensed_newton.h"

namespace touchstone {

namespace {

// of interior_search(), values of tau in InteriorPath
constexpr std::array kInteriorStarts = {1e-3, 1e-6, 1e-4};
/// Of the path, from which it goes straight down ...
constexpr std::array kInteriorStages = {1e-7, 1e-9, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};
/// ... to these, one after the other.
constexpr std::array kInteriorEnds = {1e-14, 1e-17, 1e-18, 1e-19};
constexpr double kTelling = 1e-13;  ///< at which it may be told which contacts slip
// of decide()
/// Weight of slip and hold of impulses to begin with.
constexpr std::array<std::array<double, 2>, 2> kDecisions = {{{1e3, 1e-6}, {1e2, 1e-4}}};
constexpr int kDecidingSteps = 15;
constexpr double kMostHold = 1.0;
constexpr double kLessHold = 1.0 / 3;  ///< after a step that is taken ...
constexpr double kMoreHold = 8;        ///< ... and after one that is not,
constexpr double kMostRise = 10;       ///< since it is this much farther off than the nearest so far
constexpr int kDecidedSteps = 5;

}  // namespace

/// By an interior-point method (interior_path.h): straight down from several starts, and where that gets
/// stuck, from points of its path, ever farther down.
template <int Dim>
SolveReport CondensedNewton<Dim>::interior_search(Eigen::VectorXd& z) {
  SolveReport report;
  report.residual = std::numeric_limits<double>::infinity();
  int iterations = 0;
  const auto descend = [&] {
    bool arrived = true;
    for (std::size_t k = 0; k < kInteriorEnds.size() && arrived; ++k) {
      arrived = interior_.descend(kInteriorEnds[k]);
      if (!arrived && !(interior_.mean_product() <= kTelling)) return false;
      for (const auto& [load, hold] : kDecisions) {
        interior_.write(z);
        report = decide(load, hold, z);
        iterations += report.iterations;
        if (!is_acceptable(report)) continue;
        drop_idle_loads(report, z);
        return true;
      }
    }
    return false;
  };
  const auto search_from = [&](double start) {
    interior_.begin(*problem_, relaxed_, start);
    return descend();
  };
  bool solved = false;
  for (const double start : kInteriorStarts) {
    if (solved) break;
    solved = search_from(start);
    iterations += interior_.factorisations();
  }
  const int before = interior_.factorisations();
  for (const double tau : kInteriorStages) {
    if (solved || !interior_.follow(tau)) break;
    solved = descend();
  }
  report.iterations = iterations + interior_.factorisations() - before;
  return report;
}

/// From an interior point, by Newton's method with the impulses held, in the manner of Levenberg and
/// Marquardt: less where the residual falls, more where it rises. Where slip is as small as rounding leaves
/// it a full step would turn friction about, and with it all that is already right.
/// @param load  by which slip is weighed first (StepProblem::expect_load): contacts that neither surely stick
/// nor surely slip are then taken to slip
template <int Dim>
SolveReport CondensedNewton<Dim>::decide(double load, double hold, Eigen::VectorXd& z) {
  const Eigen::Index n = problem_->size();
  const auto weigh = [&](double weight) {
    for (std::size_t i = 0; i < problem_->contacts().size(); ++i) problem_->expect_load(i, weight);
  };
  SolveReport report;
  weigh(load);
  set_strategy({.damps = true, .hold = hold});
  system_.evaluate(z);
  double least = system_.residual();
  while (least > options_.tolerance && report.iterations < kDecidingSteps && hold < kMostHold) {
    set_strategy({.damps = true, .hold = hold});
    if (!system_.newton_step(z)) break;
    ++report.iterations;
    trial_.head(n) = z.head(n);
    z.head(n) += system_.step().head(n);
    system_.evaluate(z);
    if (system_.residual() <= kMostRise * least) {
      least = std::min(least, system_.residual());
      hold *= kLessHold;
    } else {
      z.head(n) = trial_.head(n);
      system_.evaluate(z);
      hold *= kMoreHold;
    }
  }
  weigh(1.0);
  const int steps = report.iterations;
  report = search({.damps = true, .limit = std::min(kDecidedSteps, options_.max_iterations)}, z);
  report.iterations += steps;
  return report;
}

/// Of contacts that are open: an interior point leaves every contact some load, and a hold keeps a part of
/// it.
template <int Dim>
void CondensedNewton<Dim>::drop_idle_loads(SolveReport& report, Eigen::VectorXd& z) {
  const Eigen::Index n = problem_->size();
  trial_.head(n) = z.head(n);
  const double per_length = 1 / problem_->scale().length;
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    const ContactLayout& at = problem_->layout().contact(i);
    if (!(z[at.normal] <= options_.acceptable && per_length * problem_->separation(i) > z[at.normal]))
      continue;
    z.template segment<Dimension<Dim>::friction>(at.friction).setZero();
    z[at.normal] = 0;
  }
  system_.evaluate(z);
  if (!(system_.residual() <= std::max(report.residual, options_.tolerance))) {
    z.head(n) = trial_.head(n);
    system_.evaluate(z);
  }
  report.residual = system_.residual();
}

template SolveReport CondensedNewton<2>::interior_search(Eigen::VectorXd&);
template SolveReport CondensedNewton<3>::interior_search(Eigen::VectorXd&);
template void CondensedNewton<2>::drop_idle_loads(SolveReport&, Eigen::VectorXd&);
template void CondensedNewton<3>::drop_idle_loads(SolveReport&, Eigen::VectorXd&);
template SolveReport CondensedNewton<2>::decide(double, double, Eigen::VectorXd&);
template SolveReport CondensedNewton<3>::decide(double, double, Eigen::VectorXd&);

}  // namespace touchstone
