#pragma once

#include <string>

#include "experiments/solver_comparison/profile.h"

namespace touchstone::solver_comparison::test {

/// A problem of one family and scene that `method` does not solve.
inline Effort unsolved(const std::string& problem, const std::string& method) {
  return {.family = "step", .scenario = "balls", .start = "warm", .problem = problem, .method = method};
}

/// The same, solved.
inline Effort solved(const std::string& problem, const std::string& method, double iterations,
                     double seconds) {
  Effort effort = unsolved(problem, method);
  effort.solved = true;
  effort.iterations = iterations;
  effort.seconds = seconds;
  return effort;
}

}  // namespace touchstone::solver_comparison::test
