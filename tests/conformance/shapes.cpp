#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/conformance/feature.h"
#include "tests/conformance/scenes.h"

/// Which shapes a method can represent: each rests on the ground, and on a fixed one of its own kind.
namespace touchstone::conformance {

namespace {

template <int Dim>
using Geometries = typename Geometry<Dim>::Variant;

/// The shape and the height of the body's origin when it stands on the ground.
template <int Dim>
struct Standing {
  Geometries<Dim> geometry;
  double height;
  bool flat;  ///< rests on more than one point
  Rotation<Dim> rotation{};
};

Polytope<3> wedge() {
  return polytope_from_vertices<3>(
      {{-1, -1, -0.5}, {1, -1, -0.5}, {1, 1, -0.5}, {-1, 1, -0.5}, {-0.5, 0, 1}, {0.5, 0, 1}}, "wedge");
}
Polytope<2> trapezoid() {
  return polytope_from_vertices<2>({{-1, -0.5}, {1, -0.5}, {0.5, 1}, {-0.5, 1}}, "trapezoid");
}
SpatialRotation lying() { return SpatialRotation(exp_rotation({std::numbers::pi / 2, 0, 0})); }

template <int Dim>
Standing<Dim> standing(int which);
template <>
Standing<2> standing<2>(int which) {
  switch (which) {
    case 0:
      return {Box<2>{{1.0, 0.5}}, 0.5, true};
    case 1:
      return {RegularPolygon{12, 1.0}, std::cos(std::numbers::pi / 12), true,
              PlanarRotation(std::numbers::pi / 12)};
    case 2:
      return {trapezoid(), 0.5, true};
    case 3:
      return {Ellipsoid<2>{{1.0, 0.5}}, 0.5, false};
    case 4:
      return {Superellipsoid<2>{{1.0, 0.5}, {3.0, 3.0}}, 0.5, false};
    default:
      return {Intersection<2>{{{Sphere<2>{1.0}, {{0, 0.5}, {}}}, {Sphere<2>{1.0}, {{0, -0.5}, {}}}}}, 0.5,
              false};
  }
}
template <>
Standing<3> standing<3>(int which) {
  switch (which) {
    case 0:
      return {Box<3>{{1.0, 1.0, 0.5}}, 0.5, true};
    case 1:
      return {Cylinder{1.0, 0.5}, 0.5, true};
    case 2:
      return {wedge(), 0.5, true};
    case 3:
      return {Ellipsoid<3>{{1.0, 1.0, 0.5}}, 0.5, false};
    case 4:
      return {Superellipsoid<3>{{1.0, 1.0, 0.5}, {3.0, 3.0, 3.0}}, 0.5, false};
    case 5:
      return {Intersection<3>{{{Sphere<3>{1.0}, {{0, 0, 0.5}, {}}}, {Sphere<3>{1.0}, {{0, 0, -0.5}, {}}}}},
              0.5, false};
    case 6:
      return {Capsule{0.5, 0.5}, 0.5, true, lying()};
    case 7:
      return {Cylinder{0.5, 1.0}, 0.5, true, lying()};
    default:
      return {Cone{1.0, 2.0}, 0.0, true};
  }
}

template <int Dim>
Body<Dim> body_of(const Standing<Dim>& shape) {
  Body<Dim> body = ball<Dim>("body", shape.height * up<Dim>());
  body.pose.rotation = shape.rotation;
  body.shape.geometry = shape.geometry;
  if (std::holds_alternative<Sphere<Dim>>(shape.geometry)) return body;
  if constexpr (Dim == 3) {
    if (std::holds_alternative<Cone>(shape.geometry)) {  // its centre of mass is a quarter up from the base
      body.pose.position = 0.5 * up<3>();
      body.shape.placement.position = -0.5 * up<3>();
    }
  }
  return body;
}

template <int Dim>
void expect_rest(const Subject<Dim>& subject, const Scene<Dim>& scene, bool flat) {
  const auto& traits = subject.traits;
  const auto method = subject.entry.make(scene, {});
  const double depth = flat ? traits.flat_depth : 10 * traits.contact_depth;
  const double start = scene.bodies[0].pose.position[Dim - 1];
  for (int k = 0; k < 50; ++k) {
    advance(*method, kStep, 1);
    const double speed = !flat    ? 10 * traits.contact_speed
                         : k < 25 ? traits.settling_speed
                                  : traits.flat_speed;
    const auto& state = method->state()[0];
    ASSERT_NEAR(state.pose.position[Dim - 1], start, depth) << "step " << k;
    ASSERT_LE(state.velocity.norm(), speed) << "step " << k;
  }
}

template <int Dim, int which>
void rests(const Subject<Dim>& subject) {
  const auto shape = standing<Dim>(which);
  expect_rest<Dim>(subject, on_ground(body_of(shape), 0.5), shape.flat);
}

/// On top of a fixed body of the same kind, which takes the ground's place. Only shapes with a flat face or,
/// for a ball, the exact middle: an equilibrium that a step does not leave.
template <int Dim, int which>
void stacks(const Subject<Dim>& subject) {
  const auto shape = standing<Dim>(which);
  Scene<Dim> scene = on_ground(body_of(shape), 0.5);
  Body<Dim>& support = scene.bodies[1];
  support.shape.geometry = shape.geometry;
  support.pose.rotation = shape.rotation;
  support.pose.position = -shape.height * up<Dim>();
  expect_rest<Dim>(subject, scene, shape.flat);
}

template <int Dim>
void ball_on_ball(const Subject<Dim>& subject) {
  Scene<Dim> scene = on_ground(ball<Dim>("ball", up<Dim>()), 0.5);
  scene.bodies[1].shape.geometry = Sphere<Dim>{1.0};
  scene.bodies[1].pose.position = -up<Dim>();
  expect_rest<Dim>(subject, scene, false);
}

template <int Dim>
void ball_on_box(const Subject<Dim>& subject) {
  Scene<Dim> scene = on_ground(ball<Dim>("ball", up<Dim>()), 0.5);
  scene.bodies[1].shape.geometry = Box<Dim>{Vector<Dim>::Constant(2.0)};
  scene.bodies[1].pose.position = -2.0 * up<Dim>();
  expect_rest<Dim>(subject, scene, false);
}

}  // namespace

template <>
std::vector<Feature<2>> shape_features() {
  return {
      {"box", "a box rests on the ground", &rests<2, 0>},
      {"regular_polygon", "a regular 12-gon rests on the ground", &rests<2, 1>},
      {"polytope", "a convex polygon rests on the ground", &rests<2, 2>},
      {"ellipse", "an ellipse rests on the ground", &rests<2, 3>},
      {"superellipse", "a superellipse rests on the ground", &rests<2, 4>},
      {"intersection", "an intersection of two discs rests on the ground", &rests<2, 5>},
      {"disc_on_disc", "a disc rests on a disc", &ball_on_ball<2>},
      {"disc_on_box", "a disc rests on a box", &ball_on_box<2>},
      {"box_on_box", "a box rests on a box", &stacks<2, 0>},
      {"polygon_on_polygon", "a regular 12-gon rests on another", &stacks<2, 1>},
  };
}

template <>
std::vector<Feature<3>> shape_features() {
  return {
      {"box", "a box rests on the ground", &rests<3, 0>},
      {"cylinder", "a cylinder stands on the ground", &rests<3, 1>},
      {"lying_cylinder", "a cylinder lies on the ground", &rests<3, 7>},
      {"polytope", "a convex polyhedron rests on the ground", &rests<3, 2>},
      {"ellipsoid", "an ellipsoid rests on the ground", &rests<3, 3>},
      {"superellipsoid", "a superellipsoid rests on the ground", &rests<3, 4>},
      {"intersection", "an intersection of two balls rests on the ground", &rests<3, 5>},
      {"capsule", "a capsule lies on the ground", &rests<3, 6>},
      {"cone", "a cone stands on the ground", &rests<3, 8>},
      {"sphere_on_sphere", "a ball rests on a ball", &ball_on_ball<3>},
      {"sphere_on_box", "a ball rests on a box", &ball_on_box<3>},
      {"box_on_box", "a box rests on a box", &stacks<3, 0>},
      {"cylinder_on_cylinder", "a cylinder stands on a cylinder", &stacks<3, 1>},
  };
}

}  // namespace touchstone::conformance
