#pragma once

#include <cmath>
#include <vector>

#include "core/stepper/step_problem.h"

/// What the contacts and joints of CondensedSystem have in common.
namespace touchstone {

/// How 0 <= a _|_ b >= 0 becomes an equation, and what is added to a linear system of such equations.
struct CondensedForm {
  /// By the function of Fischer and Burmeister; otherwise by the active set of the minimum function.
  bool fischer_burmeister = false;
  /// Multipliers of faces by the active set all the same, unless smoothed: which face bears is then chosen.
  bool chooses_faces = false;
  /// Holds on to the contacts' impulses, see CondensedSystem.
  bool damps = false;
  /// By this much, if it is not 0, instead of what goes with the residual.
  double hold = 0.0;
  /// tau of the function and of friction (friction_rows()), an impulse over m V; 0: the problem as it is.
  double smoothing = 0.0;

  /// Whether the active set says which rows of multipliers stand.
  [[nodiscard]] bool multipliers_by_active_set() const {
    return !fischer_burmeister || (chooses_faces && smoothing == 0);
  }
};

/// What rows come to, taken one after the other.
struct ResidualAndMerit {
  double residual = 0.0;        ///< natural residual: the largest row, complementarity as min(a, b)
  Eigen::Index worst_row = -1;  ///< in z, of that residual
  double merit = 0.0;           ///< sum of squares of the rows in the form that is solved

  /// A row of the natural residual. NaN is larger than any number, and stays.
  void account(double value, Eigen::Index row) {
    const double size = std::abs(value);
    if (!(size <= residual) && !std::isnan(residual)) {
      residual = size;
      worst_row = row;
    }
  }
};

/// A joint or a contact in a condensed system.
template <int Dim>
struct CondensedPart {
  StepBlock<Dim> block;
  std::vector<Eigen::Index> kept;   ///< of the block's unknowns: those that are solved together with others'
  std::vector<Eigen::Index> place;  ///< of those kept, in the reduced system

  /// Begins the list with the velocities of the bodies that move.
  void list_velocities() {
    constexpr int velocity = Dimension<Dim>::velocity;
    kept.clear();
    place.clear();
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      if (block.place[k] < 0) continue;
      for (Eigen::Index c = 0; c < velocity; ++c) {
        kept.push_back(block.column[k] + c);
        place.push_back(velocity * block.place[k] + c);
      }
    }
  }
  /// Adds an unknown of the block's own, at the end of the reduced system.
  void keep(Eigen::Index unknown, Eigen::Index& reduced_size) {
    kept.push_back(unknown);
    place.push_back(reduced_size++);
  }
};

}  // namespace touchstone
