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
  std::string start;
  std::string problem;  ///< tells it from the others of its family and scenario
  std::string method;
  bool solved = false;
  double iterations = std::numeric_limits<double>::quiet_NaN();
  double seconds = std::numeric_limits<double>::quiet_NaN();  ///< of a trajectory the median of its steps
  double mean_seconds = std::numeric_limits<double>::quiet_NaN();  ///< of a trajectory, a step
  long steps = 1;                                                  ///< of a trajectory
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

/// Writes profile.csv, profile_timing.csv, speed_timing.csv and trajectory_timing.csv of what is in the
/// folder.
/// @returns lines for a person: solved shares, and how the times compare
[[nodiscard]] std::string write_profiles(const std::filesystem::path& folder);

}  // namespace touchstone::solver_comparison
