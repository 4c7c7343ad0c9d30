// One ball in four descriptions, sphere, ellipsoid, superellipsoid of exponent 2 and intersection of one
// inequality, has one trajectory: the surfaces' functions differ, their zero sets do not.
#include <gtest/gtest.h>

#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/judge.h"

namespace touchstone {
namespace {

constexpr double kRadius = 0.5;

struct Motion {
  const char* name;
  double height;       ///< of the centre at the start [m]
  Vector<3> velocity;  ///< [m/s]
  Vector<3> omega;     ///< [rad/s]
  double e_r;          ///< [m]
  int steps;           ///< of 5 ms
};

const Motion kMotions[] = {
    {"rolling", kRadius, {1, 0.5, 0}, {-1, 2, 0}, 0, 200},
    {"sliding", kRadius, {3, -1, 0}, {4, 0, 1}, 0, 200},
    {"impact", 1.0, {1, 0.3, -2}, {0, -5, 2}, 0, 200},
    {"torsion", kRadius, {0.5, 0, 0}, {0, 0, 12}, 0.2, 500},
};

std::vector<Shape<3>> descriptions() {
  Shape<3> sphere;
  sphere.geometry = Sphere<3>{kRadius};
  Shape<3> ellipsoid;
  ellipsoid.geometry = Ellipsoid<3>{Vector<3>::Constant(kRadius)};
  Shape<3> superellipsoid;
  superellipsoid.geometry = Superellipsoid<3>{Vector<3>::Constant(kRadius), Vector<3>::Constant(2)};
  Shape<3> intersection;
  intersection.geometry = Intersection<3>{{sphere}};
  return {sphere, ellipsoid, superellipsoid, intersection};
}

Scene<3> scene_of(const Shape<3>& shape, const Motion& motion) {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_law.mu = 0.3;
  scene.contact_law.e_r = motion.e_r;
  Body<3> ball;
  ball.name = "ball";
  ball.inertia = 0.4 * kRadius * kRadius * Inertia<3>::Identity();
  ball.shape = shape;
  ball.pose.position = {0, 0, motion.height};
  ball.velocity << motion.velocity, motion.omega;
  Body<3> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<3>{};
  scene.bodies = {ball, ground};
  return scene;
}

std::vector<BodyState<3>> trajectory(const Shape<3>& shape, const Motion& motion) {
  ImplicitStepper<3> stepper(scene_of(shape, motion), {});
  std::vector<BodyState<3>> states;
  for (int k = 0; k < motion.steps; ++k) {
    EXPECT_EQ(stepper.step(0.005).status, StepStatus::solved) << motion.name << " step " << k;
    states.push_back(stepper.state()[0]);
  }
  return states;
}

class SameSphere : public testing::TestWithParam<Motion> {};

TEST_P(SameSphere, HasOneTrajectoryInEveryDescription) {
  const auto shapes = descriptions();
  const auto reference = trajectory(shapes[0], GetParam());
  for (std::size_t i = 1; i < shapes.size(); ++i) {
    const auto other = trajectory(shapes[i], GetParam());
    for (std::size_t k = 0; k < reference.size(); ++k) {
      ASSERT_LE((other[k].pose.position - reference[k].pose.position).norm(), 1e-9) << i << " step " << k;
      ASSERT_LE((other[k].pose.rotation.matrix() - reference[k].pose.rotation.matrix()).norm(), 1e-9);
      ASSERT_LE((other[k].velocity - reference[k].velocity).norm(), 1e-9) << i << " step " << k;
    }
  }
}

// What each motion is for does happen in it.
TEST_P(SameSphere, DoesWhatItIsNamedFor) {
  const Motion& motion = GetParam();
  const auto states = trajectory(descriptions()[0], motion);
  const auto slip = [](const BodyState<3>& s) {
    return point_velocity<3>(s.velocity, Vector<3>(0, 0, -kRadius)).head<2>().norm();
  };
  const Twist<3>& end = states.back().velocity;
  const std::string name = motion.name;
  if (name == "rolling") {
    for (const auto& state : states) ASSERT_LE(slip(state), 1e-9);
  } else if (name == "sliding") {
    EXPECT_GT(slip(states[5]), 1.0);
    EXPECT_LE(slip(states.back()), 1e-9) << "ends in rolling";
  } else if (name == "impact") {
    EXPECT_GT(states[5].pose.position.z(), kRadius + 0.1);
    EXPECT_NEAR(states.back().pose.position.z(), kRadius, 1e-9) << "plastic";
  } else {
    EXPECT_NEAR(end[5], 0, 1e-9) << "torsion has stopped the spin";
    EXPECT_GT(states[5].velocity[5], 5);
  }
}

TEST(SameSphereControl, AnotherExponentIsAnotherTrajectory) {
  Shape<3> shape = descriptions()[2];
  std::get<Superellipsoid<3>>(shape.geometry).exponents.setConstant(2.01);
  const Motion& motion = kMotions[0];
  const Vector<3> moved = trajectory(shape, motion).back().pose.position -
                          trajectory(descriptions()[0], motion).back().pose.position;
  EXPECT_GT(moved.norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Motions, SameSphere, testing::ValuesIn(kMotions),
                         [](const auto& motion) { return std::string(motion.param.name); });

}  // namespace
}  // namespace touchstone
