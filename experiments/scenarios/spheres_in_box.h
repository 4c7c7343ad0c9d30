#pragma once

#include <cstdint>

#include "core/model/scene.h"

/// Spheres that are let go in an open box and come to rest in a heap: a problem of many contacts.
namespace touchstone {

/// The box grows with the spheres in all three directions: a heap of n spheres is about as deep as it is
/// wide, so that its contacts form one island and carry each other's load over n^(1/3) layers. With a box of
/// constant depth more spheres would only be more of the same.
struct SpheresInBox {
  int spheres = 100;              ///< n, >= 1
  double mass = 1.0;              ///< of each [kg]
  double largest_radius = 0.1;    ///< [m]
  double smallest_radius = 0.08;  ///< radii are spread evenly between the two [m]
  double mu = 0.3;                ///< between spheres, and with floor and walls; no torsion
  double gravity = 9.81;          ///< [m/s^2]
  std::uint64_t seed = 1;         ///< of radii and places

  /// How many spheres of the largest radius fit side by side along x: of a heap that is as deep as wide.
  [[nodiscard]] int spheres_along_edge() const;
  /// Inner width of the box along x and y [m].
  [[nodiscard]] double width() const;
};

/// Bodies "sphere 1" ... "sphere n" and then the half-spaces "floor" (z <= 0) and "wall -x", "wall +x", "wall
/// -y", "wall +y". The spheres are at rest in layers, each in the hollows of the one below, off their places
/// by at most what keeps them apart; no two overlap.
/// @throws InputError if the parameters make no sense
Scene<3> spheres_in_box_scene(const SpheresInBox& parameters = {});

}  // namespace touchstone
