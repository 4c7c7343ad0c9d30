#pragma once

#include <array>
#include <numeric>

#include "core/stepper/reduced_system.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// Adds the derivative of the momentum rows by the bodies' own velocities, a block for each moving body of
/// `problem`, to a system whose first unknowns are these velocities, in the problem's order.
template <int Dim>
void add_momentum_matrices(const StepProblem<Dim>& problem, ReducedSystem& system) {
  constexpr int kVelocity = Dimension<Dim>::velocity;
  std::array<Eigen::Index, kVelocity> unknown;
  std::array<Eigen::Index, kVelocity> place;
  std::iota(unknown.begin(), unknown.end(), Eigen::Index{0});
  for (int b = 0; b < problem.moving_bodies(); ++b) {
    std::iota(place.begin(), place.end(), Eigen::Index{kVelocity} * b);
    system.add(unknown, place, problem.momentum_matrix(b));
  }
}

}  // namespace touchstone
