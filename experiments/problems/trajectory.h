#pragma once

#include <vector>

#include "experiments/problems/recorded_steps.h"

namespace touchstone::problems {

/// Runs the implicit stepper with its default options and records every step with both starts that the steps
/// before it give: "last", the last solution carried on, and "extrapolated", the stepper's own, a cubic
/// through the last four as long as no contact opens or closes. Slip speeds sigma are those of the start.
/// @param scene  of one moving body and no joints, so that a step is one problem
/// @param h      step [s]
/// @param count  of steps; the first one, which has nothing before it, is left out
/// @throws std::invalid_argument for another scene, std::runtime_error if a step is not solved
template <int Dim>
std::vector<RecordedStep<Dim>> record_trajectory(const Scene<Dim>& scene, double h, int count);

}  // namespace touchstone::problems
