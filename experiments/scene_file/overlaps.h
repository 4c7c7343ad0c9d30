#pragma once

#include <optional>

#include "core/model/scene.h"

namespace touchstone::scene_file {

/// Two bodies of a scene that overlap where they start.
struct Overlap {
  int body_a = 0;
  int body_b = 0;
  double depth = 0.0;    ///< [m]
  double allowed = 0.0;  ///< 1e-9 of the smaller body's size: what rounding makes of touching [m]
};

/// The first two bodies that may collide and overlap by more than is allowed. Two fixed bodies may not
/// collide, nor two that a joint couples.
template <int Dim>
std::optional<Overlap> find_overlap(const Scene<Dim>& scene);

}  // namespace touchstone::scene_file
