#pragma once

#include "core/contact/minkowski.h"

namespace touchstone {

/// The unit normal n, from body 2 into body 1, of the face of C nearest to the origin: the direction along
/// which two overlapping bodies overlap least, over all directions and not only near some start.
///
/// By a polytope inside C that grows where it is nearest (van den Bergen, Proximity queries and penetration
/// depth computation on 3D game objects, GDC 2001). The origin need not be inside the polytope, nor in C:
/// faces that it is outside of count as nearest, the farther outside the nearer, so that touching bodies and
/// bodies a rounding error apart are no exception. Ends when the nearest face is within `tolerance * size` of
/// C's surface, or at the capacity of its fixed arrays. Does not allocate.
template <int Dim>
Vector<Dim> least_overlap_direction(const BodyPair<Dim>& bodies, double absolute, double relative);

}  // namespace touchstone
