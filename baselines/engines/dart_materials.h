#pragma once

#include <vector>

#include "core/model/scene.h"

namespace touchstone::engines {

/// What DART keeps of a contact law, at each body.
struct DartMaterial {
  double mu_t = 0.0;
  double mu_o = 0.0;
  double restitution = 0.0;
  Vector<3> tangent = Vector<3>::Zero();  ///< world direction of t; zero: any
};

/// DART knows no pairs: it takes the smaller of two bodies' frictions and the product of their restitutions.
/// The materials of the bodies, from which DART makes each pair's law again.
/// @throws Unsupported naming a pair of which it cannot
std::vector<DartMaterial> dart_materials(const Scene<3>& scene);

}  // namespace touchstone::engines
