#include "experiments/scenarios/sphere_spin.h"

#include "experiments/scenarios/fixed_plane.h"

namespace touchstone {

Scene<3> sphere_spin_scene(const truth::SpinningSphere& parameters, double radius) {
  Scene<3> scene;
  scene.gravity = {0.0, 0.0, -parameters.gravity};
  scene.contact_law.mu = parameters.friction;
  scene.contact_law.e_r = parameters.e_r;

  Body<3> ball;
  ball.name = "ball";
  ball.mass = parameters.mass;
  ball.inertia = parameters.inertia * Inertia<3>::Identity();
  ball.pose.position = {0.0, 0.0, radius};
  ball.velocity[5] = parameters.omega;
  ball.shape.geometry = Sphere<3>{radius};

  scene.bodies = {ball, fixed_plane<3>("ground")};
  scene.validate();
  return scene;
}

}  // namespace touchstone
