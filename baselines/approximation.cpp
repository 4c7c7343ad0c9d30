#include "baselines/approximation.h"

#include "core/model/errors.h"

namespace touchstone {

Scene<2> with_polygons(Scene<2> scene, int edges) {
  if (edges < 3) throw InputError("edges", std::to_string(edges), "an integer >= 3");
  for (auto& body : scene.bodies) {
    const auto* disc = std::get_if<Sphere<2>>(&body.shape.geometry);
    if (disc != nullptr && !body.fixed) body.shape.geometry = RegularPolygon{edges, disc->radius};
  }
  return scene;
}

}  // namespace touchstone
