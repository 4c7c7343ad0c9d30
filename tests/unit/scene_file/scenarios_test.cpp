// Where a scenario of the experiments has an example scene file too, both are the same scene.

#include <gtest/gtest.h>

#include "experiments/scenarios/disc_rolling.h"
#include "experiments/scenarios/ellipsoid_rolling.h"
#include "experiments/scenarios/sphere_on_spheres.h"
#include "experiments/scenarios/sphere_spin.h"
#include "experiments/scenarios/spheres_in_box.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::scene_file {
namespace {

constexpr double kSame = 1e-15;  // rounding of numbers of order 1

template <int Dim>
void expect_same(const Sphere<Dim>& a, const Sphere<Dim>& b) {
  EXPECT_EQ(a.radius, b.radius);
}
template <int Dim>
void expect_same(const Ellipsoid<Dim>& a, const Ellipsoid<Dim>& b) {
  EXPECT_EQ(a.semi_axes, b.semi_axes);
}
template <int Dim>
void expect_same(const HalfSpace<Dim>& a, const HalfSpace<Dim>& b) {
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.offset, b.offset);
}
template <class Other>
void expect_same(const Other&, const Other&) {
  FAIL() << "a shape that this test does not compare";
}

template <int Dim>
void expect_same_shape(const Shape<Dim>& a, const Shape<Dim>& b) {
  ASSERT_EQ(shape_name(a), shape_name(b));
  std::visit(
      [&](const auto& geometry) {
        using Kind = std::decay_t<decltype(geometry)>;
        expect_same(geometry, std::get<Kind>(b.geometry));
      },
      a.geometry);
  EXPECT_EQ(a.placement.position, b.placement.position);
  EXPECT_EQ(a.placement.rotation.matrix(), b.placement.rotation.matrix());
}

template <int Dim>
void expect_same_scene(const std::string& name, const Scene<Dim>& built) {
  SCOPED_TRACE(name);
  const AnyScene any = read_scene(std::filesystem::path(EXAMPLE_SCENES) / (name + ".toml"));
  const auto& read = std::get<Scene<Dim>>(any);
  EXPECT_EQ(read.gravity, built.gravity);
  EXPECT_EQ(read.contact_law.mu, built.contact_law.mu);
  EXPECT_EQ(read.contact_law.semi_axes(), built.contact_law.semi_axes());
  EXPECT_EQ(read.contact_law.restitution, built.contact_law.restitution);
  EXPECT_TRUE(read.pair_laws.empty() && built.pair_laws.empty());
  EXPECT_TRUE(read.joints.empty() && built.joints.empty());
  ASSERT_EQ(read.bodies.size(), built.bodies.size());
  for (std::size_t i = 0; i < read.bodies.size(); ++i) {
    const Body<Dim>& a = read.bodies[i];
    const Body<Dim>& b = built.bodies[i];
    SCOPED_TRACE(a.name);
    EXPECT_EQ(a.name, b.name);
    ASSERT_EQ(a.fixed, b.fixed);
    EXPECT_LE((a.pose.position - b.pose.position).norm(), kSame);
    EXPECT_LE((a.pose.rotation.matrix() - b.pose.rotation.matrix()).norm(), kSame);
    expect_same_shape(a.shape, b.shape);
    if (a.fixed) continue;
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_LE((a.inertia - b.inertia).norm(), kSame);
    EXPECT_LE((a.velocity - b.velocity).norm(), kSame);
    EXPECT_EQ(a.force, b.force);
  }
}

TEST(Scenarios, AreTheScenesOfTheirFiles) {
  expect_same_scene("disc_rolling", disc_rolling_scene());
  expect_same_scene("sphere_spin", sphere_spin_scene());
  expect_same_scene("sphere_on_spheres", sphere_on_spheres_scene(BallShape::ellipsoid));
  expect_same_scene("ellipsoid_rolling", ellipsoid_scene(ellipsoid_on_plane(), 1.0));
  expect_same_scene("ellipsoid_over_its_end", ellipsoid_scene(ellipsoid_over_its_end(), 1.0));
  expect_same_scene("ellipsoid_on_ellipsoid", ellipsoid_scene(ellipsoid_on_ellipsoid(), 0.8));
  SpheresInBox ten;
  ten.spheres = 10;
  expect_same_scene("spheres_in_box", spheres_in_box_scene(ten));
}

}  // namespace
}  // namespace touchstone::scene_file
