// Joints in space, one type each: motions with a reduced equation, a closed form, or one rigid body's.
#include <gtest/gtest.h>

#include "experiments/scenarios/truths/ode.h"
#include "tests/regression/judged_run.h"
#include "tests/regression/orders.h"

namespace touchstone {
namespace {

using testing::expect_first_order;
using testing::judged_run;

constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kUntil = 1.0;        // [s]
const Vector<3> kAxis(0.6, 0, 0.8);   // of hinge and slider
const Vector<3> kDown(0.8, 0, -0.6);  // across it, as low as it goes
const Vector<3> kAcross(0, 1, 0);     // kAxis x kDown

Body<3> body_at(const char* name, const Vector<3>& position) {
  Body<3> body;
  body.name = name;
  body.pose.position = position;
  body.shape.geometry = Sphere<3>{0.1};
  return body;
}

/// A body whose principal axes are along nothing in particular.
Body<3> skew_body(const char* name, const Vector<3>& position) {
  Body<3> body = body_at(name, position);
  body.mass = 2.0;
  body.inertia = Vector<3>(0.1, 0.2, 0.25).asDiagonal();
  body.pose.rotation = SpatialRotation(exp_rotation(Vector<3>(0.5, -0.7, 0.3)));
  return body;
}

/// The body coupled to a fixed one at the origin.
Scene<3> hung(const Body<3>& body, JointType type) {
  Scene<3> scene;
  scene.gravity = {0, 0, -kGravity};
  Body<3> post = body_at("post", Vector<3>::Zero());
  post.fixed = true;
  scene.bodies = {body, post};
  Joint<3> joint;
  joint.type = type;
  joint.body_a = 0;
  joint.body_b = 1;
  joint.axis = kAxis;
  scene.joints = {joint};
  scene.validate();
  return scene;
}

/// What `error(state of the first body)` is at the end, with steps that halve.
template <class Error>
std::vector<double> errors_at_the_end(const Scene<3>& scene, const Error& error) {
  std::vector<double> errors;
  for (const double h : {0.004, 0.002, 0.001, 0.0005}) {
    double last = 0;
    judged_run(scene, h, kUntil, [&](double, const auto& stepper) { last = error(stepper.state()[0]); });
    errors.push_back(last);
  }
  return errors;
}

TEST(SpatialJoints, HingeIsAPendulumAboutItsAxis) {
  // phi'' = -m g' L sin(phi) / (I_axis + m L^2), with g' = g 0.6 across the axis.
  constexpr double length = 0.8;
  constexpr double start = 1.0;  // [rad] from the lowest point
  const Body<3> bob = skew_body("bob", length * (std::cos(start) * kDown + std::sin(start) * kAcross));
  const double inertia =
      kAxis.dot(world_inertia(bob.inertia, bob.pose.rotation) * kAxis) + bob.mass * length * length;
  using State = truth::OdeVector<2>;
  const auto field = [&](double, const State& s) -> State {
    return {s[1], -bob.mass * 0.6 * kGravity * length * std::sin(s[0]) / inertia};
  };
  const State truth = truth::integrate<2>(field, 0, State(start, 0), kUntil);
  expect_first_order(errors_at_the_end(hung(bob, JointType::hinge), [&](const BodyState<3>& state) {
    return (state.velocity.tail<3>() - truth[1] * kAxis).norm();
  }));
}

TEST(SpatialJoints, SliderFallsAlongItsAxisAndDoesNotTurn) {
  const Body<3> body = skew_body("body", {0.3, -0.2, 0.4});
  const double acceleration = -kGravity * kAxis.z();
  const Scene<3> scene = hung(body, JointType::slider);
  constexpr double h = 0.01;
  judged_run(scene, h, kUntil, [&](double t, const auto& stepper) {
    const BodyState<3>& state = stepper.state()[0];
    // The step's own closed form: v' = v + h a, x' = x + h v'.
    ASSERT_LE((state.velocity.template head<3>() - acceleration * t * kAxis).norm(), 1e-10) << t;
    ASSERT_LE((state.pose.position - body.pose.position - 0.5 * acceleration * t * (t + h) * kAxis).norm(),
              1e-10)
        << t;
    ASSERT_LE(state.velocity.template tail<3>().norm(), 1e-10) << t;
  });
}

TEST(SpatialJoints, BallLetsAPendulumGoRoundInACircle) {
  // Conical pendulum: Omega^2 L cos(alpha) = g; an inertia that is the same about every axis takes no part.
  constexpr double length = 0.8;
  constexpr double alpha = 0.7;
  const double omega = std::sqrt(kGravity / (length * std::cos(alpha)));
  const Vector<3> start(length * std::sin(alpha), 0, -length * std::cos(alpha));
  Body<3> bob = body_at("bob", start);
  bob.inertia = 0.1 * Inertia<3>::Identity();
  const Vector<3> turning(0, 0, omega);
  bob.velocity << turning.cross(start), turning;
  const Vector<3> end = exp_rotation(Vector<3>(kUntil * turning)) * start;
  expect_first_order(errors_at_the_end(hung(bob, JointType::ball), [&](const BodyState<3>& state) {
    return (state.pose.position - end).norm();
  }));
}

TEST(SpatialJoints, FixedMakesTwoBodiesTurnAsOne) {
  // Free rotation of the whole, about no principal axis: I omega' = -omega x I omega in its own frame.
  Scene<3> scene;
  scene.bodies = {skew_body("a", {0.4, 0.1, 0}), skew_body("b", {-0.2, 0, 0.3})};
  scene.bodies[1].mass = 1.0;
  Joint<3> joint;
  joint.type = JointType::fixed;
  joint.body_a = 0;
  joint.body_b = 1;
  scene.joints = {joint};
  const Vector<3> spin(1.0, 2.0, -0.5);
  Vector<3> center = Vector<3>::Zero();
  for (const Body<3>& body : scene.bodies) center += body.mass / 3.0 * body.pose.position;
  Matrix<3> inertia = Matrix<3>::Zero();
  for (Body<3>& body : scene.bodies) {
    const Vector<3> arm = body.pose.position - center;
    inertia += world_inertia(body.inertia, body.pose.rotation) +
               body.mass * (arm.squaredNorm() * Matrix<3>::Identity() - arm * arm.transpose());
    body.velocity << spin.cross(arm), spin;
  }
  scene.validate();
  using State = truth::OdeVector<3>;
  const auto field = [&](double, const State& omega) -> State {
    return -inertia.ldlt().solve(omega.cross(inertia * omega));
  };
  const State truth = truth::integrate<3>(field, 0, spin, kUntil);
  ASSERT_GT((truth - spin).norm(), 0.3) << "it does not turn steadily";
  const Matrix<3> start = scene.bodies[0].pose.rotation.matrix();
  expect_first_order(errors_at_the_end(scene, [&](const BodyState<3>& state) {
    const Matrix<3> turned = state.pose.rotation.matrix() * start.transpose();
    return (turned.transpose() * state.velocity.tail<3>() - truth).norm();
  }));
}

}  // namespace
}  // namespace touchstone
