#pragma once

#include <optional>
#include <vector>

#include "experiments/scenarios/truths/rigid_polygon.h"

/// Flight of the rigid polygon between two contacts, in closed form.
namespace touchstone::truth::polygon {

/// A vertex on the ground. Vertex k is at theta + 2 pi k / N from straight down; k
/// counts on beyond N, so that theta = alpha - 2 pi k / N keeps the revolutions.
struct Touching {
  long long vertex = 0;
  double alpha = 0.0;  ///< angle from straight below the centre, in [-pi/N, pi/N] for the lowest vertex [rad]
};

struct TouchDown {
  double elapsed = 0.0;            ///< since the flight began [s]
  std::vector<Touching> touching;  ///< one vertex, or the two of an edge
};

/// Free motion for `elapsed` [s]: gravity, constant omega.
PlanarMotion flown(const PolygonParameters& body, PlanarMotion motion, double elapsed);

/// When and where the polygon next comes down, or none before `horizon` [s, from now]. Vertices that
/// are on the ground at the start must be leaving it (normal velocity, or else acceleration, upward).
///
/// The height of a vertex, f(t) = y(t) - R cos(alpha + omega t), has f'' >= -(g + R
/// omega^2), so that f stays positive until the parabola with that second derivative is
/// down: repeated, this converges quadratically to the FIRST root and cannot pass it.
std::optional<TouchDown> touch_down(const PolygonParameters& body, const PlanarMotion& start, double horizon);

}  // namespace touchstone::truth::polygon
