#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "experiments/harness/csv.h"

/// Tables over all problems, made from the rows of the cases.
namespace touchstone::solver_comparison {

/// What one solver spent on one problem that has a solution.
struct Effort {
  std::string family;
  std::string scenario;
  std::string problem;  ///< tells it from the others of its family and scenario
  std::string method;
  bool solved = false;
  double iterations = std::numeric_limits<double>::quiet_NaN();
  double seconds = std::numeric_limits<double>::quiet_NaN();
};

/// The efforts in summary.csv and solve_timing.csv of a folder. Cases that were skipped are left out.
/// @throws InputError, IoError as read_csv()
[[nodiscard]] std::vector<Effort> read_efforts(const std::filesystem::path& folder);

/// Performance profiles of Dolan & More (2002), one for each family and method: the share of the family's
/// problems that the method solves at a cost of at most `ratio` times that of the cheapest method there, a
/// row where that share changes. A problem that a method does not solve, or is not for, stays outside at any
/// ratio.
/// @param cost  Effort::iterations or Effort::seconds, below `least` taken as `least` > 0
/// Columns: family, method, ratio, share.
[[nodiscard]] harness::Table performance_profile(const std::vector<Effort>& efforts, double Effort::*cost,
                                                 double least);

/// How many times as long as each of our solvers the fastest one of Siconos takes, problem by problem; by
/// family, and for steps by scene too (`scenario` is empty for all of a family).
/// Columns: family, scenario, method, solved (by ours), compared (by one of Siconos's too), median_ratio,
/// smallest_ratio, largest_ratio, median_s (ours), median_best_s (theirs), most_often_best.
[[nodiscard]] harness::Table speed_ratios(const std::vector<Effort>& efforts);

/// Writes profile.csv, profile_timing.csv and speed_timing.csv of what is in the folder.
/// @returns lines for a person: solved shares, and how the times compare
[[nodiscard]] std::string write_profiles(const std::filesystem::path& folder);

}  // namespace touchstone::solver_comparison
