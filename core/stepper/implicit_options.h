#pragma once

#include "core/stepper/contact_rows.h"

namespace touchstone {

/// What an ImplicitStepper is told to do.
struct ImplicitOptions {
  enum class Solver {
    condensed,   ///< closest points eliminated (condensed_newton.h); the other two where that fails
    path,        ///< the full mixed problem by path-following Newton; the other one where that fails
    semismooth,  ///< likewise by semismooth Newton
  };

  Solver solver = Solver::condensed;
  /// f(a_2) of Eq. 6 does not see a body that is through a half-space by more than its own height, since a_2
  /// is then outside it again; the signed distance does, and is therefore the default.
  GapFunction gap = GapFunction::distance;
  /// A search ends where the natural residual of the step's problem is at most this; > 0, in StepProblem's
  /// units.
  double tolerance = 1e-13;
  /// Where rounding keeps a search from the tolerance (mass ratios of 1e4, say) a step is solved if the
  /// residual is at most this, or at most the tolerance if that is larger.
  static constexpr double kAcceptable = 2e-12;
  int max_iterations = 100;  ///< Newton steps of one attempt; >= 1
};

}  // namespace touchstone
