#pragma once

#include "core/model/scene.h"
#include "experiments/scenarios/truths/sphere_spin.h"

namespace touchstone {

/// Example 2 of the paper: a sphere that spins in place on a horizontal plane until torsional friction stops
/// it. Its truths are truth::spin_at and, of the implicit step itself, truth::spin_after_steps.
/// Bodies "ball", a sphere of `radius` [m] that touches the plane at the origin, and "ground", a half-space
/// with normal (0, 0, 1) through the origin; e_t = e_o = 1.
Scene<3> sphere_spin_scene(const truth::SpinningSphere& parameters = {}, double radius = 1.0);

}  // namespace touchstone
