#include "baselines/formulations/contact_candidates.h"

#include <random>

#include "core/model/errors.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr int kNoVertex = ContactCandidate<2>::no_vertex;

/// The only candidate of a scene of two bodies.
template <int Dim>
ContactPoints<Dim> only_candidate(const Scene<Dim>& scene) {
  const ContactGeometry<Dim> geometry(scene);
  EXPECT_EQ(geometry.pairs().size(), 1U);
  EXPECT_EQ(geometry.candidate_count(), 1);
  return geometry.points(geometry.pairs()[0], kNoVertex, initial_state(scene));
}

// Oracle: the ellipse's own equation. The point is on it, its gradient is along -n, and the gap is its
// distance.
TEST(ClosestPoints, OfAnEllipseAboveATiltedHalfSpace) {
  const Vector<2> normal = Vector<2>(-0.6, 0.8);
  Body<2> ellipse =
      body<2>("ellipse", {Ellipsoid<2>{{2.0, 0.5}}, {{0.3, -0.1}, PlanarRotation(0.4)}}, {1, 5});
  ellipse.pose.rotation = PlanarRotation(-1.1);
  const Scene<2> both = scene<2>(0.5, {ellipse, wall<2>("plane", normal, {0.2, 0.1})});
  const ContactPoints<2> points = only_candidate(both);
  const Vector<2> local = PlanarRotation(0.4).matrix().transpose() *
                          (ellipse.pose.to_body(points.point_a) - Vector<2>(0.3, -0.1));
  EXPECT_NEAR(local.cwiseQuotient(Vector<2>(2.0, 0.5)).squaredNorm(), 1.0, 1e-12);
  const Vector<2> gradient =
      (ellipse.pose.rotation * PlanarRotation(0.4)).matrix() * local.cwiseQuotient(Vector<2>(4.0, 0.25));
  EXPECT_NEAR((gradient.normalized() + normal).norm(), 0.0, 1e-12);
  EXPECT_NEAR(normal.dot(points.point_a - Vector<2>(0.2, 0.1)), points.gap, 1e-12);
  EXPECT_NEAR(normal.dot(points.point_b - Vector<2>(0.2, 0.1)), 0.0, 1e-12);
  EXPECT_NEAR((points.point_a - points.point_b - points.gap * normal).norm(), 0.0, 1e-12);
}

TEST(ClosestPoints, OfTwoBallsApartAndOverlapping) {
  for (const double distance : {2.5, 1.5}) {
    const Scene<3> both = scene<3>(0.5, {ball("a", {0, 0, 0}), ball("b", distance * Vector<3>(0.6, 0, 0.8))});
    const ContactPoints<3> points = only_candidate(both);
    EXPECT_NEAR(points.gap, distance - 2, 1e-12);
    EXPECT_NEAR((points.normal + Vector<3>(0.6, 0, 0.8)).norm(), 0.0, 1e-12) << "from b into a";
    EXPECT_NEAR((points.point_a - Vector<3>(0.6, 0, 0.8)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((points.point_a - points.point_b - points.gap * points.normal).norm(), 0.0, 1e-12);
  }
}

TEST(ClosestPoints, OfConcentricBallsHaveANormal) {
  const ContactPoints<3> points = only_candidate(scene<3>(0.5, {ball("a", {1, 2, 3}), ball("b", {1, 2, 3})}));
  EXPECT_NEAR(points.normal.norm(), 1.0, 1e-15);
  EXPECT_EQ(points.gap, -2.0);
}

/// Two smooth bodies, by number, the first turned and placed at random: what the general query is for.
std::pair<Shape<3>, Shape<3>> smooth_pair(int which) {
  const Shape<3> ellipsoid{Ellipsoid<3>{{1.5, 0.7, 1.0}}, {}};
  const Shape<3> superellipsoid{Superellipsoid<3>{{0.8, 1.2, 1.0}, {3.0, 4.0, 2.0}}, {{0.1, 0, 0.2}, {}}};
  const Shape<3> capsule{Capsule{0.5, 1.0}, {}};
  const Shape<3> sphere{Sphere<3>{0.6}, {}};
  const std::pair<Shape<3>, Shape<3>> pairs[] = {{ellipsoid, ellipsoid},
                                                 {ellipsoid, sphere},
                                                 {superellipsoid, ellipsoid},
                                                 {sphere, superellipsoid},
                                                 {capsule, ellipsoid},
                                                 {sphere, capsule},
                                                 {superellipsoid, {HalfSpace<3>{}, {}}}};
  return pairs[which % 7];
}

// Oracle: the points are on the surfaces, the gradients there along the normal, and nothing else is needed of
// the closest points of convex bodies.
TEST(ClosestPoints, OfAnySmoothPair) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int trial = 0; trial < 210; ++trial) {
    const auto [shape_a, shape_b] = smooth_pair(trial);
    Body<3> a = body<3>("a", shape_a, {real(random), real(random), 3.5 + real(random)});
    Body<3> b = body<3>("b", shape_b, {real(random), real(random), -0.5 + 0.5 * real(random)});
    const auto turn = [&] {
      return SpatialRotation(exp_rotation({real(random), real(random), real(random)}));
    };
    a.pose.rotation = turn();
    b.pose.rotation = turn();
    const ContactPoints<3> points = only_candidate(scene<3>(0.5, {a, b}));
    EXPECT_TRUE(points.exact) << trial;
    EXPECT_NEAR((points.point_a - points.point_b - points.gap * points.normal).norm(), 0.0, 1e-11) << trial;
    const auto check = [&](const Body<3>& of, const Vector<3>& point, const Vector<3>& outward) {
      const SurfaceJet<3> jet = make_surface(of.shape)->jet(0, of.pose.to_body(point));
      EXPECT_NEAR(jet.value, 0.0, 1e-11) << trial;
      EXPECT_NEAR((of.pose.rotation.matrix() * jet.gradient.normalized() - outward).norm(), 0.0, 1e-9)
          << trial;
    };
    check(a, points.point_a, -points.normal);
    check(b, points.point_b, points.normal);
  }
}

// Central differences of the gap along a random motion against n . (v_a - v_b), what the linearisation rests
// on.
TEST(ClosestPoints, GapRateIsTheNormalRelativeVelocity) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  constexpr double kStep = 1e-5;
  for (int trial = 0; trial < 50; ++trial) {
    Body<2> a = disc("a", {real(random), 3 + real(random)}, Twist<2>::Random());
    a.shape.placement.position = Vector<2>(0.2, 0.1);
    Body<2> b = disc("b", {real(random), real(random)}, Twist<2>::Random());
    if (trial % 2 == 0) b = wall<2>("b", {0.6, 0.8}, {0, 0});
    if (trial % 2 == 0) a.shape.geometry = Ellipsoid<2>{{1.5, 0.7}};
    const Scene<2> both = scene<2>(0.5, {a, b});
    const ContactGeometry<2> geometry(both);
    const auto at = [&](double time) {
      auto state = initial_state(both);
      for (auto& s : state) s.pose = advanced(s.pose, s.velocity, time);
      return geometry.points(geometry.pairs()[0], kNoVertex, state);
    };
    const double rate = (at(kStep).gap - at(-kStep).gap) / (2 * kStep);
    const auto state = initial_state(both);
    const ContactPoints<2> points = at(0.0);
    const Vector<2> relative = point_velocity<2>(state[0].velocity, points.point_a - a.pose.position) -
                               point_velocity<2>(state[1].velocity, points.point_b - b.pose.position);
    EXPECT_NEAR(points.normal.dot(relative), rate, 1e-8) << "trial " << trial;
  }
}

TEST(ContactGeometry, PutsTheHalfSpaceSecondAndKnowsVertices) {
  const Scene<2> both = scene<2>(0.5, {ground<2>(), body<2>("p", {RegularPolygon{7, 2.0}}, {0, 2.5})});
  const ContactGeometry<2> geometry(both);
  ASSERT_EQ(geometry.pairs().size(), 1U);
  EXPECT_EQ(geometry.pairs()[0].body_a, 1);
  EXPECT_TRUE(geometry.pairs()[0].by_vertices);
  EXPECT_EQ(geometry.candidate_count(), 7);
  const auto lowest = geometry.points(geometry.pairs()[0], 0, initial_state(both));
  EXPECT_NEAR((lowest.point_a - Vector<2>(0, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(lowest.gap, 0.5, 1e-15);
}

TEST(ContactGeometry, LeavesOutPairsThatDoNotMove) {
  const Scene<2> walls =
      scene<2>(0.5, {ground<2>(), wall<2>("w", {1, 0}, {0, 0}), disc("d", {1, 1}, {0, 0, 0})});
  EXPECT_EQ(ContactGeometry<2>(walls).pairs().size(), 2U);
}

/// The reason with which a scene is refused; empty if it is not.
template <int Dim>
std::string refusal(const Scene<Dim>& scene) {
  try {
    const ContactGeometry<Dim> geometry(scene);
  } catch (const Unsupported& error) {
    return error.what();
  }
  return {};
}

TEST(ContactGeometry, RefusesPairsItCannotDo) {
  const auto polygon = [](const std::string& name) {
    return body<2>(name, {RegularPolygon{5, 1.0}}, {0, 9});
  };
  Body<2> moving_plane = ground<2>();
  moving_plane.fixed = false;
  const std::string two = refusal(scene<2>(0.5, {polygon("p"), polygon("q")}));
  EXPECT_NE(two.find("regular_polygon ('p') and a regular_polygon ('q')"), std::string::npos) << two;
  EXPECT_NE(refusal(scene<2>(0.5, {polygon("p"), disc("d", {0, 0}, {0, 0, 0})})), "");
  EXPECT_NE(refusal(scene<2>(0.5, {polygon("p"), moving_plane})), "");
  EXPECT_EQ(refusal(scene<2>(0.5, {disc("d", {0, 3}, {0, 0, 0}), moving_plane})), "");
  const Body<3> capsule = body<3>("c", {Capsule{}}, {0, 0, 3});
  EXPECT_NE(refusal(scene<3>(0.5, {capsule, ground<3>()})), "") << "may touch along a line";
  EXPECT_NE(refusal(scene<3>(0.5, {capsule, body<3>("d", {Capsule{}}, {0, 0, 9})})), "");
  EXPECT_EQ(refusal(scene<3>(0.5, {capsule, ball("b", {0, 0, 9})})), "");
  EXPECT_EQ(refusal(scene<3>(0.5, {body<3>("b", {Box<3>{}}, {0, 0, 3}), ground<3>()})), "");
}

}  // namespace
}  // namespace touchstone::testing
