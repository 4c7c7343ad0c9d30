#include "baselines/formulations/candidate_selection.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "baselines/approximation.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

using Kind = CandidatePolicy::Kind;

std::vector<ContactCandidate<2>> candidates(const Scene<2>& scene, const CandidatePolicy& policy, double h) {
  const ContactGeometry<2> geometry(scene);
  CandidateSelection<2> selection(geometry, policy, std::vector<double>(geometry.pairs().size(), 0.4));
  const auto state = initial_state(scene);
  std::vector<Twist<2>> free;
  for (const auto& s : state) free.push_back(s.velocity);
  std::vector<ContactCandidate<2>> result;
  selection.select(state, free, h, result);
  EXPECT_TRUE(std::is_sorted(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::pair(a.pair, a.vertex) < std::pair(b.pair, b.vertex);
  }));
  return result;
}

std::vector<int> selected(const Scene<2>& scene, const CandidatePolicy& policy, double h = 0.01) {
  std::vector<int> vertices;
  for (const auto& candidate : candidates(scene, policy, h)) vertices.push_back(candidate.vertex);
  return vertices;
}

Scene<2> with_shape(const Shape<2>& shape, double height, const Twist<2>& velocity) {
  Body<2> moving = body<2>("moving", shape, {0, height});
  moving.velocity = velocity;
  return scene<2>(0.4, {moving, ground<2>()});
}

TEST(CandidateSelection, TakesAllVertices) {
  EXPECT_EQ(selected(with_shape({RegularPolygon{5, 1.0}}, 9, {0, 0, 0}), {Kind::all, 0, 0}).size(), 5U);
  EXPECT_EQ(selected(with_shape({Box<2>{}}, 9, {0, 0, 0}), {Kind::all, 0, 0}).size(), 4U);
}

TEST(CandidateSelection, TakesTheNearest) {
  const Scene<2> polygon = with_shape({RegularPolygon{12, 1.0}, {{0, 0}, PlanarRotation(0.1)}}, 1, {0, 0, 0});
  EXPECT_EQ(selected(polygon, {Kind::nearest, 1, 0}), std::vector<int>({0}));
  EXPECT_EQ(selected(polygon, {Kind::nearest, 2, 0}),
            std::vector<int>({0, 11}));  // turned left: 11 is lower than 1
  EXPECT_EQ(selected(polygon, {Kind::nearest, 99, 0}).size(), 12U);
  Scene<2> box = with_shape({Box<2>{{1.0, 1.0}}}, 2, {0, 0, 0});
  box.bodies[0].pose.rotation = PlanarRotation(0.1);  // corners: 0 (-,-), 1 (+,-), 2 (-,+), 3 (+,+)
  EXPECT_EQ(selected(box, {Kind::nearest, 1, 0}), std::vector<int>({0}));
  EXPECT_EQ(selected(box, {Kind::nearest, 2, 0}), std::vector<int>({0, 1}));
}

// Oracle: the heights of the vertices, R (1 - cos(2 pi k / N)).
TEST(CandidateSelection, TakesThoseWithinADistance) {
  const Scene<2> polygon = with_shape({RegularPolygon{1000, 1.0}}, 1, {0, 0, 0});
  for (const double distance : {0.0, 1e-6, 1e-3, 0.5, 1.999}) {
    std::size_t count = 0;
    for (int k = 0; k < 1000; ++k) count += 1 - std::cos(2 * std::numbers::pi * k / 1000) <= distance ? 1 : 0;
    EXPECT_EQ(selected(polygon, {Kind::epsilon, 0, distance}).size(), count) << distance;
  }
  EXPECT_TRUE(
      selected(with_shape({RegularPolygon{1000, 1.0}}, 1.1, {0, 0, 0}), {Kind::epsilon, 0, 0.05}).empty());
}

TEST(CandidateSelection, LeavesOutASmoothBodyOnlyBeyondEpsilon) {
  const Scene<2> high = with_shape({Sphere<2>{1.0}}, 1.5, {0, 0, 0});
  EXPECT_EQ(selected(high, {Kind::epsilon, 0, 0.4}).size(), 0U);
  EXPECT_EQ(selected(high, {Kind::epsilon, 0, 0.6}).size(), 1U);
  EXPECT_EQ(selected(high, {Kind::reachable, 0, 0}).size(), 1U);
}

// The paper's disc can bring down vertices up to 2 h omega' ahead, omega' <= 1.5 + sqrt(13.5 / 2) = 4.1 by
// the energy bound, and as far behind with omega' >= -1.1: 0.104 rad of 2 pi, 17 of 1000 vertices.
TEST(CandidateSelection, ReachesFewOfManyVertices) {
  const Scene<2> rolling = with_polygons(rolling_disc(), 1000);
  const std::size_t count = selected(rolling, {Kind::reachable, 0, 0}).size();
  EXPECT_GE(count, 5U);  // those within omega h = 0.03 rad ahead are held in fact
  EXPECT_LE(count, 30U);
  EXPECT_LE(selected(rolling, {Kind::reachable, 0, 0}, 1e-4).size(), 3U);
}

TEST(CandidateSelection, ReachesNothingInFlight) {
  EXPECT_TRUE(
      selected(with_shape({RegularPolygon{50, 1.0}}, 2, {1, -3, 5}), {Kind::reachable, 0, 0}).empty());
  EXPECT_TRUE(selected(with_shape({Box<2>{{1.0, 1.0}}}, 2, {1, -3, 5}), {Kind::reachable, 0, 0}).empty());
}

TEST(CandidateSelection, TakesEverythingWhereNoBoundIsKnown) {
  Scene<2> jammed = scene<2>(0.4, {body<2>("moving", {RegularPolygon{20, 1.0}}, {0, 0.9}), ground<2>()});
  EXPECT_LT(selected(jammed, {Kind::reachable, 0, 0}).size(), 20U);
  jammed.bodies.push_back(wall<2>("ceiling", {0, -1}, {0, 1.8}));
  EXPECT_EQ(selected(jammed, {Kind::reachable, 0, 0}).size(), 40U);
}

}  // namespace
}  // namespace touchstone::testing
