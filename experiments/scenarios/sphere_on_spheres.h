#pragma once

#include "core/model/scene.h"
#include "experiments/scenarios/truths/sphere_on_spheres.h"

namespace touchstone {

/// How a ball is written: the paper's ellipsoid with three equal semi-axes, or a sphere, for methods that do
/// not have ellipsoids.
enum class BallShape { ellipsoid, sphere };

/// Example 3 of the paper: a ball under a constant force that rolls and slides on two fixed balls. Its truth
/// is truth::roll_on_spheres.
/// Bodies "ball", "support 1" and "support 2". There is no gravity: the weight is part of the force.
Scene<3> sphere_on_spheres_scene(BallShape shape, const truth::SphereOnSpheres& parameters = {});

}  // namespace touchstone
