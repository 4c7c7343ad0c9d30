#include "experiments/scenarios/truths/box_on_incline.h"

#include <Eigen/Dense>
#include <optional>
#include <stdexcept>

#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {

namespace {

using Start = BlockOnIncline::Start;

/// a_s, a_n, alpha, F, N, x N. The moment of the normal force is an unknown of its own, so that the equations
/// are linear.
enum Unknown { kAlong, kOff, kAngular, kFriction, kNormal, kMoment, kUnknowns };
using System = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

/// The three equations of motion, in rows 0 to 2, and what closes `mode`, in rows 3 to 5.
Unknowns solve(const BlockOnIncline& block, Start mode) {
  const double b = block.base;
  const double h = block.height;
  System m = System::Zero();
  Unknowns right = Unknowns::Zero();
  m(0, kAlong) = 1, m(0, kFriction) = 1, right[0] = block.gravity * std::sin(block.theta);
  m(1, kOff) = 1, m(1, kNormal) = -1, right[1] = -block.gravity * std::cos(block.theta);
  m(2, kAngular) = (b * b + h * h) / 12, m(2, kFriction) = -h / 2, m(2, kMoment) = 1;

  const bool tips = mode == Start::tips || mode == Start::tips_and_slides;
  const bool slides = mode == Start::slides || mode == Start::tips_and_slides;
  m(3, kOff) = 1, m(3, kAngular) = tips ? -b / 2 : 0;  // the lower edge stays on the slope
  if (tips) {
    m(4, kMoment) = 1, m(4, kNormal) = -b / 2;  // ... and alone carries
  } else {
    m(4, kAngular) = 1;
  }
  if (slides) {
    m(5, kFriction) = 1, m(5, kNormal) = -block.friction;
  } else {
    m(5, kAlong) = 1, m(5, kAngular) = -h / 2;
  }
  return m.fullPivLu().solve(right);
}

BlockRelease in_mode(const BlockOnIncline& block, Start mode) {
  const Unknowns z = solve(block, mode);
  BlockRelease release;
  release.mode = mode;
  release.center_along = z[kAlong], release.center_off = z[kOff], release.angular = z[kAngular];
  release.friction = z[kFriction], release.normal_force = z[kNormal];
  release.edge_along = z[kAlong] - z[kAngular] * block.height / 2;
  release.pressure_at = z[kMoment] / z[kNormal];
  return release;
}

bool is_consistent(const BlockOnIncline& block, const BlockRelease& r) {
  const bool held = std::abs(r.friction) <= block.friction * r.normal_force;
  const bool within = std::abs(r.pressure_at) <= block.base / 2;
  switch (r.mode) {
    case Start::rests:
      return held && within;
    case Start::slides:
      return r.edge_along > 0 && within;
    case Start::tips:
      return r.angular > 0 && r.normal_force >= 0 && held;
    case Start::tips_and_slides:
      return r.angular > 0 && r.normal_force >= 0 && r.edge_along > 0;
  }
  throw std::logic_error("release: no such mode");
}

/// What a mode makes zero by its definition is zero, and not what is left of it by the elimination.
BlockRelease cleaned(BlockRelease r) {
  const bool tips = r.mode == Start::tips || r.mode == Start::tips_and_slides;
  const bool slides = r.mode == Start::slides || r.mode == Start::tips_and_slides;
  if (!tips) r.angular = 0, r.center_off = 0;
  if (!slides) r.edge_along = 0;
  if (r.mode == Start::rests) r.center_along = 0;
  return r;
}

}  // namespace

BlockRelease release(const BlockOnIncline& block) {
  require(block.base > 0.0, "base", block.base, "> 0");
  require(block.height > 0.0, "height", block.height, "> 0");
  require(block.friction >= 0.0, "friction", block.friction, ">= 0");
  require(block.theta >= 0.0 && block.theta < 1.57, "theta", block.theta, "in [0, 1.57)");
  require(block.gravity > 0.0, "gravity", block.gravity, "> 0");
  std::optional<BlockRelease> found;
  int consistent = 0;
  for (const Start mode : {Start::rests, Start::slides, Start::tips, Start::tips_and_slides}) {
    const BlockRelease candidate = in_mode(block, mode);
    if (!is_consistent(block, candidate)) continue;
    ++consistent;
    if (!found) found = cleaned(candidate);
  }
  if (!found) throw std::domain_error("release: no mode is consistent");
  found->consistent_modes = consistent;
  return *found;
}

}  // namespace touchstone::truth
