#pragma once

#include <string>
#include <vector>

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

/// Three problems: two that both `a` and Siconos solve, one that only `a` does.
inline std::vector<Effort> three_problems() {
  return {solved("1", "a", 2, 1.0), solved("1", "siconos_b", 4, 6.0), solved("1", "siconos_c", 8, 3.0),
          solved("2", "a", 6, 2.0), solved("2", "siconos_b", 3, 1.0), unsolved("2", "siconos_c"),
          solved("3", "a", 5, 0.5), unsolved("3", "siconos_b"),       unsolved("3", "siconos_c")};
}

}  // namespace touchstone::solver_comparison::test
