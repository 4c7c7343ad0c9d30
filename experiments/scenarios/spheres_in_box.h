#pragma once

#include <cstdint>

#include "core/model/scene.h"

/// Spheres that are let go in an open box and come to rest in a heap: a problem of many contacts.
namespace touchstone {

/// Of two kinds. In a cube, which grows with the spheres in all three directions, a heap of n spheres is
/// about as deep as it is wide, and its contacts carry each other's load over n^(1/3) layers. In a tray,
/// which grows in width alone, there are as many layers whatever n is, and contacts for each sphere. In both
/// the contacts of most spheres form one island.
struct SpheresInBox {
  int spheres = 100;              ///< n, >= 1
  double mass = 1.0;              ///< of each [kg]
  double largest_radius = 0.1;    ///< [m]
  double smallest_radius = 0.08;  ///< radii are spread evenly between the two [m]
  double mu = 0.3;                ///< between spheres, and with floor and walls; no torsion
  double gravity = 9.81;          ///< [m/s^2]
  std::uint64_t seed = 1;         ///< of radii and places
  int layers = 0;                 ///< of a tray, >= 1; 0: a cube

  /// How many spheres of the largest radius fit side by side along x.
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
