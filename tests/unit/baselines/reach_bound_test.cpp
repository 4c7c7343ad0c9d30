// The bound on nu' against the solutions of steps that had every vertex as a candidate.
#include "baselines/formulations/reach_bound.h"

#include <random>
#include <vector>

#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kRounding = 1e-9;

struct Trial {
  Scene<2> scene;
  std::vector<PlaneBelow<2>> planes;
  double h = 0.0;
};

double least_gap(const Body<2>& polygon, const Body<2>& plane) {
  const auto& shape = std::get<RegularPolygon>(polygon.shape.geometry);
  const Vector<2> normal = std::get<HalfSpace<2>>(plane.shape.geometry).normal;
  double least = 1e300;
  for (int k = 0; k < shape.edges; ++k) {
    least = std::min(least, normal.dot(polygon.pose.to_world(shape.vertex(k)) - plane.pose.position));
  }
  return least;
}

/// A polygon that moves at random close to, or a little in, one or two half-spaces.
Trial random_trial(std::mt19937& random, int plane_count) {
  std::uniform_real_distribution<double> real(-1, 1);
  Trial trial;
  trial.h = std::pow(10.0, -2 + real(random));
  Body<2> polygon = body<2>("polygon", {RegularPolygon{std::uniform_int_distribution(3, 40)(random), 1.0}},
                            {1 + 0.05 * real(random), 1 + 0.05 * real(random)});
  polygon.pose.rotation = PlanarRotation(3 * real(random));
  polygon.inertia << 0.5;
  polygon.velocity << 4 * real(random), 4 * real(random), 6 * real(random);
  trial.scene = scene<2>(0.5 + 0.5 * real(random), {polygon, ground<2>()});
  if (plane_count == 2) trial.scene.bodies.push_back(wall<2>("wall", {1, 0}, {0, 0}));
  for (int p = 1; p <= plane_count; ++p) {
    const Body<2>& plane = trial.scene.bodies[static_cast<std::size_t>(p)];
    trial.planes.push_back({std::get<HalfSpace<2>>(plane.shape.geometry).normal, least_gap(polygon, plane),
                            trial.scene.contact_law.mu});
  }
  return trial;
}

/// Solves one step with all vertices and checks every bound at its velocity. Returns whether there was a
/// bound.
bool check(const Trial& trial) {
  const Body<2>& polygon = trial.scene.bodies[0];
  const auto method = make_stewart_trinkle<2>(trial.scene, {{"candidates", "all"}});
  Twist<2> free = polygon.velocity;
  free[1] -= trial.h * kGravity;
  const ReachBound<2> bound(polygon.mass, polygon.inertia, free, trial.planes, trial.h);
  if (method->step(trial.h).status != StepStatus::solved || !bound.known()) return false;
  const Twist<2> nu = method->state()[0].velocity;
  const double slack = kRounding * (1 + free.norm());
  EXPECT_LE(bound.least_turn(Angular<2>(1.0)), nu[2] + slack);
  EXPECT_LE(bound.least_turn(Angular<2>(-1.0)), -nu[2] + slack);
  const auto& shape = std::get<RegularPolygon>(polygon.shape.geometry);
  for (const auto& plane : trial.planes) {
    EXPECT_LE(bound.least_normal_speed(plane.normal), plane.normal.dot(nu.head<2>()) + slack);
    for (int k = 0; k < shape.edges; ++k) {
      const Vector<2> arm = polygon.pose.rotation.matrix() * shape.vertex(k);
      const double rate = plane.normal.dot(point_velocity<2>(nu, arm));
      EXPECT_LE(bound.least_gap_rate(plane.normal, arm), rate + slack) << "vertex " << k;
    }
  }
  return true;
}

TEST(ReachBound, HoldsAtTheSolutionAboveOneHalfSpace) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    EXPECT_TRUE(check(random_trial(random, 1))) << "trial " << trial;
  }
}

TEST(ReachBound, HoldsAtTheSolutionInACorner) {
  std::mt19937 random(4);
  int bounded = 0;
  for (int trial = 0; trial < 1000; ++trial) bounded += check(random_trial(random, 2)) ? 1 : 0;
  EXPECT_GE(bounded, 500);
}

// Closed form: without penetration the energy of the free motion bounds omega', and centre and radius are
// both nu_f / 2.
TEST(ReachBound, IsTheEnergyBallWithoutPenetration) {
  const std::vector<PlaneBelow<2>> planes = {{Vector<2>(0, 1), 0.0, 0.4}};
  const ReachBound<2> bound(2.0, Inertia<2>(0.5), Twist<2>(-3, -0.1, 3), planes, 0.01);
  ASSERT_TRUE(bound.known());
  const double radius = std::sqrt(2.0 * (9 + 0.01) + 0.5 * 9) / 2;
  EXPECT_NEAR(bound.least_turn(Angular<2>(1.0)), 1.5 - radius / std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(bound.least_turn(Angular<2>(-2.0)), -3.0 - 2 * radius / std::sqrt(0.5), 1e-14);
  EXPECT_DOUBLE_EQ(bound.least_normal_speed({0, 1}), -0.1);  // normal impulses only push
}

TEST(ReachBound, IsUnknownBetweenWallsThatOverlapTheBody) {
  const std::vector<PlaneBelow<2>> planes = {{Vector<2>(0, 1), -0.1, 0.4}, {Vector<2>(0, -1), -0.2, 0.4}};
  EXPECT_FALSE(ReachBound<2>(1.0, Inertia<2>(0.5), Twist<2>(0, 0, 0), planes, 0.01).known());
}

// Friction at a wall that the body is lifted along could push it further: only with a gap to spare is there a
// bound.
TEST(ReachBound, NeedsRoomWhereTheLiftSlidesAlongAWall) {
  const auto known = [](double gap) {
    const std::vector<PlaneBelow<2>> planes = {{Vector<2>(0, 1), -0.1, 0.4}, {Vector<2>(1, 0), gap, 0.4}};
    return ReachBound<2>(1.0, Inertia<2>(0.5), Twist<2>(0, 0, 0), planes, 0.01).known();
  };
  EXPECT_FALSE(known(0.0399));
  EXPECT_TRUE(known(0.0401));
}

}  // namespace
}  // namespace touchstone::testing
