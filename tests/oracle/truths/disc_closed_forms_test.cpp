// Do the closed-form loss curves describe what they are derived from? Oracles:
// the exact event-driven polygon for the edge-limited curve, and the
// linearised-gap step itself, idealised to a point, for the step-limited one.
#include "experiments/scenarios/truths/disc_closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/scenarios/truths/rigid_polygon.h"

namespace touchstone::truth {
namespace {

/// Largest distance of the exact polygon's kinetic energy from the closed form on [0, 10] s, times N^2.
double scaled_distance(const RollingDisc& disc, int edges) {
  std::vector<double> times;
  for (int i = 0; i <= 2000; ++i) times.push_back(10.0 * i / 2000.0);
  const PolygonParameters body{.edges = edges, .inertia = disc.inertia, .friction = 5.0};
  const PolygonResult exact = roll_polygon(body, -disc.omega, 0.0, disc.omega, times);
  EXPECT_EQ(exact.status, PolygonStatus::completed);
  EXPECT_FALSE(exact.first_departure.has_value());
  double worst = 0.0;
  for (const PolygonSample& s : exact.samples) {
    worst = std::max(worst, std::abs(s.kinetic - edge_limited_kinetic_energy(disc, edges, s.t)));
  }
  return worst * edges * edges;
}

TEST(EdgeLimited, IsThePaperCurveForThePaperDisc) {
  const double t = 4.0;
  EXPECT_NEAR(edge_limited_kinetic_energy({}, 100, t),
              6.75 / std::pow(1.0 + 2.0 * std::numbers::pi * 3.0 * t / 300.0, 2), 1e-14);
  EXPECT_NEAR(step_limited_kinetic_energy({}, 0.01, t), 6.75 * std::exp(-4.0 / 3.0 * 9.81 * 0.01 * t), 1e-14);
}

TEST(EdgeLimited, ConvergesToTheExactPolygonWithOrderTwoAndNoBetter) {
  for (const double inertia : {0.5, 1.0}) {
    const RollingDisc disc{.inertia = inertia};
    const double reference = scaled_distance(disc, 200);
    for (const int edges : {400, 800, 1600}) {
      const double scaled = scaled_distance(disc, edges);
      EXPECT_LT(scaled, 1.3 * reference) << edges;
      EXPECT_GT(scaled, 0.7 * reference) << edges;
    }
  }
}

TEST(EdgeLimited, WrongInertiaDoesNotConverge) {
  // Negative control: the share of translation matters at order 1/N.
  const RollingDisc ring{.inertia = 1.0};
  const PolygonParameters body{.edges = 800, .inertia = 0.5, .friction = 5.0};
  const PolygonResult exact = roll_polygon(body, -3.0, 0.0, 3.0, {10.0});
  const double relative = exact.samples.back().kinetic / 6.75;
  EXPECT_GT(std::abs(relative - edge_limited_kinetic_energy(ring, 800, 10.0) / ring.kinetic_energy()), 0.01);
}

/// Rolls a disc by the linearised-gap law without small angles: the contact is the point that minimises
/// d + R (1 - cos phi) - h R omega sin phi, at tan(phi) = h omega; rolling is kept at the lowest point.
double stepped_kinetic_energy(const RollingDisc& disc, double h, double end) {
  const double rolling_inertia = disc.inertia + disc.mass * disc.radius * disc.radius;
  double omega = disc.omega;
  for (int k = 0; k < static_cast<int>(std::lround(end / h)); ++k) {
    const double lever = disc.radius * std::sin(std::atan(h * omega));
    omega -= h * disc.mass * disc.gravity * lever / rolling_inertia;
  }
  return 0.5 * rolling_inertia * omega * omega;
}

TEST(StepLimited, IsTheLimitOfTheLinearisedGapStep) {
  const RollingDisc disc;
  std::vector<double> error;
  for (const double h : {0.001, 0.0005}) {
    error.push_back(
        std::abs(stepped_kinetic_energy(disc, h, 2.0) - step_limited_kinetic_energy(disc, h, 2.0)));
    EXPECT_LT(error.back(), 1e-5 * disc.kinetic_energy());
  }
  // The exponent is of order h and its relative error of order h^2: the error falls eightfold.
  EXPECT_NEAR(error[0] / error[1], 8.0, 1.0);
}

}  // namespace
}  // namespace touchstone::truth
