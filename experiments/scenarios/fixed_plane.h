#pragma once

#include <string>
#include <utility>

#include "core/model/scene.h"

namespace touchstone {

/// The ground of most scenarios: a fixed half-space below z = 0, or y = 0 in the plane.
template <int Dim>
Body<Dim> fixed_plane(std::string name) {
  Body<Dim> plane;
  plane.name = std::move(name);
  plane.fixed = true;
  plane.shape.geometry = HalfSpace<Dim>{};
  return plane;
}

}  // namespace touchstone
