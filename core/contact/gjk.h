#pragma once

#include "core/contact/minkowski.h"

namespace touchstone {

/// What the search for the point of C closest to the origin knows of it.
template <int Dim>
struct Distance {
  Vector<Dim> a_1 = Vector<Dim>::Zero();  ///< in body 1
  Vector<Dim> a_2 = Vector<Dim>::Zero();  ///< in body 2
  Vector<Dim> v = Vector<Dim>::Zero();    ///< a_1 - a_2; |v| is an upper bound of the distance
  double lower = 0.0;                     ///< s(v/|v|), a lower bound; > 0 proves the bodies apart [m]
};

struct GjkOptions {
  double absolute = 1e-4;  ///< stop once |v| - lower <= absolute * size
  double relative = 1e-2;  ///< ... and |v| - lower <= relative * |v|, which bounds the error of v's direction
};

/// The algorithm of Gilbert, Johnson and Keerthi (A fast procedure for computing the distance between complex
/// objects in three-dimensional space, IEEE J. Robotics and Automation 4, 1988): the nearest point of a
/// simplex in C, taken on by the support against it. Ends in finitely many steps for polytopes, converges
/// linearly on curved bodies. Does not allocate.
///
/// If the bodies overlap, or touch within rounding, it ends with `lower` <= 0.
template <int Dim>
Distance<Dim> gjk(const BodyPair<Dim>& bodies, const GjkOptions& options);

}  // namespace touchstone
