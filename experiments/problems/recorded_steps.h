#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "core/stepper/implicit_stepper.h"

namespace touchstone::problems {

/// One step's problem as the implicit stepper met it, with a start for its solvers.
template <int Dim>
struct RecordedStep {
  int step = 0;  ///< number of the step, from 1
  std::string
      start;  ///< "warm": the last step's solution carried on; "cold": free velocity, points from cold
  std::shared_ptr<const ImplicitStepper<Dim>> keeper;  ///< owns what the problem refers to
  StepProblem<Dim> problem;  ///< its evaluation has a workspace: one copy for each thread
  Eigen::VectorXd z;         ///< the start
};

/// Runs the implicit stepper and records the steps asked for: of each the island that it solved last, from
/// cold and, if the step before had the same contacts, from its solution.
/// @param h      step [s]
/// @param steps  numbers of steps, ascending, from 2
/// @throws std::runtime_error if a step on the way is not solved
template <int Dim>
std::vector<RecordedStep<Dim>> record_steps(const Scene<Dim>& scene, double h, const std::vector<int>& steps);

}  // namespace touchstone::problems
