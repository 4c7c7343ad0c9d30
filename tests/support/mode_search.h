#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/stepper/step_problem.h"

namespace touchstone {

struct ModeSearchOptions {
  int starts = 2;  ///< at random, of each mode
  std::uint64_t seed = 1;
  /// Contacts that are open in all modes, because nothing brings them together in the step; empty: none.
  std::vector<bool> held_open = {};
  /// Further starts of each mode, at least as long as the problem: where other searches ended, say.
  std::vector<Eigen::VectorXd> from = {};
};

/// What a search of every contact mode found.
struct ModeReport {
  int modes = 0;         ///< tried: 3 to the number of contacts, 2 for one without friction, 1 held open
  int solved_modes = 0;  ///< that have a solution as equations
  int roots = 0;         ///< solutions found, of all modes and from all starts
  /// By how much the best of them misses the step's problem: its natural residual, in StepProblem's units. 0
  /// to rounding if the step has a solution.
  double least_violation = std::numeric_limits<double>::infinity();
  std::string best_mode;  ///< of that root, a word a contact: "stick, slip, open"
  std::string missed;     ///< row in which it misses most
};

/// Looks for solutions of a step without complementarity: each contact is told to be open, to stick or to
/// slip, which leaves equations (but for the faces of closest points), and these are solved from many starts.
/// A solution of the step solves the equations of one mode and fulfils the inequalities of it as well. That
/// no mode has one is no proof that there is none, since each Newton method may miss it, but such a proof as
/// a search can give.
/// @param problem  of one island, in the projection form
template <int Dim>
ModeReport search_modes(StepProblem<Dim>& problem, const ModeSearchOptions& options);

}  // namespace touchstone
