// The paper's Fig. 1: the rolling disc as a polygon. Oracles: the closed-form losses of the scheme
// (step-limited) and of the rigid polygon (edge-limited), neither of which knows of an LCP.
#include <numbers>
#include <vector>

#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kInertia = 0.5;
constexpr double kStartEnergy = 6.75;
constexpr double kSpin = 3.0;

/// KE0 exp(-(4/3) g h t / R): every vertex that the step passes is held to its tangent.
double step_limited(double h, double t) { return kStartEnergy * std::exp(-4.0 / 3 * kGravity * h * t); }

/// KE0 / (1 + 2 pi omega0 t / (3 N))^2: what a rigid polygon of many edges loses at its vertex impacts.
double edge_limited(int edges, double t) {
  return kStartEnergy / std::pow(1 + 2 * std::numbers::pi * kSpin * t / (3 * edges), 2);
}

double energy_after(int edges, const std::string& candidates, double h, double t) {
  const auto method =
      make_stewart_trinkle<2>(rolling_disc(), {{"edges", std::to_string(edges)}, {"candidates", candidates}});
  advance(*method, h, static_cast<int>(std::lround(t / h)));
  return kinetic_energy(method->state()[0], kInertia);
}

TEST(StewartTrinkleRolling, LosesWhatTheStepAsks) {
  const double exact = step_limited(0.01, 5.0);
  EXPECT_NEAR(energy_after(1000, "reachable", 0.01, 5.0), exact, 0.005 * exact);
}

TEST(StewartTrinkleRolling, LosesWhatTheEdgesAsk) {
  const double exact = edge_limited(1000, 2.0);
  EXPECT_NEAR(energy_after(1000, "reachable", 0.0002, 2.0), exact, 0.005 * exact);
}

TEST(StewartTrinkleRolling, LosesLessWithMoreEdgesDownToTheFloor) {
  const double floor = step_limited(0.01, 5.0);
  double before = 0.0;
  for (const int edges : {10, 20, 30, 50, 100, 200}) {
    const double energy = energy_after(edges, "reachable", 0.01, 5.0);
    EXPECT_GT(energy, before) << edges;
    before = energy;
  }
  for (const int edges : {200, 500, 1000}) {
    EXPECT_NEAR(energy_after(edges, "reachable", 0.01, 5.0), floor, 0.01 * floor) << edges;
  }
}

TEST(StewartTrinkleRolling, LosesLessWithASmallerStepDownToTheEdgesLimit) {
  const double limit = edge_limited(1000, 2.0);
  double before = 0.0;
  for (const double h : {0.05, 0.01, 0.005, 0.001, 0.0005, 0.0001}) {
    const double energy = energy_after(1000, "reachable", h, 2.0);
    EXPECT_GT(energy, before) << h;
    EXPECT_LE(energy, 1.001 * limit) << h;
    if (h <= 0.0005) {
      EXPECT_NEAR(energy, limit, 0.005 * limit) << h;
    }
    before = energy;
  }
}

// Seeing one vertex only, what a step loses depends on where its vertex happens to be: the paper's first plot
// would not come out.
TEST(StewartTrinkleRolling, IsNotMonotoneWithOneVertex) {
  const double at_200 = energy_after(200, "nearest:1", 0.01, 5.0);
  const double at_500 = energy_after(500, "nearest:1", 0.01, 5.0);
  EXPECT_LT(at_500, at_200 - 0.05);
  EXPECT_GT(energy_after(1000, "nearest:1", 0.01, 5.0), at_500 + 0.05);
}

// A distance well above R (omega h)^2 / 2 = 4.5e-4 sees what the step sees; one below does not.
TEST(StewartTrinkleRolling, NeedsEpsilonAboveWhatTheStepLifts) {
  const double reachable = energy_after(1000, "reachable", 0.01, 2.0);
  EXPECT_EQ(energy_after(1000, "epsilon:0.01", 0.01, 2.0), reachable);
  EXPECT_GT(energy_after(1000, "epsilon:1e-4", 0.01, 2.0), 1.01 * reachable);
}

struct Start {
  const char* name;
  double mu;
  Vector<2> position;
  Twist<2> velocity;
};

/// Largest difference of the trajectories with `reachable` and with `all`.
double policy_difference(const Scene<2>& scene, int edges, double h, int steps) {
  const auto few = make_stewart_trinkle<2>(scene, {{"edges", std::to_string(edges)}});
  const auto all = make_stewart_trinkle<2>(scene, {{"edges", std::to_string(edges)}, {"candidates", "all"}});
  double largest = 0.0;
  for (int k = 0; k < steps; ++k) {
    advance(*few, h, 1);
    advance(*all, h, 1);
    largest = std::max(largest, difference(few->state()[0], all->state()[0]));
  }
  return largest;
}

// Not to 1e-12 only: what is out of reach takes no part in the computation, so the trajectories are the same
// numbers.
TEST(StewartTrinkleRolling, ReachableIsAll) {
  const std::vector<Start> starts = {{"rolling", 0.4, {0, 1}, {-3, 0, 3}},
                                     {"dropped with spin", 0.4, {0, 1.3}, {-3, 0, -8}},
                                     {"inside the ground", 0.1, {0, 0.9}, {1, 0, 2}},
                                     {"frictionless", 0.0, {0, 1}, {2, 0, 1}}};
  for (const Start& start : starts) {
    const Scene<2> both = scene<2>(start.mu, {disc("disc", start.position, start.velocity), ground<2>()});
    for (const int edges : {3, 10, 37, 50, 200}) {
      for (const double h : {0.05, 0.01, 0.001}) {
        EXPECT_EQ(policy_difference(both, edges, h, 200), 0.0)
            << start.name << ", N = " << edges << ", h = " << h;
      }
    }
  }
  EXPECT_EQ(policy_difference(rolling_disc(), 1000, 0.01, 200), 0.0);
}

TEST(StewartTrinkleRolling, ReachableIsAllBetweenWalls) {
  Scene<2> corner = scene<2>(0.4, {disc("disc", {1.05, 1.5}, {-3, -2, 10}), ground<2>()});
  corner.bodies.push_back(wall<2>("wall", {1, 0}, {0, 0}));
  for (const int edges : {7, 50, 200}) EXPECT_EQ(policy_difference(corner, edges, 0.01, 200), 0.0) << edges;
  corner.bodies[0].pose.position = {0.95, 0.9};  // inside both: whether a bound is known depends on friction
  for (const int edges : {7, 50, 200}) EXPECT_EQ(policy_difference(corner, edges, 0.01, 200), 0.0) << edges;
}

}  // namespace
}  // namespace touchstone::testing
