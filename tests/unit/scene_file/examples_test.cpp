// The example scenes: sound, and as their comments say.

#include <gtest/gtest.h>

#include <cmath>

#include "core/contact/closest_points.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::scene_file {
namespace {

AnyScene example(const std::string& name) {
  return read_scene(std::filesystem::path(EXAMPLE_SCENES) / (name + ".toml"));
}
template <int Dim>
Scene<Dim> example_of(const std::string& name) {
  return std::get<Scene<Dim>>(example(name));
}

TEST(Examples, AreThese) {
  EXPECT_EQ(
      test::listing(EXAMPLE_SCENES),
      "box_on_incline.toml closed_forms.toml disc_rolling.toml ellipsoid_on_ellipsoid.toml "
      "ellipsoid_over_its_end.toml ellipsoid_rolling.toml euler_disc.toml pendulum.toml rattleback.toml "
      "slider_crank.toml sphere_on_spheres.toml sphere_spin.toml spheres_in_box.toml ten_bodies.toml "
      "tippe_top.toml");
}

TEST(Examples, AreSoundAndExplained) {
  for (const auto& entry : std::filesystem::directory_iterator(EXAMPLE_SCENES)) {
    EXPECT_NO_THROW(read_scene(entry.path())) << entry.path();
    const std::string text = test::slurp(entry.path());
    EXPECT_TRUE(text.starts_with("# ")) << entry.path();
    EXPECT_NE(text.find("touchstone run experiments/scenes/" + entry.path().filename().string()),
              std::string::npos)
        << entry.path() << ": says how to run it";
    EXPECT_NE(text.find("# Expected"), std::string::npos) << entry.path();
  }
}

/// The gap of two bodies where they start, and the velocity of the first one's material point there.
template <int Dim>
std::pair<double, Vector<Dim>> contact(const Scene<Dim>& scene, const std::string& a, const std::string& b) {
  const Body<Dim>& body = scene.bodies[static_cast<std::size_t>(scene.body(a))];
  const Body<Dim>& other = scene.bodies[static_cast<std::size_t>(scene.body(b))];
  const auto closest =
      closest_points(*make_surface(body.shape), body.pose, *make_surface(other.shape), other.pose);
  return {closest.gap, point_velocity<Dim>(body.velocity, closest.a_1 - body.pose.position)};
}

TEST(Examples, ThatRollStartInTouchAndWithoutSlip) {
  const auto check = [](const auto& scene, const char* a, const char* b) {
    const auto [gap, slip] = contact(scene, a, b);
    EXPECT_NEAR(gap, 0, 1e-12) << a;
    EXPECT_NEAR(slip.norm(), 0, 1e-12) << a;
  };
  check(example_of<2>("disc_rolling"), "disc", "ground");
  check(example_of<3>("ellipsoid_rolling"), "ellipsoid", "ground");
  check(example_of<3>("ellipsoid_over_its_end"), "ellipsoid", "ground");
  check(example_of<3>("ellipsoid_on_ellipsoid"), "ellipsoid", "support");
  check(example_of<3>("euler_disc"), "coin", "table");
  check(example_of<3>("rattleback"), "back", "table");
  check(example_of<3>("sphere_on_spheres"), "ball", "support 1");
  check(example_of<3>("sphere_on_spheres"), "ball", "support 2");
}

TEST(Examples, ThatRestOrSlideStartInTouch) {
  EXPECT_NEAR(contact(example_of<3>("sphere_spin"), "ball", "ground").first, 0, 1e-12);
  EXPECT_NEAR(contact(example_of<3>("box_on_incline"), "box", "slope").first, 0, 1e-12);
  EXPECT_NEAR(contact(example_of<3>("closed_forms"), "body", "ground").first, 0, 1e-12);
  EXPECT_NEAR(contact(example_of<3>("tippe_top"), "top", "table").first, 0, 1e-12);
  EXPECT_NEAR(contact(example_of<2>("slider_crank"), "disc", "bench").first, 0, 1e-12);
}

TEST(Examples, SphereSpinIsThePapersSecond) {
  const Scene<3> scene = example_of<3>("sphere_spin");
  const Body<3>& ball = scene.bodies.at(0);
  EXPECT_EQ(scene.contact_law.semi_axes(), Vector<3>(1, 1, 0.4));
  // mu e_r m g / I
  const double slowing = scene.contact_law.mu * scene.contact_law.e_r * ball.mass * 9.81 / ball.inertia(0, 0);
  EXPECT_NEAR(slowing, 1.962, 1e-15);
  EXPECT_EQ(ball.velocity[5], 1.962);
}

/// Velocities of joined bodies agree at the joints, so that no joint begins with a blow.
TEST(Examples, MechanismsStartWithVelocitiesThatTheirJointsAllow) {
  for (const char* name : {"pendulum", "slider_crank"}) {
    const Scene<2> scene = example_of<2>(name);
    ASSERT_FALSE(scene.joints.empty());
    for (const auto& joint : scene.joints) {
      const auto velocity = [&](int index) {
        const Body<2>& body = scene.bodies[static_cast<std::size_t>(index)];
        return point_velocity<2>(body.velocity, joint.anchor - body.pose.position);
      };
      Vector<2> relative = velocity(joint.body_a) - velocity(joint.body_b);
      if (joint.type == JointType::slider) relative -= relative.dot(joint.axis) * joint.axis;
      EXPECT_NEAR(relative.norm(), 0, 1e-12) << name;
    }
  }
}

TEST(Examples, TenBodiesHaveEveryShapeOfSpace) {
  const Scene<3> scene = example_of<3>("ten_bodies");
  std::set<std::string> shapes;
  int moving = 0;
  for (const auto& body : scene.bodies) {
    shapes.insert(shape_name(body.shape));
    moving += body.fixed ? 0 : 1;
  }
  EXPECT_EQ(moving, 10);
  EXPECT_EQ(shapes.size(), std::variant_size_v<Geometry<3>::Variant>);
}

TEST(Examples, TheLensHasTheInertiaOfTwoCaps) {
  const Scene<3> scene = example_of<3>("ten_bodies");
  const Inertia<3>& lens = scene.bodies[static_cast<std::size_t>(scene.body("lens"))].inertia;
  // Of the solid of revolution r(z)^2 = 0.16 - (|z| + 0.3)^2, |z| <= 0.1, by integration with exact
  // fractions.
  EXPECT_NEAR(lens(0, 0), 0.013681818181818182, 1e-9);
  EXPECT_NEAR(lens(2, 2), 0.023909090909090908, 1e-9);
}

TEST(Examples, EulersDiscIsInSteadyRolling) {
  const Body<3> coin = example_of<3>("euler_disc").bodies.at(0);
  const auto& cylinder = std::get<Cylinder>(coin.shape.geometry);
  const double a = cylinder.radius;
  const double d = cylinder.half_height;
  const Vector<3> axis = coin.pose.rotation.matrix().col(2);
  const double cosine = axis.z();
  const double sine = std::sqrt(1 - cosine * cosine);
  // omega = Omega (z - cos(alpha) e) + omega_3 e, e the coin's axis.
  const Vector<3> omega = coin.velocity.tail<3>();
  const double rate = omega.cross(axis).norm() / sine;
  const double i1 = coin.mass * (a * a / 4 + d * d / 3);
  const double i3 = coin.mass * a * a / 2;
  EXPECT_NEAR(rate * rate * (i1 * sine * cosine - i3 * sine * sine * d / a),
              coin.mass * 9.81 * (a * cosine - d * sine), 1e-12);
}

}  // namespace
}  // namespace touchstone::scene_file
