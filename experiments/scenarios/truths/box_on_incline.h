#pragma once

#include "experiments/scenarios/truths/rolling_and_sliding.h"

namespace touchstone::truth {

/// How a uniform block that is put at rest on an incline begins to move, per unit mass. SI units; s points
/// down the slope, n out of it, and angles are positive as when the block tips down the slope.
struct BlockRelease {
  BlockOnIncline::Start mode = BlockOnIncline::Start::rests;
  double center_along = 0.0;  ///< acceleration of the centre along s [m/s^2]
  double center_off = 0.0;    ///< ... and along n: it is raised as the block tips [m/s^2]
  double angular = 0.0;       ///< [rad/s^2]; > 0 only if it tips
  double edge_along = 0.0;    ///< acceleration of the lower edge along s [m/s^2]; > 0 only if it slides
  double normal_force = 0.0;  ///< over the mass [m/s^2]
  double friction = 0.0;      ///< over the mass, up the slope [m/s^2]
  double pressure_at = 0.0;   ///< where the resultant acts, along s from the middle of the base [m]
  int consistent_modes = 0;   ///< how many of the four modes satisfy all their inequalities; 1 but for ties
};

/// Solves the three equations of plane motion in each of the four modes and takes the one whose inequalities
/// hold (the first, on a tie). With the contact's resultant (-F, N) at x from the middle of the base,
///
///   a_s = g sin(theta) - F,   a_n = N - g cos(theta),   (b^2 + h^2)/12 alpha = F h/2 - N x,
///
/// and the lower edge, at (b/2, -h/2) from the centre, moves with (a_s - alpha h/2, a_n - alpha b/2).
///
///   mode             closed by                         consistent iff
///   rests            a_s = 0, a_n = 0, alpha = 0       |F| <= mu N, |x| <= b/2
///   slides           F = mu N, a_n = 0, alpha = 0      a_s > 0, |x| <= b/2
///   tips             edge at rest, x = b/2             alpha > 0, N >= 0, |F| <= mu N
///   tips_and_slides  a_n = alpha b/2, F = mu N, x=b/2  alpha > 0, N >= 0, the edge moves along +s
///
/// These are the accelerations of the instant of release: nothing is said of later, when the block has
/// turned.
/// @throws std::invalid_argument naming the field and the bound; std::domain_error if no mode is consistent
BlockRelease release(const BlockOnIncline& block);

}  // namespace touchstone::truth
