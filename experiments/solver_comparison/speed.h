#pragma once

#include <string>
#include <vector>

#include "experiments/solver_comparison/profile.h"

/// How many times as long as ours Siconos's solvers take.
namespace touchstone::solver_comparison {

/// Problem by problem; by family, and for steps by scene and start too (empty: all of them). Two measures,
/// over the problems of a row that ours solves:
/// - the fastest of Siconos's on each problem, whichever it is: compared (problems that one of them solves),
///   median_ratio, smallest_ratio, largest_ratio, median_s (ours), median_best_s (theirs), most_often_best;
/// - the fastest single one, of those that solve all of them: single_best, single_ratio (median of the ratios
///   on each problem), single_median_s. Empty if none of them solves all.
/// Columns: family, scenario, start, method, solved, and these.
[[nodiscard]] harness::Table speed_ratios(const std::vector<Effort>& efforts);

/// Of whole trajectories: ours from a start, beside the fastest single solver of Siconos that solves every
/// step, from `siconos_start`: the same, or the last solution where ours extrapolates. A row without a
/// scenario is over all scenes: one solver for all of them, and medians of the scenes' ratios.
/// Columns: scenario, method, start, siconos_start, steps, median_s, mean_s (ours, a step), siconos_best,
/// siconos_median_s, siconos_mean_s, median_ratio, mean_ratio (of these medians and means).
[[nodiscard]] harness::Table trajectory_ratios(const std::vector<Effort>& efforts);

/// Lines for a person.
[[nodiscard]] std::string describe_speed(const harness::Table& speed);
[[nodiscard]] std::string describe_trajectories(const harness::Table& trajectories);

}  // namespace touchstone::solver_comparison
