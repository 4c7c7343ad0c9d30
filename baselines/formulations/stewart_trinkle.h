#pragma once

#include <memory>

#include "core/method.h"

namespace touchstone {

/// The time-stepper of Stewart & Trinkle 1996 ("An implicit time-stepping scheme for rigid body dynamics with
/// inelastic collisions and Coulomb friction"), the paper's baseline of Fig. 1. One step solves (Eq. 4)
///   M nu' = M nu + W_n p_n + W_f D beta + h (f_app - omega x I omega),   q' = q (+) h nu'
/// with W, M and the gaps taken at the START of the step, psi' ~ psi + h W_n^T nu', and the friction
/// ellipsoid replaced by a pyramid: a linear complementarity problem, solved by Lemke's method (lcp_step.h).
///
/// Options:
///   candidates   reachable (default) | nearest:k | epsilon:e | all, see candidate_policy.h
///   edges        plane: 0 (default) keeps discs, N >= 3 makes moving discs regular polygons of N edges
///   pyramid      space: d, sides of the friction pyramid, even, >= 4 (default 8)
///   pyramid_fit  space: inscribed (default) | circumscribed, see friction_pyramid.h
/// @throws InputError on a bad or unknown option, Unsupported on pairs of shapes without contact candidates
///         (contact_candidates.h) on restitution and on joints
template <int Dim>
std::unique_ptr<Method<Dim>> make_stewart_trinkle(const Scene<Dim>& scene, const Options& options);

}  // namespace touchstone
