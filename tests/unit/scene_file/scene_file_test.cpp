// Sound scene files: every key arrives where it belongs.

#include "experiments/scene_file/scene_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/model/errors.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::scene_file {
namespace {

template <int Dim>
Scene<Dim> parse(const std::string& text) {
  return std::get<Scene<Dim>>(parse_scene(text, "test.toml"));
}

const char* const kSpatial = R"(
dimension = 3
gravity = [1, 2, -9.81]
[friction]
mu = 0.2
e_t = 0.9
e_o = 0.8
e_r = 0.3
restitution = 0.5
tangent = [0, 1, 0]
[[body]]
name = "ball"
mass = 2
inertia = [0.4, 0.5, 0.6]
position = [1, 2, 3]
orientation = [0.6, 0, 0, 0.8]
velocity = [4, 5, 6]
angular_velocity = [7, 8, 9]
force = [10, 11, 12]
shape = { type = "ellipsoid", semi_axes = [1, 2, 3], center = [0.1, 0.2, 0.3], rotation = [0.8, 0.6, 0, 0] }
[[body]]
name = "ground"
fixed = true
position = [0, 0, -9]
shape = { type = "half_space", normal = [0, 0.6, 0.8], offset = -1.5 }
[[body]]
name = "other"
mass = 1
inertia = [1, 1.5, 2, 0.1, 0.2, 0.3]
position = [9, 9, 9]
shape = { type = "sphere", radius = 0.5 }
[[pair]]
bodies = ["other", "ground"]
mu = 0.7
tangent = [0, 0, 1]
[[joint]]
type = "hinge"
bodies = ["ground", "ball"]
anchor = [1, 2, 2]
axis = [0, 0.6, 0.8]
)";

TEST(SceneFile, ReadsEveryKeyOfASpatialScene) {
  const Scene<3> scene = parse<3>(kSpatial);
  EXPECT_EQ(scene.gravity, Vector<3>(1, 2, -9.81));
  ASSERT_EQ(scene.bodies.size(), 3u);
  const Body<3>& ball = scene.bodies[0];
  EXPECT_EQ(ball.name, "ball");
  EXPECT_FALSE(ball.fixed);
  EXPECT_EQ(ball.mass, 2);
  EXPECT_EQ(ball.inertia, Inertia<3>(Vector<3>(0.4, 0.5, 0.6).asDiagonal()));
  EXPECT_EQ(ball.pose.position, Vector<3>(1, 2, 3));
  EXPECT_TRUE(ball.pose.rotation.quaternion().isApprox(Eigen::Quaterniond(0.6, 0, 0, 0.8), 1e-15));
  EXPECT_EQ(ball.velocity, (Twist<3>() << 4, 5, 6, 7, 8, 9).finished());
  EXPECT_EQ(ball.force, Vector<3>(10, 11, 12));
  EXPECT_EQ(std::get<Ellipsoid<3>>(ball.shape.geometry).semi_axes, Vector<3>(1, 2, 3));
  EXPECT_EQ(ball.shape.placement.position, Vector<3>(0.1, 0.2, 0.3));
  EXPECT_TRUE(ball.shape.placement.rotation.quaternion().isApprox(Eigen::Quaterniond(0.8, 0.6, 0, 0), 1e-15));

  const Body<3>& ground = scene.bodies[1];
  EXPECT_TRUE(ground.fixed);
  EXPECT_EQ(std::get<HalfSpace<3>>(ground.shape.geometry).normal, Vector<3>(0, 0.6, 0.8));
  EXPECT_EQ(std::get<HalfSpace<3>>(ground.shape.geometry).offset, -1.5);
  const Inertia<3> full = (Inertia<3>() << 1, 0.1, 0.2, 0.1, 1.5, 0.3, 0.2, 0.3, 2).finished();
  EXPECT_EQ(scene.bodies[2].inertia, full);
}

TEST(SceneFile, ReadsContactLawsAndJoints) {
  const Scene<3> scene = parse<3>(kSpatial);
  const ContactLaw<3>& law = scene.contact_law;
  EXPECT_EQ(law.semi_axes(), Vector<3>(0.9, 0.8, 0.3));
  EXPECT_EQ(law.mu, 0.2);
  EXPECT_EQ(law.restitution, 0.5);
  EXPECT_EQ(law.tangent, Vector<3>(0, 1, 0));

  ASSERT_EQ(scene.pair_laws.size(), 1u);
  const ContactLaw<3>& pair = scene.law(1, 2);
  EXPECT_EQ(pair.mu, 0.7);
  EXPECT_EQ(pair.tangent, Vector<3>(0, 0, 1));
  EXPECT_EQ(pair.semi_axes(), law.semi_axes()) << "what a pair does not say is as in [friction]";
  EXPECT_EQ(pair.restitution, 0.5);

  ASSERT_EQ(scene.joints.size(), 1u);
  const Joint<3>& joint = scene.joints[0];
  EXPECT_EQ(joint.type, JointType::hinge);
  EXPECT_EQ(std::pair(joint.body_a, joint.body_b), std::pair(1, 0));
  EXPECT_EQ(joint.anchor, Vector<3>(1, 2, 2));
  EXPECT_EQ(joint.axis, Vector<3>(0, 0.6, 0.8));
}

TEST(SceneFile, ReadsAPlanarScene) {
  const Scene<2> scene = parse<2>(R"(
dimension = 2
gravity = [0, -9.81]
friction = { mu = 0.4 }
[[body]]
name = "disc"
mass = 1
inertia = 0.5
position = [1, 2]
orientation = 7.5
velocity = [3, 4]
angular_velocity = -5
force = [6, 7]
shape = { type = "box", half_extents = [0.5, 0.25], center = [0.1, 0.2], rotation = 0.3 }
[[body]]
name = "wall"
fixed = true
shape = { type = "half_space", normal = [1, 0], offset = -5 }
[[joint]]
type = "slider"
bodies = ["disc", "wall"]
anchor = [1, 2]
axis = [0, 1]
[[joint]]
type = "hinge"
bodies = ["disc", "wall"]
anchor = [3, 4]
)");
  const Body<2>& disc = scene.bodies[0];
  EXPECT_EQ(disc.inertia(0, 0), 0.5);
  EXPECT_EQ(disc.pose.position, Vector<2>(1, 2));
  EXPECT_EQ(disc.pose.rotation.angle(), 7.5) << "not wrapped";
  EXPECT_EQ(disc.velocity, Twist<2>(3, 4, -5));
  EXPECT_EQ(disc.force, Vector<2>(6, 7));
  EXPECT_EQ(disc.shape.placement.position, Vector<2>(0.1, 0.2));
  EXPECT_EQ(disc.shape.placement.rotation.angle(), 0.3);
  EXPECT_EQ(scene.contact_law.mu, 0.4);
  ASSERT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.joints[0].type, JointType::slider);
  EXPECT_EQ(scene.joints[0].axis, Vector<2>(0, 1));
  EXPECT_EQ(scene.joints[1].type, JointType::hinge);
}

TEST(SceneFile, WhatIsNotGivenIsUprightAtRestAtTheOriginAndFrictionless) {
  const Scene<3> scene = parse<3>(R"(
dimension = 3
gravity = [0, 0, 0]
body = [{ name = "ball", mass = 1, inertia = [1, 1, 1], shape = { type = "sphere", radius = 1 } }]
)");
  const Body<3>& ball = scene.bodies.at(0);
  EXPECT_EQ(ball.pose.position, Vector<3>(0, 0, 0));
  EXPECT_TRUE(ball.pose.rotation.matrix().isIdentity(0));
  EXPECT_TRUE(ball.velocity.isZero(0));
  EXPECT_TRUE(ball.force.isZero(0));
  EXPECT_EQ(scene.contact_law.mu, 0);
  EXPECT_EQ(scene.contact_law.restitution, 0);
  EXPECT_EQ(scene.contact_law.semi_axes(), Vector<3>(1, 1, 0));
}

template <int Dim>
Shape<Dim> parse_shape(const std::string& shape) {
  const std::string text =
      fmt::format("dimension = {}\ngravity = [{}]\n[[body]]\nname = \"b\"\nfixed = true\nshape = {}\n", Dim,
                  Dim == 2 ? "0, 0" : "0, 0, 0", shape);
  return parse<Dim>(text).bodies.at(0).shape;
}

TEST(SceneFile, ReadsEveryShapeOfSpace) {
  const auto is = [](const char* shape, const char* name) {
    EXPECT_EQ(shape_name(parse_shape<3>(shape)), name) << shape;
  };
  is(R"({ type = "sphere", radius = 1 })", "sphere");
  is(R"({ type = "disc", radius = 1 })", "sphere");
  is(R"({ type = "ellipsoid", semi_axes = [1, 2, 3] })", "ellipsoid");
  is(R"({ type = "ellipse", semi_axes = [1, 2, 3] })", "ellipsoid");
  is(R"({ type = "superellipsoid", semi_axes = [1, 2, 3], exponents = [2, 4, 6] })", "superellipsoid");
  is(R"({ type = "half_space", normal = [0, 0, 1], offset = 0 })", "half_space");
  is(R"({ type = "box", half_extents = [1, 2, 3] })", "box");
  const auto cylinder = parse_shape<3>(R"({ type = "cylinder", radius = 2, half_height = 3 })");
  EXPECT_EQ(std::get<Cylinder>(cylinder.geometry).radius, 2);
  EXPECT_EQ(std::get<Cylinder>(cylinder.geometry).half_height, 3);
  const auto cone = parse_shape<3>(R"({ type = "cone", radius = 2, height = 3 })");
  EXPECT_EQ(std::get<Cone>(cone.geometry).radius, 2);
  EXPECT_EQ(std::get<Cone>(cone.geometry).height, 3);
  const auto capsule = parse_shape<3>(R"({ type = "capsule", radius = 2, half_height = 3 })");
  EXPECT_EQ(std::get<Capsule>(capsule.geometry).radius, 2);
  EXPECT_EQ(std::get<Capsule>(capsule.geometry).half_height, 3);
  const auto super =
      parse_shape<3>(R"({ type = "superellipsoid", semi_axes = [1, 2, 3], exponents = [2, 4, 6] })");
  EXPECT_EQ(std::get<Superellipsoid<3>>(super.geometry).exponents, Vector<3>(2, 4, 6));
}

TEST(SceneFile, ReadsEveryShapeOfThePlane) {
  const auto is = [](const char* shape, const char* name) {
    EXPECT_EQ(shape_name(parse_shape<2>(shape)), name) << shape;
  };
  is(R"({ type = "disc", radius = 1 })", "disc");
  is(R"({ type = "ellipse", semi_axes = [1, 2] })", "ellipse");
  is(R"({ type = "superellipsoid", semi_axes = [1, 2], exponents = [2, 4] })", "superellipse");
  is(R"({ type = "superellipse", semi_axes = [1, 2], exponents = [2, 4] })", "superellipse");
  is(R"({ type = "half_space", normal = [0, 1], offset = 0 })", "half_space");
  is(R"({ type = "box", half_extents = [1, 2] })", "box");
  is(R"({ type = "polytope", vertices = [[0, 0], [1, 0], [0, 1]] })", "polytope");
  const auto polygon = parse_shape<2>(R"({ type = "regular_polygon", edges = 7, circumradius = 2 })");
  EXPECT_EQ(std::get<RegularPolygon>(polygon.geometry).edges, 7);
  EXPECT_EQ(std::get<RegularPolygon>(polygon.geometry).circumradius, 2);
}

TEST(SceneFile, APolytopeIsTheSameByPlanesAndByVertices) {
  const auto by_planes = std::get<Polytope<2>>(parse_shape<2>(R"({ type = "polytope", planes = [
      { normal = [1, 0], offset = 2 }, { normal = [-1, 0], offset = 0 },
      { normal = [0, 1], offset = 1 }, { normal = [0, -1], offset = 0 }] })")
                                                   .geometry);
  const auto by_vertices = std::get<Polytope<2>>(
      parse_shape<2>(R"({ type = "polytope", vertices = [[0, 0], [2, 0], [2, 1], [0, 1], [1, 0.5]] })")
          .geometry);
  for (const auto& polytope : {by_planes, by_vertices}) {
    EXPECT_EQ(polytope.normals.size(), 4u);
    ASSERT_EQ(polytope.vertices.size(), 4u) << "the point inside is dropped";
    for (const auto& v : polytope.vertices) {
      EXPECT_TRUE((v.x() == 0 || v.x() == 2) && (v.y() == 0 || v.y() == 1)) << v.transpose();
    }
  }
}

TEST(SceneFile, IntersectionsHavePartsWithPlacesOfTheirOwnAndMayBeNested) {
  const Shape<3> shape = parse_shape<3>(R"({ type = "intersection", center = [0, 0, 5], parts = [
      { type = "sphere", radius = 1, center = [0, 0, 0.5] },
      { type = "intersection", parts = [{ type = "sphere", radius = 2 }, { type = "box", half_extents = [1, 1, 1] }] }] })");
  const auto& outer = std::get<Intersection<3>>(shape.geometry);
  ASSERT_EQ(outer.parts.size(), 2u);
  EXPECT_EQ(shape.placement.position, Vector<3>(0, 0, 5));
  EXPECT_EQ(outer.parts[0].placement.position, Vector<3>(0, 0, 0.5));
  EXPECT_EQ(std::get<Intersection<3>>(outer.parts[1].geometry).parts.size(), 2u);
}

TEST(SceneFile, UniformInertiaIsThatOfTheShapeWhereItIsPlaced) {
  const Scene<3> scene = parse<3>(R"(
dimension = 3
gravity = [0, 0, 0]
[[body]]
name = "cone"
mass = 2
inertia = "uniform"
shape = { type = "cone", radius = 0.2, height = 0.4, center = [-0.1, 0, 0], rotation = [0.7071067811865476, 0, 0.7071067811865476, 0] }
)");
  // About the axis 3/10 m r^2, across 3/20 m r^2 + 3/80 m h^2; the axis lies along x.
  const double along = 0.3 * 2 * 0.04;
  const double across = 0.15 * 2 * 0.04 + 3.0 / 80 * 2 * 0.16;
  EXPECT_TRUE(
      scene.bodies.at(0).inertia.isApprox(Inertia<3>(Vector<3>(along, across, across).asDiagonal()), 1e-12))
      << scene.bodies.at(0).inertia;
  const Scene<2> plane = parse<2>(R"(
dimension = 2
gravity = [0, 0]
body = [{ name = "disc", mass = 3, inertia = "uniform", shape = { type = "disc", radius = 2 } }]
)");
  EXPECT_NEAR(plane.bodies.at(0).inertia(0, 0), 0.5 * 3 * 4, 1e-12);
}

TEST(SceneFile, AFixedBodyMayBeGivenWhatIsNotReadOrIsZero) {
  const Scene<2> scene = parse<2>(R"(
dimension = 2
gravity = [0, 0]
[[body]]
name = "wall"
fixed = true
mass = 0
velocity = [0, 0]
angular_velocity = 0
force = [0, 0]
shape = { type = "disc", radius = 1 }
)");
  EXPECT_TRUE(scene.bodies.at(0).fixed);
}

TEST(SceneFile, IsReadFromAFile) {
  const test::Scratch scratch;
  test::spit(scratch / "scene.toml", kSpatial);
  EXPECT_EQ(std::get<Scene<3>>(read_scene(scratch / "scene.toml")).bodies.size(), 3u);
  EXPECT_THROW(read_scene(scratch / "none.toml"), IoError);
  EXPECT_THROW(read_scene(scratch.path()), IoError) << "a folder";
}

}  // namespace
}  // namespace touchstone::scene_file
