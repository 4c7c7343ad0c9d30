#pragma once

#include "core/contact/minkowski.h"

namespace touchstone {

/// A candidate for the closest points, in the frame of a BodyPair.
template <int Dim>
struct Candidate {
  Vector<Dim> a_1 = Vector<Dim>::Zero();
  Vector<Dim> a_2 = Vector<Dim>::Zero();
  Vector<Dim> normal = Vector<Dim>::Zero();  ///< unit, outward from body 2

  [[nodiscard]] double gap() const { return normal.dot(a_1 - a_2); }
};

/// How far a candidate is from being proven, [m]: the largest of
///   - |a_1 - a_2 - psi n|, psi = n.(a_1 - a_2);
///   - how far a_1 and a_2 are outside their bodies;
///   - |psi - s(n)|: by how much the points are not the bodies' extreme ones along n.
/// At 0 the points lie in the bodies and are |psi| apart, and no two points are closer (psi > 0), or n is a
/// direction of stationary overlap (psi < 0): an upper and a lower bound that meet.
template <int Dim>
double defect(const BodyPair<Dim>& bodies, const Candidate<Dim>& candidate);

/// Newton's method on the closest-point conditions in signed-gap form (Eq. 9, and Eqs. 20-22 for
/// intersections), smooth through touching:
///   a_1 - a_2 = psi N_2,  N_1 + N_2 = 0,  |N_2| = 1,  f_i(a_1) = 0, g_j(a_2) = 0 over the active
///   inequalities, N_1 = sum l_i grad f_i(a_1),  N_2 = sum l_j grad g_j(a_2).
/// The active set starts as the inequalities within `slack` of the points that make up the normal, and
/// changes by the signs of l and f (primal-dual active set). Where flat meets flat the conditions do not
/// determine the points, and the step is one of the solutions. Does not allocate.
///
/// @param candidate  the start; replaced by the end if that has the smaller defect()
/// @return the candidate's defect [m]
template <int Dim>
double closest_newton(const BodyPair<Dim>& bodies, double slack, Candidate<Dim>& candidate);

}  // namespace touchstone
