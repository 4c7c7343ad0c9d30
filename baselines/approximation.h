#pragma once

#include "core/model/scene.h"

namespace touchstone {

/// The scene with every disc that moves replaced by the regular polygon of `edges` edges and the same
/// circumradius, one vertex down at angle 0; mass and inertia stay the disc's. What a polygonal method
/// simulates, and is judged on.
/// @throws InputError if edges < 3
Scene<2> with_polygons(Scene<2> scene, int edges);

}  // namespace touchstone
