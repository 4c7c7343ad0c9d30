#include <gtest/gtest.h>

#include <algorithm>

#include "core/model/errors.h"
#include "tests/conformance/claims.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/scenes.h"

/// Normal contact: rest, impact, restitution, impulses.
namespace touchstone::conformance {

namespace {

/// A body that touches the ground and is at rest stays so from the first step on: no margin, skin or slop
/// moves it.
template <int Dim>
void rest_without_pop(const Subject<Dim>& subject) {
  const auto method = subject.entry.make(on_ground(ball<Dim>("ball", up<Dim>()), 0.5), {});
  for (int k = 0; k < 100; ++k) {
    advance(*method, kStep, 1);
    const auto& state = method->state()[0];
    ASSERT_NEAR(state.pose.position[Dim - 1], 1.0, subject.traits.contact_depth) << "step " << k;
    ASSERT_LE(state.velocity.norm(), subject.traits.contact_speed) << "step " << k;
  }
}

/// Highest upward speed after the first impact of a ball that falls from `height` above the ground.
template <int Dim>
double rebound(Method<Dim>& method, double h, int steps) {
  bool hit = false;
  double before = 0;
  double best = 0;
  for (int k = 0; k < steps; ++k) {
    advance(method, h, 1);
    const double speed = method.state()[0].velocity[Dim - 1];
    hit = hit || speed > before;  // falling only gets faster
    before = speed;
    if (hit) best = std::max(best, speed);
  }
  return best;
}

/// Restitution 0: what little comes back is the removal of overlap, which is bounded by the step.
template <int Dim>
void plastic_impact(const Subject<Dim>& subject) {
  constexpr double kHeight = 0.05;
  const double impact_speed = std::sqrt(2 * kGravity * kHeight);
  const auto method = subject.entry.make(on_ground(ball<Dim>("ball", (1 + kHeight) * up<Dim>()), 0.5), {});
  EXPECT_LE(rebound(*method, kStep, 50), 0.25 * impact_speed);
  advance(*method, kStep, 250);
  EXPECT_LE(method->state()[0].velocity.norm(), 1e-2);
  EXPECT_NEAR(method->state()[0].pose.position[Dim - 1], 1.0, 1e-2);
}

template <int Dim>
void restitution(const Subject<Dim>& subject) {
  constexpr double kHeight = 1.0;
  constexpr double kFineStep = 0.001;
  const double impact_speed = std::sqrt(2 * kGravity * kHeight);
  Scene<Dim> scene = on_ground(ball<Dim>("ball", (1 + kHeight) * up<Dim>()), 0.5);
  scene.contact_law.restitution = 0.5;
  const auto method = make_claimed(subject.entry, scene, &Capabilities::restitution);
  EXPECT_NEAR(rebound(*method, kFineStep, 600) / impact_speed, 0.5, 0.05);
}

/// Two balls meet head on without friction: momentum is kept, and with restitution 0 they go on together.
template <int Dim>
void two_body_impact(const Subject<Dim>& subject) {
  const Vector<Dim> x = Vector<Dim>::Unit(0);
  Scene<Dim> scene;
  scene.bodies = {ball<Dim>("left", -1.1 * x), ball<Dim>("right", 1.1 * x)};
  scene.bodies[0].mass = 3.0;
  scene.bodies[0].velocity[0] = 1.0;
  scene.bodies[1].velocity[0] = -1.0;
  const auto method = subject.entry.make(scene, {});
  advance(*method, kStep, 100);
  const double left = method->state()[0].velocity[0];
  const double right = method->state()[1].velocity[0];
  EXPECT_NEAR(3 * left + right, 2.0, 100 * subject.traits.rounding);
  EXPECT_GE(right - left, -subject.traits.contact_speed) << "the balls still approach";
  EXPECT_LE(right - left, 0.5) << "restitution 0 leaves no more than the removal of overlap";
}

/// The momentum that the reported impulses and the loads give is the momentum that the body got, in each step
/// of a ball that lands sliding and spinning. For moments only the contact's arm is known, which is of the
/// step's size.
template <int Dim>
void impulses_balance(const Subject<Dim>& subject) {
  Body<Dim> body = ball<Dim>("ball", 1.02 * up<Dim>());
  body.mass = 2.0;
  body.inertia *= 2.0;
  body.velocity[0] = 1.5;
  const Scene<Dim> scene = on_ground(body, 0.3);
  const auto method = subject.entry.make(scene, {});
  const bool claimed = method->capabilities().contact_impulses;
  double total = 0;
  for (int k = 0; k < 60; ++k) {
    const Twist<Dim> before = method->state()[0].velocity;
    advance(*method, kStep, 1);
    Twist<Dim> change = method->state()[0].velocity - before;
    change.template head<Dim>() -= kStep * scene.gravity;
    Vector<Dim> p = Vector<Dim>::Zero();
    Angular<Dim> moment = Angular<Dim>::Zero();
    for (const auto& c : method->contacts()) {
      const Vector<Dim> impulse =
          c.normal_impulse * c.normal + c.tangents * c.friction_impulse.template head<Dim - 1>();
      const double sign = c.body_a == 0 ? 1.0 : -1.0;
      const Vector<Dim> arm = (c.body_a == 0 ? c.point_a : c.point_b) - method->state()[0].pose.position;
      p += sign * impulse;
      moment += sign * lever(arm).transpose() * impulse;
      EXPECT_GE(c.normal_impulse, 0.0);
      EXPECT_NEAR(c.normal.norm(), 1.0, 1e-6);
    }
    if (!claimed) {
      // Impulses of one of the runs that a method combines say something, but not of the combination.
      EXPECT_TRUE(method->contacts().empty() || !method->capabilities().one_run)
          << "impulses are reported but not claimed";
      continue;
    }
    total += p.norm();
    EXPECT_LE((body.mass * change.template head<Dim>() - p).norm(), subject.traits.impulse * (1 + p.norm()))
        << "step " << k;
    const Angular<Dim> spin = body.inertia * change.template tail<Dimension<Dim>::angular>();
    EXPECT_LE((spin - moment).norm(),
              (kStep * 2 + subject.traits.impulse) * p.norm() + subject.traits.impulse)
        << "step " << k;
  }
  if (!claimed) throw Unsupported("contact impulses are not told");
  EXPECT_GT(total, 0.5 * 60 * kStep * body.mass * kGravity);
}

/// The centre of mass stands below the shape's own centre, and the body is turned, so that the shape's
/// placement in the body frame is not along an axis: a body that is in equilibrium only if it was read
/// rightly.
template <int Dim>
void placed_shape(const Subject<Dim>& subject) {
  Body<Dim> body = ball<Dim>("weeble", 0.7 * up<Dim>());
  body.pose.rotation = skew_rotation(body.pose.rotation);
  body.shape.placement.position = body.pose.rotation.matrix().transpose() * (0.3 * up<Dim>());
  const auto method = subject.entry.make(on_ground(body, 0.5), {});
  advance(*method, kStep, 100);
  EXPECT_NEAR(method->state()[0].pose.position[Dim - 1], 0.7, 10 * subject.traits.contact_depth);
  EXPECT_LE(method->state()[0].velocity.norm(), 10 * subject.traits.contact_speed);
}

}  // namespace

template <int Dim>
std::vector<Feature<Dim>> contact_features() {
  return {
      {"rest_without_pop", "a touching body at rest stays at rest from the first step",
       &rest_without_pop<Dim>},
      {"plastic_impact", "restitution 0: nothing bounces", &plastic_impact<Dim>},
      {"restitution", "restitution 0.5 halves the speed", &restitution<Dim>},
      {"two_body_impact", "momentum is kept between two moving bodies", &two_body_impact<Dim>},
      {"contact_impulses", "the reported impulses account for the momentum", &impulses_balance<Dim>},
      {"placed_shape", "a shape away from the centre of mass stands where the scene puts it",
       &placed_shape<Dim>},
  };
}
template std::vector<Feature<2>> contact_features();
template std::vector<Feature<3>> contact_features();

}  // namespace touchstone::conformance
