#include "baselines/formulations/polygon_arc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <set>
#include <vector>

namespace touchstone {
namespace {

/// Vertex k from the polygon's centre, from the shape's own definition.
Vector<2> arm(const PlacedPolygon& polygon, int k) {
  return PlanarRotation(polygon.turn).matrix() *
         RegularPolygon{polygon.edges, polygon.circumradius}.vertex(k);
}

std::vector<int> members(const VertexArc& arc, int edges) {
  std::vector<int> result;
  for_each_vertex(arc, edges, [&](int k) { result.push_back(k); });
  return result;
}

PlacedPolygon random_polygon(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-50, 50);
  return {std::uniform_int_distribution(3, 60)(random), std::uniform_real_distribution(0.1, 3.0)(random),
          Vector<2>(angle(random), angle(random)), angle(random)};
}

// Oracle: every vertex looked at. The arc has all that are below and at most two more.
TEST(PolygonArc, FindsAllVerticesBelowALine) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> real(-1.5, 1.5);
  for (int trial = 0; trial < 5000; ++trial) {
    const PlacedPolygon polygon = random_polygon(random);
    const Vector<2> slope(real(random), real(random));
    const double level = real(random) * slope.norm() * polygon.circumradius;
    std::set<int> below_level;
    for (int k = 0; k < polygon.edges; ++k) {
      if (slope.dot(arm(polygon, k)) <= level) below_level.insert(k);
    }
    const std::vector<int> arc =
        members(vertices_within(polygon, below(polygon, slope, level, 10.0)), polygon.edges);
    EXPECT_TRUE(std::is_sorted(arc.begin(), arc.end()));
    EXPECT_TRUE(std::includes(arc.begin(), arc.end(), below_level.begin(), below_level.end()))
        << "trial " << trial;
    const bool everything = static_cast<int>(arc.size()) == polygon.edges;
    EXPECT_TRUE(everything ? below_level.size() + 4 >= arc.size() : below_level.size() + 2 >= arc.size())
        << "trial " << trial << ": " << arc.size() << " of " << polygon.edges << " for "
        << below_level.size();
  }
}

TEST(PolygonArc, FindsTheNearestVertices) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    const PlacedPolygon polygon = random_polygon(random);
    const Vector<2> slope = Vector<2>::Random();
    const int count = std::uniform_int_distribution(1, polygon.edges + 3)(random);
    std::vector<double> heights;
    for (int k = 0; k < polygon.edges; ++k) heights.push_back(slope.dot(arm(polygon, k)));
    std::sort(heights.begin(), heights.end());
    const auto arc = members(vertices_nearest(polygon, lowest_angle(slope), count), polygon.edges);
    ASSERT_EQ(static_cast<int>(arc.size()), std::min(count, polygon.edges));
    double highest = -1e300;
    for (const int k : arc) highest = std::max(highest, slope.dot(arm(polygon, k)));
    EXPECT_NEAR(highest, heights[arc.size() - 1], 1e-12) << "trial " << trial;
  }
}

TEST(PolygonArc, BreaksATieTowardsTheSmallerAngle) {
  const PlacedPolygon polygon{8, 1.0, Vector<2>::Zero(), 0.0};
  EXPECT_EQ(members(vertices_nearest(polygon, 0.0, 1), 8), std::vector<int>({0}));
  EXPECT_EQ(members(vertices_nearest(polygon, 0.0, 2), 8), std::vector<int>({0, 7}));
  EXPECT_EQ(members(vertices_nearest(polygon, 0.0, 3), 8), std::vector<int>({0, 1, 7}));
}

TEST(PolygonArc, IsEmptyAboveTheCircleAndWholeBelowIt) {
  const PlacedPolygon polygon{12, 2.0, Vector<2>::Zero(), 0.3};
  EXPECT_EQ(vertices_within(polygon, below(polygon, {0, 1}, -2.01, 0.0)).count, 0);
  EXPECT_EQ(vertices_within(polygon, below(polygon, {0, 1}, 2.01, 0.0)).count, 12);
}

TEST(PolygonArc, HullHoldsBothIntervals) {
  const AngleInterval hulled = hull({-1.0, -0.5}, {0.25, 0.75});
  EXPECT_EQ(hulled.low, -1.0);
  EXPECT_EQ(hulled.high, 0.75);
  EXPECT_EQ(hull({}, {0.25, 0.75}).low, 0.25);
  EXPECT_TRUE(hull({}, {}).empty());
}

}  // namespace
}  // namespace touchstone
