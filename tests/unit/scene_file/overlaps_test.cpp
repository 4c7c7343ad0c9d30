#include "experiments/scene_file/overlaps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::scene_file {
namespace {

/// Two bodies, the first at the origin and fixed or not, the second at `position`.
template <int Dim>
Scene<Dim> two(const Shape<Dim>& first, const Shape<Dim>& second, const Vector<Dim>& position,
               bool fixed = false) {
  Scene<Dim> scene;
  scene.bodies.resize(2);
  scene.bodies[0].name = "first";
  scene.bodies[0].fixed = fixed;
  scene.bodies[0].shape = first;
  scene.bodies[1].name = "second";
  scene.bodies[1].shape = second;
  scene.bodies[1].pose.position = position;
  return scene;
}

TEST(Overlaps, AreRefusedFromABillionthOfTheSmallerSizeOn) {
  for (const double radius : {0.01, 1.0, 50.0}) {
    const auto at_depth = [&](double depth) {
      return find_overlap<3>(two<3>({Sphere<3>{100}}, {Sphere<3>{radius}}, {0, 0, 100 + radius - depth}));
    };
    EXPECT_FALSE(at_depth(-0.1 * radius)) << radius;
    EXPECT_FALSE(at_depth(0)) << radius;
    EXPECT_FALSE(at_depth(0.5e-9 * radius)) << radius;
    const auto overlap = at_depth(2e-9 * radius);
    ASSERT_TRUE(overlap) << radius;
    EXPECT_NEAR(overlap->depth, 2e-9 * radius, 1e-13);
    EXPECT_NEAR(overlap->allowed, 1e-9 * radius, 1e-20);
    EXPECT_EQ(std::pair(overlap->body_a, overlap->body_b), std::pair(0, 1));
  }
}

TEST(Overlaps, AreFoundHoweverDeep) {
  const Shape<3> shapes[] = {{Sphere<3>{1}},
                             {Ellipsoid<3>{{1, 0.8, 0.6}}},
                             {Superellipsoid<3>{{1, 0.8, 0.6}, {4, 4, 4}}},
                             {Box<3>{{1, 0.8, 0.6}}},
                             {Cylinder{1, 0.6}},
                             {Cone{1, 0.8}},
                             {Capsule{0.5, 0.6}}};
  for (const auto& first : shapes) {
    for (const auto& second : shapes) {
      const std::string names = shape_name(first) + " and " + shape_name(second);
      // In the same place, a little off, and nearly apart: each reaches 0.5 at least along x.
      for (const Vector<3>& at : {Vector<3>(0, 0, 0), Vector<3>(0.1, 0.2, 0.05), Vector<3>(0.9, 0, 0)}) {
        EXPECT_TRUE(find_overlap<3>(two<3>(first, second, at))) << names << " at " << at.transpose();
      }
      EXPECT_FALSE(find_overlap<3>(two<3>(first, second, {2.01, 0, 0}))) << names;
    }
    EXPECT_TRUE(find_overlap<3>(two<3>({HalfSpace<3>{}}, first, {0, 0, -5}, true))) << shape_name(first);
    EXPECT_FALSE(find_overlap<3>(two<3>({HalfSpace<3>{}}, first, {0, 0, 1.2}, true))) << shape_name(first);
  }
}

TEST(Overlaps, DoNotMatterBetweenBodiesThatCannotCollide) {
  Scene<2> scene = two<2>({Sphere<2>{1}}, {Sphere<2>{1}}, {1, 0}, true);
  EXPECT_TRUE(find_overlap(scene));
  scene.bodies[1].fixed = true;
  EXPECT_FALSE(find_overlap(scene)) << "both fixed";
  scene.bodies[1].fixed = false;
  scene.joints = {{JointType::hinge, 1, 0, {0, 0}, {1, 0}}};
  EXPECT_FALSE(find_overlap(scene)) << "jointed";
  EXPECT_FALSE(find_overlap(two<2>({HalfSpace<2>{}}, {HalfSpace<2>{}}, {0, 0}, true))) << "two half-spaces";
}

}  // namespace
}  // namespace touchstone::scene_file
