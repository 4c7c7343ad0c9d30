// A sweep steps several worlds at the same time: none may disturb another, whatever its library shares.

#include <gtest/gtest.h>

#include <thread>

#include "baselines/registry.h"

namespace touchstone {
namespace {

/// A ball that slides and comes to roll on the ground.
Scene<3> sliding_ball() {
  Scene<3> scene;
  scene.gravity = {0, 0, -9.81};
  scene.contact_law.mu = 0.3;
  Body<3> ball;
  ball.name = "ball";
  ball.inertia = 0.4 * Inertia<3>::Identity();
  ball.pose.position = {0, 0, 1};
  ball.velocity << 2, 0, 0, 0, 0, 0;
  ball.shape.geometry = Sphere<3>{1.0};
  Body<3> ground;
  ground.name = "ground";
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<3>{};
  scene.bodies = {ball, ground};
  return scene;
}

Twist<3> velocity_after(const MethodEntry<3>& entry, int steps) {
  const auto method = entry.make(sliding_ball(), {});
  for (int k = 0; k < steps; ++k) {
    if (method->step(0.001).status != StepStatus::solved) ADD_FAILURE() << entry.key << " step " << k;
  }
  return method->state()[0].velocity;
}

class Threads : public testing::TestWithParam<const char*> {};

TEST_P(Threads, StepWorldsThatDoNotDisturbEachOther) {
  const MethodEntry<3>& entry = find_method<3>(GetParam());
  constexpr int kSteps = 4000;
  const Twist<3> alone = velocity_after(entry, kSteps);
  std::array<Twist<3>, 4> together;
  {
    std::vector<std::jthread> threads;
    for (Twist<3>& velocity : together) {
      threads.emplace_back([&] { velocity = velocity_after(entry, kSteps); });
    }
  }
  for (const Twist<3>& velocity : together) EXPECT_EQ(velocity, alone);
}

// The engines that are in every build; ODE's worlds share a threading implementation unless told otherwise.
INSTANTIATE_TEST_SUITE_P(Engines, Threads,
                         testing::Values("ode_step", "ode_quickstep", "bullet_si", "stewart_trinkle",
                                         "implicit_ncp"));

}  // namespace
}  // namespace touchstone
