#pragma once

#include <cstdint>

#include "core/stepper/step_problem.h"

namespace touchstone {

/// What a search of every contact mode found.
struct ModeReport {
  int modes = 0;         ///< tried: 3 to the number of contacts, 2 for one without friction
  int solved_modes = 0;  ///< that have a solution as equations
  int roots = 0;         ///< solutions found, of all modes and from all starts
  /// By how much the best of them misses the step's problem: its natural residual, in StepProblem's units. 0
  /// to rounding if the step has a solution.
  double least_violation = 0.0;
};

/// Looks for solutions of a step without complementarity: each contact is told to be open, to stick or to
/// slip, which leaves equations (but for the faces of closest points), and these are solved from many starts.
/// A solution of the step solves the equations of one mode and fulfils the inequalities of it as well. That
/// no mode has one is no proof that there is none, since each Newton method may miss it, but such a proof as
/// a search can give.
/// @param problem  of one island, in the projection form; at most a handful of contacts
/// @param starts   of each mode
template <int Dim>
ModeReport search_modes(StepProblem<Dim>& problem, int starts, std::uint64_t seed);

}  // namespace touchstone
