#pragma once

#include <Eigen/Core>

#include "core/complementarity/problem.h"
#include "core/complementarity/report.h"

namespace touchstone {

/// What solves a mixed complementarity problem. A solver keeps its workspace between solves, so that repeated
/// solves of one size allocate nothing, and is therefore not to be shared between threads. It keeps nothing
/// else: equal inputs give equal results, whatever was solved before.
class ComplementaritySolver {
 public:
  virtual ~ComplementaritySolver() = default;

  /// @param z  start on entry, problem.size() entries; on return the solution if the report says solved, else
  /// the point with the least residual seen
  [[nodiscard]] virtual SolveReport solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) = 0;
};

}  // namespace touchstone
