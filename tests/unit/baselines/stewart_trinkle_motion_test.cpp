// Motion in the plane against closed forms, most of them of the scheme itself and so exact to rounding.
#include <numbers>
#include <vector>

#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kStep = 0.01;
constexpr double kInertia = 0.5;

/// A scene whose ground is a slope of the given angle, seen along it: gravity is turned instead.
Scene<2> on_slope(double angle, double mu, const Body<2>& moving) {
  Scene<2> result = scene<2>(mu, {moving, ground<2>()});
  result.gravity = kGravity * Vector<2>(std::sin(angle), -std::cos(angle));
  return result;
}

// v_k = v_0 + k h g, q_k = q_0 + h sum v_k.
TEST(StewartTrinkleMotion, FreeFlightIsTheSchemesParabola) {
  const Twist<2> start(2, 5, -7);
  for (const char* edges : {"0", "9"}) {
    const auto method = make_stewart_trinkle<2>(scene<2>(0.4, {disc("disc", {0, 10}, start), ground<2>()}),
                                                {{"edges", edges}});
    const int count = 50;
    advance(*method, kStep, count);
    const BodyState<2>& state = method->state()[0];
    EXPECT_NEAR(state.velocity[0], 2, 1e-13);
    EXPECT_NEAR(state.velocity[1], 5 - count * kStep * kGravity, 1e-13);
    EXPECT_EQ(state.velocity[2], -7);
    EXPECT_NEAR(state.pose.position.x(), 2 * count * kStep, 1e-13);
    EXPECT_NEAR(state.pose.position.y(),
                10 + 5 * count * kStep - kGravity * kStep * kStep * count * (count + 1) / 2, 1e-12);
    EXPECT_NEAR(state.pose.rotation.angle(), -7 * count * kStep, 1e-13);
  }
}

// One smooth contact whose normal does not turn: its linearised gap is the gap, and nothing is lost.
TEST(StewartTrinkleMotion, SmoothDiscRollsForEver) {
  const auto method = make_stewart_trinkle<2>(rolling_disc(), {});
  advance(*method, kStep, 1000);
  EXPECT_NEAR(kinetic_energy(method->state()[0], kInertia), 6.75, 1e-12);
  EXPECT_NEAR(method->state()[0].pose.position.y(), 1, 1e-12);
  EXPECT_NEAR(method->state()[0].pose.position.x(), -30, 1e-10);
}

// Angular momentum about the contact is kept: v_end = v_0 / (1 + b), b = I / (m r^2), from t = b / (1 + b)
// v_0 / (mu g).
TEST(StewartTrinkleMotion, SmoothDiscSlidesToRoll) {
  const double mu = 0.1;
  const auto method =
      make_stewart_trinkle<2>(scene<2>(mu, {disc("disc", {0, 1}, {-3, 0, 0}), ground<2>()}), {});
  const int sliding = static_cast<int>(3.0 / 3 / (mu * kGravity) / kStep);
  advance(*method, kStep, sliding);
  EXPECT_NEAR(method->state()[0].velocity[0], -3 + mu * kGravity * kStep * sliding, 1e-12);
  advance(*method, kStep, 2);
  EXPECT_NEAR(method->state()[0].velocity[0], -2, 1e-12);
  EXPECT_NEAR(method->state()[0].velocity[2], 2, 1e-12);
}

TEST(StewartTrinkleMotion, FrictionlessDiscKeepsSpeedAndSpin) {
  Scene<2> smooth = scene<2>(0.0, {disc("disc", {0, 1}, {-3, 0, -5}), ground<2>()});
  smooth.contact_law.e_t = 1e300;  // poison: without friction its ellipsoid is not to be read
  const auto method = make_stewart_trinkle<2>(smooth, {});
  advance(*method, kStep, 500);
  EXPECT_EQ(method->state()[0].velocity[0], -3);
  EXPECT_EQ(method->state()[0].velocity[2], -5);
  ASSERT_EQ(method->contacts().size(), 1U);
  EXPECT_EQ(method->contacts()[0].friction_impulse[0], 0.0);
}

// e_t scales mu: the mapping of Eq. 5 in the plane.
TEST(StewartTrinkleMotion, EllipsoidScalesFriction) {
  Scene<2> scaled = scene<2>(0.1, {disc("disc", {0, 1}, {-3, 0, 0}), ground<2>()});
  scaled.contact_law.e_t = 2.0;
  const auto method = make_stewart_trinkle<2>(scaled, {});
  advance(*method, kStep, 10);
  EXPECT_NEAR(method->state()[0].velocity[0], -3 + 0.2 * kGravity * 10 * kStep, 1e-12);
}

// v_k = v_0 - k mu g h until it would change sign, then 0; so x = h sum v_k, within v_0 h / 2 of v_0^2 / (2
// mu g).
TEST(StewartTrinkleMotion, BlockSlidesToAStop) {
  const double mu = 0.3;
  Scene<2> sliding = scene<2>(mu, {block({0.5, 0.25}, {0, 0.25}), ground<2>()});
  sliding.bodies[0].velocity << 2, 0, 0;
  double expected = 0.0;
  for (double v = 2 - mu * kGravity * kStep; v > 0; v -= mu * kGravity * kStep) expected += kStep * v;
  for (const char* candidates : {"reachable", "all", "nearest:2", "epsilon:0.01"}) {
    const auto method = make_stewart_trinkle<2>(sliding, {{"candidates", candidates}});
    advance(*method, kStep, 100);
    EXPECT_NEAR(method->state()[0].pose.position.x(), expected, 1e-11) << candidates;
    EXPECT_NEAR(method->state()[0].pose.position.x(), 4 / (2 * mu * kGravity), 2 * kStep / 2 + 1e-3);
    EXPECT_NEAR(method->state()[0].velocity.norm(), 0, 1e-12);
    EXPECT_NEAR(method->state()[0].pose.rotation.angle(), 0, 1e-12);
  }
}

// For tan(theta) < b / h a block stays iff tan(theta) <= mu, and else slides at g (sin - mu cos).
TEST(StewartTrinkleMotion, BlockSticksOrSlidesOnASlope) {
  for (const double tangent : {0.499, 0.501}) {
    const double angle = std::atan(tangent);
    const auto method = make_stewart_trinkle<2>(on_slope(angle, 0.5, block({0.5, 0.25}, {0, 0.25})), {});
    advance(*method, kStep, 100);
    const double acceleration = std::max(0.0, kGravity * (std::sin(angle) - 0.5 * std::cos(angle)));
    EXPECT_NEAR(method->state()[0].velocity[0], acceleration * 1.0, 1e-11) << tangent;
    EXPECT_NEAR(method->state()[0].velocity[2], 0, 1e-11) << tangent;
  }
}

// A disc, b = 1/2, rolls without slip iff mu >= tan(theta) / 3: then a = 2/3 g sin(theta); else a = g (sin -
// mu cos) and it spins up by mu m g r cos / I only.
TEST(StewartTrinkleMotion, DiscOnASlopeSlipsIffFrictionIsTooLow) {
  const double angle = 0.6;
  for (const double factor : {1.01, 0.99}) {
    const double mu = factor * std::tan(angle) / 3;
    const auto method = make_stewart_trinkle<2>(on_slope(angle, mu, disc("disc", {0, 1}, {0, 0, 0})), {});
    advance(*method, kStep, 100);
    const Twist<2> nu = method->state()[0].velocity;
    const bool rolls = factor > 1;
    const double acceleration =
        kGravity * (rolls ? 2.0 / 3 * std::sin(angle) : std::sin(angle) - mu * std::cos(angle));
    const double spin_up = rolls ? acceleration : mu * kGravity * std::cos(angle) / kInertia;
    EXPECT_NEAR(nu[0], acceleration * 1.0, 1e-11) << factor;
    EXPECT_NEAR(nu[2], -spin_up * 1.0, 1e-11) << factor;
    EXPECT_EQ(std::abs(nu[0] + nu[2]) < 1e-10, rolls);
  }
}

// Two bottom vertices in exact symmetry, each of them enough: the degenerate case of the pivoting.
TEST(StewartTrinkleMotion, PolygonRestsOnItsEdge) {
  for (const int edges : {4, 10, 100}) {
    Body<2> polygon =
        body<2>("polygon", {RegularPolygon{edges, 1.0}}, {0, std::cos(std::numbers::pi / edges)});
    polygon.pose.rotation = PlanarRotation(std::numbers::pi / edges);
    polygon.inertia << kInertia;
    const auto method = make_stewart_trinkle<2>(scene<2>(0.4, {polygon, ground<2>()}), {});
    advance(*method, kStep, 200);
    EXPECT_NEAR(method->state()[0].velocity.norm(), 0, 1e-12) << edges;
    EXPECT_NEAR((method->state()[0].pose.position - polygon.pose.position).norm(), 0, 1e-12) << edges;
  }
}

// One vertex exactly down and nothing to tell left from right: it balances.
TEST(StewartTrinkleMotion, PolygonBalancesOnAVertex) {
  const auto method = make_stewart_trinkle<2>(scene<2>(0.4, {disc("disc", {0, 1}, {0, 0, 0}), ground<2>()}),
                                              {{"edges", "10"}});
  advance(*method, kStep, 10);
  EXPECT_NEAR(method->state()[0].velocity.norm(), 0, 1e-12);
}

// Linear momentum of each disc from the impulses read back, and the moments of friction at the rims.
TEST(StewartTrinkleMotion, ImpulsesBalanceMomentum) {
  Scene<2> scene_of_three = scene<2>(0.3, {disc("a", {0, 1}, {3, 0, 0}), disc("b", {2.005, 1}, {-1, 0, 4}),
                                           disc("c", {1.0, 2.7325}, {0, -2, 1}), ground<2>()});
  scene_of_three.bodies[1].mass = 2.5;
  const auto method = make_stewart_trinkle<2>(scene_of_three, {});
  for (int k = 0; k < 50; ++k) {
    const std::vector<BodyState<2>> before(method->state().begin(), method->state().end());
    advance(*method, kStep, 1);
    for (int i = 0; i < 3; ++i) {
      const Body<2>& moving = scene_of_three.bodies[static_cast<std::size_t>(i)];
      Vector<2> momentum = kStep * moving.mass * scene_of_three.gravity;
      double spin = 0.0;
      for (const auto& contact : method->contacts()) {
        const double sign = contact.body_a == i ? 1.0 : contact.body_b == i ? -1.0 : 0.0;
        momentum +=
            sign * (contact.normal * contact.normal_impulse + contact.tangents * contact.friction_impulse);
        // Both arms are one radius against the normal of that body: -n of A, +n of B.
        if (sign != 0.0)
          spin += lever(Vector<2>(-contact.normal)).dot(contact.tangents * contact.friction_impulse);
      }
      const auto index = static_cast<std::size_t>(i);
      const Twist<2> change = method->state()[index].velocity - before[index].velocity;
      EXPECT_NEAR((moving.mass * change.head<2>() - momentum).norm(), 0, 1e-12)
          << "step " << k << " body " << i;
      EXPECT_NEAR(kInertia * change[2], spin, 1e-12) << "step " << k << " body " << i;
    }
  }
}

// Central plastic impact of discs without friction: a first step closes the gap, with whatever speed that
// takes; a second ends the approach with a common velocity.
TEST(StewartTrinkleMotion, DiscsMeetPlastically) {
  const double gap = 0.01;
  const double h = 0.005;
  Scene<2> pair = scene<2>(0.0, {disc("a", {0, 0}, {3, 0, 0}), disc("b", {2 + gap, 0}, {-1, 0, 2})});
  pair.gravity.setZero();
  pair.bodies[1].mass = 3.0;
  const auto method = make_stewart_trinkle<2>(pair, {});
  advance(*method, h, 1);
  EXPECT_NEAR(method->state()[0].velocity[0] - method->state()[1].velocity[0], gap / h, 1e-12);
  advance(*method, h, 1);
  const double common = (1 * 3.0 + 3 * -1.0) / 4;
  EXPECT_NEAR(method->state()[0].velocity[0], common, 1e-12);
  EXPECT_NEAR(method->state()[1].velocity[0], common, 1e-12);
  EXPECT_EQ(method->state()[1].velocity[2], 2);
}

TEST(StewartTrinkleMotion, DoesNotDependOnTheOrderOfBodies) {
  const Scene<2> forward =
      scene<2>(0.3, {disc("a", {0, 1}, {3, 0, 0}), disc("b", {2.5, 1}, {-1, 0, 4}), ground<2>()});
  Scene<2> backward = forward;
  std::swap(backward.bodies[0], backward.bodies[2]);
  const auto one = make_stewart_trinkle<2>(forward, {});
  const auto other = make_stewart_trinkle<2>(backward, {});
  for (int k = 0; k < 200; ++k) {
    advance(*one, kStep, 1);
    advance(*other, kStep, 1);
    for (const auto& [i, j] : {std::pair{0, 2}, std::pair{1, 1}}) {
      ASSERT_LE(
          difference(one->state()[static_cast<std::size_t>(i)], other->state()[static_cast<std::size_t>(j)]),
          1e-10)
          << "step " << k;
    }
  }
}

// Two bodies that never meet move as each would alone.
TEST(StewartTrinkleMotion, FarBodiesDoNotInfluenceEachOther) {
  const Body<2> a = disc("a", {0, 1}, {-3, 0, 0});
  const Body<2> b = disc("b", {50, 1.2}, {1, 0, 6});
  const auto both = make_stewart_trinkle<2>(scene<2>(0.3, {a, b, ground<2>()}), {});
  const auto alone_a = make_stewart_trinkle<2>(scene<2>(0.3, {a, ground<2>()}), {});
  const auto alone_b = make_stewart_trinkle<2>(scene<2>(0.3, {b, ground<2>()}), {});
  for (auto* method : {both.get(), alone_a.get(), alone_b.get()}) advance(*method, kStep, 200);
  EXPECT_LE(difference(both->state()[0], alone_a->state()[0]), 1e-11);
  EXPECT_LE(difference(both->state()[1], alone_b->state()[0]), 1e-11);
}

}  // namespace
}  // namespace touchstone::testing
