#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/complementarity/report.h"
#include "core/complementarity/residual.h"
#include "experiments/problems/literature.h"

namespace touchstone::testing {

/// The report says of z exactly what the shared judge says, and "solved" if and only if that is within the
/// tolerance.
inline void expect_honest(const SolveReport& report, const MixedComplementarityProblem& problem,
                          const Eigen::VectorXd& z, double tolerance) {
  const NaturalResidual judged = natural_residual(problem, z);
  EXPECT_EQ(report.residual, judged.value);
  EXPECT_EQ(report.worst_row, judged.worst_row);
  EXPECT_EQ(report.solved(), judged.value <= tolerance) << describe(report, problem);
  EXPECT_NE(report.status, SolveStatus::not_run);
  EXPECT_GE(report.evaluations, report.jacobian_evaluations);
  EXPECT_GE(report.jacobian_evaluations, 1);
  EXPECT_GE(report.history.count(), 1);
  EXPECT_TRUE(z.allFinite());
}

/// Distance from z to the nearest of the listed solutions, largest entry; 0 if none is listed.
inline double distance_to_solutions(const problems::TestProblem& test, const Eigen::VectorXd& z) {
  if (test.solutions.empty() || !test.solutions_are_all) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& solution : test.solutions) {
    nearest = std::min(nearest, (z - solution).lpNorm<Eigen::Infinity>());
  }
  return nearest;
}

/// A solved problem of the table: honest, and at a known solution.
inline void expect_solved(const SolveReport& report, const problems::TestProblem& test,
                          const Eigen::VectorXd& z, double tolerance) {
  EXPECT_TRUE(report.solved()) << test.name << ": " << describe(report, *test.problem);
  expect_honest(report, *test.problem, z, tolerance);
  // A residual of 1e-10 can leave z off by its square root where the solution is degenerate.
  EXPECT_LT(distance_to_solutions(test, z), std::max(test.solution_tolerance, 2 * std::sqrt(tolerance)))
      << test.name;
}

}  // namespace touchstone::testing
