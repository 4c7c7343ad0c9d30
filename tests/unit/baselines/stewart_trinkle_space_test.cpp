// Space: the friction pyramid, torsion, the gyroscopic term.
#include <numbers>
#include <vector>

#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kStep = 0.01;

Vector<3> horizontal(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

// Angular momentum about the contact is kept whatever the pyramid: a ball, b = 2/5, ends rolling at 5/7 of
// its velocity, as a vector.
TEST(StewartTrinkleSpace, BallSlidesToRoll) {
  for (const char* sides : {"4", "8", "16"}) {
    for (const double angle : {0.0, 0.3, 1.1}) {
      Body<3> sliding = ball("ball", {0, 0, 1});
      sliding.velocity.head<3>() = 3 * horizontal(angle);
      const auto method =
          make_stewart_trinkle<3>(scene<3>(0.5, {sliding, ground<3>()}), {{"pyramid", sides}});
      advance(*method, kStep, 100);
      const Vector<3> rolling = 15.0 / 7 * horizontal(angle);
      const Vector<3> spin = Vector<3>(0, 0, 1).cross(rolling);
      EXPECT_NEAR((method->state()[0].velocity.head<3>() - rolling).norm(), 0, 1e-11)
          << sides << " at " << angle;
      EXPECT_NEAR((method->state()[0].velocity.tail<3>() - spin).norm(), 0, 1e-11)
          << sides << " at " << angle;
      EXPECT_NEAR(method->state()[0].pose.position.z(), 1, 1e-12);
    }
  }
}

// Slip along a corner of the pyramid: until rolling starts the speed falls by mu g h a step (circumscribed:
// corners lie 1 / cos(pi / d) out).
TEST(StewartTrinkleSpace, CornersOfThePyramidSetTheFriction) {
  for (const auto& [fit, factor] :
       {std::pair{"inscribed", 1.0}, std::pair{"circumscribed", std::sqrt(2.0)}}) {
    Body<3> sliding = ball("ball", {0, 0, 1});
    sliding.velocity.head<3>() = Vector<3>(3, 0, 0);
    const auto method = make_stewart_trinkle<3>(scene<3>(0.2, {sliding, ground<3>()}),
                                                {{"pyramid", "4"}, {"pyramid_fit", fit}});
    advance(*method, kStep, 20);
    EXPECT_NEAR(method->state()[0].velocity[0], 3 - factor * 0.2 * kGravity * 20 * kStep, 1e-12) << fit;
    EXPECT_NEAR(method->state()[0].velocity[1], 0, 1e-12);
    const auto& contact = method->contacts()[0];
    EXPECT_NEAR(contact.friction_impulse.head<2>().norm(), factor * 0.2 * contact.normal_impulse, 1e-14);
  }
}

/// Speed after 20 steps of a flat box of unit weight on the ground under a horizontal force of `load` mu m g.
double pushed_speed(double load, double angle, const Options& options) {
  Body<3> box = body<3>("box", {Box<3>{{1.0, 1.0, 0.05}}}, {0, 0, 0.05});
  box.inertia = Vector<3>(1.0025 / 3, 1.0025 / 3, 2.0 / 3).asDiagonal();
  box.force = load * 0.5 * kGravity * horizontal(angle);
  const auto method = make_stewart_trinkle<3>(scene<3>(0.5, {box, ground<3>()}), options);
  advance(*method, kStep, 20);
  return method->state()[0].velocity.norm();
}

// The load at which a box starts to slide: mu m g times the radius of the pyramid in the direction of the
// force.
TEST(StewartTrinkleSpace, SlidingStartsAtThePyramidsRadius) {
  for (const int sides : {4, 8}) {
    const double half = std::numbers::pi / sides;
    for (const bool inscribed : {true, false}) {
      const Options options = {{"pyramid", std::to_string(sides)},
                               {"pyramid_fit", inscribed ? "inscribed" : "circumscribed"}};
      const double at_corner = inscribed ? 1.0 : 1 / std::cos(half);
      const double at_edge = at_corner * std::cos(half);
      for (const auto& [angle, radius] : {std::pair{0.0, at_corner}, std::pair{half, at_edge}}) {
        EXPECT_LE(pushed_speed(0.99 * radius, angle, options), 1e-12) << sides << " sides at " << angle;
        EXPECT_GE(pushed_speed(1.01 * radius, angle, options), 1e-3) << sides << " sides at " << angle;
      }
    }
  }
}

// The paper's second example: omega_z falls by mu m g e_r h / I a step, then is exactly 0.
TEST(StewartTrinkleSpace, TorsionStopsASpinningBall) {
  Body<3> spinning = ball("ball", {0, 0, 1});
  spinning.velocity[5] = 1.962;
  Scene<3> scene_with_torsion = scene<3>(0.2, {spinning, ground<3>()});
  scene_with_torsion.contact_law.e_r = 0.4;
  const auto method = make_stewart_trinkle<3>(scene_with_torsion, {});
  for (int k = 1; k <= 20; ++k) {
    advance(*method, 0.07, 1);
    EXPECT_NEAR(method->state()[0].velocity[5], std::max(0.0, 1.962 - 1.962 * 0.07 * k), 1e-12) << k;
    EXPECT_NEAR(method->state()[0].velocity.head<5>().norm(), 0, 1e-12);
  }
}

// Without e_r a point contact does not brake a spin.
TEST(StewartTrinkleSpace, NoTorsionWithoutItsSemiAxis) {
  Body<3> spinning = ball("ball", {0, 0, 1});
  spinning.velocity[5] = 1.962;
  const auto method = make_stewart_trinkle<3>(scene<3>(0.2, {spinning, ground<3>()}), {});
  advance(*method, kStep, 100);
  EXPECT_NEAR(method->state()[0].velocity[5], 1.962, 1e-12);
}

// e_t and e_o scale friction along t and o, and the law's tangent says which is t.
TEST(StewartTrinkleSpace, AnisotropyFollowsTheTangent) {
  for (const auto& [tangent, factor] :
       {std::pair{Vector<3>(1, 0, 0), 1.0}, std::pair{Vector<3>(0, 1, 0), 0.5}}) {
    Body<3> sliding = ball("ball", {0, 0, 1});
    sliding.velocity.head<3>() = Vector<3>(3, 0, 0);
    Scene<3> anisotropic = scene<3>(0.2, {sliding, ground<3>()});
    anisotropic.contact_law.e_o = 0.5;
    anisotropic.contact_law.tangent = tangent;
    const auto method = make_stewart_trinkle<3>(anisotropic, {});
    advance(*method, kStep, 20);
    EXPECT_NEAR(method->state()[0].velocity[0], 3 - factor * 0.2 * kGravity * 20 * kStep, 1e-12);
  }
}

// p_vp = -h omega x (I omega): for I = diag(1, 2, 3) and omega = (1, 2, 3) the moment is (-6, 6, -2).
TEST(StewartTrinkleSpace, GyroscopicTermOfOneStep) {
  Body<3> top = body<3>("top", {Sphere<3>{1.0}}, {0, 0, 10});
  top.inertia = Vector<3>(1, 2, 3).asDiagonal();
  top.velocity.tail<3>() = Vector<3>(1, 2, 3);
  const auto method = make_stewart_trinkle<3>(scene<3>(0.2, {top, ground<3>()}), {});
  advance(*method, kStep, 1);
  const Vector<3> expected(1 - 6 * kStep, 2 + 3 * kStep, 3 - 2 * kStep / 3);
  EXPECT_NEAR((method->state()[0].velocity.tail<3>() - expected).norm(), 0, 1e-14);
  const SpatialRotation turned = SpatialRotation().turned(kStep * expected);
  EXPECT_NEAR((method->state()[0].pose.rotation.matrix() - turned.matrix()).norm(), 0, 1e-14);
}

// A homogeneous cube on a slope of tan(theta) = 0.4 < mu stays; with mu = 0.3 it slides at g (sin - mu cos)
// along t.
TEST(StewartTrinkleSpace, CubeOnASlope) {
  const double angle = std::atan(0.4);
  for (const double mu : {0.5, 0.3}) {
    Body<3> cube = body<3>("cube", {Box<3>{{0.5, 0.5, 0.5}}}, {0, 0, 0.5});
    cube.inertia = 1.0 / 6 * Inertia<3>::Identity();
    Scene<3> slope = scene<3>(mu, {cube, ground<3>()});
    slope.gravity = kGravity * Vector<3>(std::sin(angle), 0, -std::cos(angle));
    const auto method = make_stewart_trinkle<3>(slope, {});
    advance(*method, kStep, 50);
    const double acceleration = std::max(0.0, kGravity * (std::sin(angle) - mu * std::cos(angle)));
    EXPECT_NEAR(method->state()[0].velocity[0], 0.5 * acceleration, 1e-11) << mu;
    EXPECT_NEAR(method->state()[0].velocity.tail<5>().norm(), 0, 1e-11) << mu;
  }
}

// Policies in space: a tumbling box, to the last bit.
TEST(StewartTrinkleSpace, ReachableIsAll) {
  Body<3> box = body<3>("box", {Box<3>{{0.5, 0.4, 0.3}}}, {0, 0, 1});
  box.inertia = Vector<3>(0.25, 0.34, 0.41).asDiagonal();
  box.inertia /= 3;
  box.velocity << 1, -0.5, -1, 3, -2, 4;
  const Scene<3> tumbling = scene<3>(0.4, {box, ground<3>()});
  const auto few = make_stewart_trinkle<3>(tumbling, {});
  const auto all = make_stewart_trinkle<3>(tumbling, {{"candidates", "all"}});
  for (int k = 0; k < 300; ++k) {
    advance(*few, kStep, 1);
    advance(*all, kStep, 1);
    ASSERT_EQ(few->state()[0].velocity, all->state()[0].velocity) << "step " << k;
  }
}

TEST(StewartTrinkleSpace, TwoBallsOneOnTheOther) {
  Scene<3> stack = scene<3>(0.4, {ball("upper", {0, 0, 3}), ball("lower", {0, 0, 1}), ground<3>()});
  const auto method = make_stewart_trinkle<3>(stack, {});
  advance(*method, kStep, 5);
  ASSERT_EQ(method->contacts().size(), 2U);
  for (const auto& contact : method->contacts()) {
    const double carried = contact.body_b == 2 ? 2.0 : 1.0;
    EXPECT_NEAR(contact.normal_impulse, carried * kGravity * kStep, 1e-12);
  }
}

}  // namespace
}  // namespace touchstone::testing
