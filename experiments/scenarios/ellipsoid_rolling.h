#pragma once

#include "core/model/scene.h"
#include "experiments/scenarios/truths/ellipsoid_rolling.h"

/// Triaxial ellipsoids that roll without slip: one on a plane, and one on a fixed ellipsoid, where the gap
/// has no closed form. The truth of all is truth::roll_ellipsoid.
namespace touchstone {

/// A solid ellipsoid on the plane z = 0 that starts on its shortest axis and wobbles along x.
truth::RollingEllipsoid ellipsoid_on_plane();
/// The same ellipsoid, turning fast about the vertical: the contact's surroundings turn by 0.1 rad in 0.01 s.
truth::RollingEllipsoid ellipsoid_spinning();
/// A solid ellipsoid of semi-axes 1, 0.9, 0.8 m that rolls up on to the end of its longest axis, over it and
/// down the other side within 2 s: all the while on its sharp side, where the curvature radius in the
/// direction of rolling is less than the height of the centre.
truth::RollingEllipsoid ellipsoid_over_its_end();
/// A solid ellipsoid that starts on top of a fixed one.
truth::RollingEllipsoid ellipsoid_on_ellipsoid();

/// Bodies "ellipsoid" and "ground", a half-space, or, if the ellipsoid has one, "support". Rolling at t = 0.
/// @param mu  more than EllipsoidSample::needed_friction(); there is no torsional friction
Scene<3> ellipsoid_scene(const truth::RollingEllipsoid& parameters, double mu);

}  // namespace touchstone
