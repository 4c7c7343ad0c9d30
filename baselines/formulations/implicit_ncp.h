#pragma once

#include <memory>

#include "core/method.h"

namespace touchstone {

/// The geometrically implicit time-stepper as a method. Options:
///   solver=condensed|path|semismooth  which solver is tried first: closest points eliminated, or the full
///   problem gap=distance|workspace       the signed distance or f(a_2) in the normal complementarity
///   tolerance=1e-13              natural residual at which a step is solved
///   max_iterations=100           Newton steps of one attempt
/// @throws InputError on an unknown or bad option or scene, Unsupported on a scene it cannot represent
template <int Dim>
std::unique_ptr<Method<Dim>> make_implicit_ncp(const Scene<Dim>& scene, const Options& options);

}  // namespace touchstone
