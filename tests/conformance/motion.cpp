#include <gtest/gtest.h>

#include <cmath>

#include "tests/conformance/claims.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/scenes.h"

/// Does a body without contacts move as its integrator says it should: units, signs, frames?
namespace touchstone::conformance {

namespace {

/// Sum over the steps of the velocity's share in the position, in units of h^2 g: the exact discrete rule.
double fallen(FreeFlight rule, int steps) {
  const double n = steps;
  switch (rule) {
    case FreeFlight::velocity_first:
      return n * (n + 1) / 2;
    case FreeFlight::position_first:
      return n * (n - 1) / 2;
    case FreeFlight::parabola:
      return n * n / 2;
  }
  return 0;
}

/// `acceleration` is what the scene's gravity and force give the body.
template <int Dim>
void expect_flight(const Subject<Dim>& subject, const Scene<Dim>& scene, const Vector<Dim>& acceleration) {
  constexpr int kSteps = 50;
  const auto method = subject.entry.make(scene, {});
  advance(*method, kStep, kSteps);
  const auto& body = scene.bodies[0];
  const Vector<Dim> v = body.velocity.template head<Dim>() + kSteps * kStep * acceleration;
  const Vector<Dim> x = body.pose.position + kSteps * kStep * body.velocity.template head<Dim>() +
                        fallen(subject.traits.free_flight, kSteps) * kStep * kStep * acceleration;
  const auto& state = method->state()[0];
  const double tolerance = 10 * subject.traits.rounding;
  EXPECT_LE((state.velocity.template head<Dim>() - v).norm(), tolerance * (1 + v.norm()));
  EXPECT_LE((state.pose.position - x).norm(), tolerance * (1 + x.norm()));
}

template <int Dim>
void free_flight(const Subject<Dim>& subject) {
  Scene<Dim> scene = alone(ball<Dim>("ball", 20 * up<Dim>()));
  scene.gravity = -kGravity * up<Dim>() + 2.0 * Vector<Dim>::Unit(0);
  scene.bodies[0].mass = 3.0;
  // With spin, because an integrator of twists in the body frame would bend the path.
  for (int i = 0; i < Dimension<Dim>::velocity; ++i) scene.bodies[0].velocity[i] = 1.0 + i;
  expect_flight<Dim>(subject, scene, scene.gravity);
}

template <int Dim>
void applied_force(const Subject<Dim>& subject) {
  Scene<Dim> scene = alone(ball<Dim>("ball", 20 * up<Dim>()));
  scene.bodies[0].mass = 3.0;
  for (int i = 0; i < Dim; ++i) scene.bodies[0].force[i] = 2.0 - 3.0 * i;
  expect_flight<Dim>(subject, scene, scene.bodies[0].force / 3.0);
}

/// Angular velocity is in the world frame and turns the body the right way, from an orientation that is not
/// the identity. A first-order update of the rotation is off by (omega h)^3 / 12 a step, which is what is
/// allowed.
template <int Dim>
void spin_frame(const Subject<Dim>& subject) {
  constexpr int kSteps = 100;
  Body<Dim> body = ball<Dim>("ball", 20 * up<Dim>());
  body.pose.rotation = skew_rotation(body.pose.rotation);
  Angular<Dim> omega = Angular<Dim>::Constant(2.0);
  if constexpr (Dim == 3) omega = {0.3, -1.1, 2.0};
  body.velocity.template tail<Dimension<Dim>::angular>() = omega;
  const auto method = subject.entry.make(alone(body), {});
  advance(*method, kStep, kSteps);
  const auto& state = method->state()[0];
  const auto expected = body.pose.rotation.turned(kSteps * kStep * omega);
  const double tolerance = kSteps * std::pow(omega.norm() * kStep, 3) / 12 + 100 * subject.traits.rounding;
  EXPECT_LE((state.pose.rotation.matrix() - expected.matrix()).norm(), 2 * tolerance);
  EXPECT_LE((state.velocity.template tail<Dimension<Dim>::angular>() - omega).norm(),
            10 * subject.traits.rounding);
}

/// Whole turns are counted in the plane, not wrapped.
void turns_are_counted(const Subject<2>& subject) {
  Body<2> body = ball<2>("ball", 20 * up<2>());
  body.velocity[2] = -20.0;
  const auto method = subject.entry.make(alone(body), {});
  advance(*method, kStep, 200);
  EXPECT_NEAR(method->state()[0].pose.rotation.angle(), -40.0, 200 * std::pow(0.2, 3) / 12 + 1e-4);
}

/// Euler's equations for the body-frame rates, integrated finely by the classical Runge-Kutta rule.
Vector<3> euler_rates(const Inertia<3>& inertia, Vector<3> w, double time) {
  const auto rate = [&](const Vector<3>& x) -> Vector<3> {
    return inertia.inverse() * (inertia * x).cross(x);
  };
  constexpr int kSteps = 20000;
  const double h = time / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const Vector<3> a = rate(w);
    const Vector<3> b = rate(w + h / 2 * a);
    const Vector<3> c = rate(w + h / 2 * b);
    const Vector<3> d = rate(w + h * c);
    w += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return w;
}

/// A box of sides 1 x 4 x 9 with its inertia given in a frame that is not the principal one. With the inertia
/// about wrong axes or omega in the wrong frame the rates are off by their own size; first-order integrators
/// by h.
void free_rotation(const Subject<3>& subject) {
  constexpr double kFineStep = 1e-3;
  Body<3> body = ball<3>("box", 20 * up<3>());
  const Matrix<3> axes = SpatialRotation(Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2)).matrix();
  body.inertia = axes * (Vector<3>(97, 82, 17) / 12).asDiagonal() * axes.transpose();
  body.pose.rotation = skew_rotation(body.pose.rotation);
  const Vector<3> rates(1.0, 2.0, -0.5);
  body.velocity.tail<3>() = body.pose.rotation.matrix() * rates;
  const auto method = subject.entry.make(alone(body), {});
  advance(*method, kFineStep, 1000);
  const auto& state = method->state()[0];
  const Vector<3> found = state.pose.rotation.matrix().transpose() * state.velocity.tail<3>();
  const Vector<3> expected = euler_rates(body.inertia, rates, 1.0);
  ASSERT_GT((expected - rates).norm(), 0.3) << "the scene must not be a rotation about a principal axis";
  EXPECT_LE((found - expected).norm(), 20 * kFineStep);
}

/// Neither damping nor sleep, at speeds below every engine's threshold for sleep.
template <int Dim>
void no_damping_no_sleep(const Subject<Dim>& subject) {
  Body<Dim> body = ball<Dim>("ball", 20 * up<Dim>());
  body.velocity.setConstant(1e-3);
  const auto method = subject.entry.make(alone(body), {});
  advance(*method, kStep, 500);
  const auto& state = method->state()[0];
  EXPECT_LE((state.velocity - body.velocity).norm(), 0.1 * subject.traits.rounding);
  EXPECT_NEAR(state.pose.position[0], 5e-3, 1e-4);
}

/// A body on an arm that hangs by a joint and is let go level: the arm's end stays where the joint is, and
/// what the body falls is its kinetic energy.
template <int Dim>
void joints(const Subject<Dim>& subject) {
  constexpr double kArm = 1.0;
  constexpr int kSteps = 30;
  Scene<Dim> scene = alone(ball<Dim>("bob", kArm * Vector<Dim>::Unit(0), 0.2));
  scene.gravity = -kGravity * up<Dim>();
  Body<Dim> post = ball<Dim>("post", Vector<Dim>::Zero(), 0.1);
  post.fixed = true;
  scene.bodies.push_back(post);
  Joint<Dim> joint;
  joint.body_a = 0;
  joint.body_b = 1;
  scene.joints = {joint};
  const auto method = make_claimed(subject.entry, scene, &Capabilities::joints);
  advance(*method, kStep, kSteps);
  const BodyState<Dim>& state = method->state()[0];
  const Vector<Dim> end = state.pose.to_world(-kArm * Vector<Dim>::Unit(0));
  EXPECT_LE(end.norm(), subject.traits.joint_gap) << "the joint has come apart";
  // Energy: first order in h, of a fall of about 0.4 m.
  const double inertia = scene.bodies[0].inertia(0, 0);
  const double spin = state.velocity.template tail<Dimension<Dim>::angular>().norm();
  const double fallen = -state.pose.position[Dim - 1];
  EXPECT_GT(fallen, 0.3);
  EXPECT_NEAR(0.5 * (kArm * kArm + inertia) * spin * spin, kGravity * fallen, 5 * kStep * kGravity * fallen);
}

}  // namespace

template <int Dim>
std::vector<Feature<Dim>> motion_features() {
  std::vector<Feature<Dim>> features = {
      {"free_flight", "a thrown body follows the integrator's own rule", &free_flight<Dim>},
      {"applied_force", "a force moves a mass as F = m a, in newtons and kilograms", &applied_force<Dim>},
      {"spin_frame", "angular velocity is in the world frame and turns the right way", &spin_frame<Dim>},
      {"joints", "a body hangs and swings by a joint", &joints<Dim>},
      {"no_damping_no_sleep", "a slow free body keeps its velocity", &no_damping_no_sleep<Dim>},
  };
  if constexpr (Dim == 2) {
    features.push_back({"turns_counted", "angles are not wrapped", &turns_are_counted});
  } else {
    features.push_back({"free_rotation", "a free box tumbles as Euler's equations say", &free_rotation});
  }
  return features;
}
template std::vector<Feature<2>> motion_features();
template std::vector<Feature<3>> motion_features();

}  // namespace touchstone::conformance
