#include "experiments/scenarios/sphere_on_spheres.h"

namespace touchstone {

namespace {

Shape<3> ball_of(BallShape shape, double radius) {
  Shape<3> ball;
  if (shape == BallShape::ellipsoid) {
    ball.geometry = Ellipsoid<3>{Vector<3>::Constant(radius)};
  } else {
    ball.geometry = Sphere<3>{radius};
  }
  return ball;
}

}  // namespace

Scene<3> sphere_on_spheres_scene(BallShape shape, const truth::SphereOnSpheres& parameters) {
  Scene<3> scene;
  scene.contact_law.mu = parameters.mu;
  scene.contact_law.e_t = parameters.e_slip;
  scene.contact_law.e_o = parameters.e_slip;
  scene.contact_law.e_r = parameters.e_r;

  Body<3> ball;
  ball.name = "ball";
  ball.mass = parameters.mass;
  ball.inertia = parameters.inertia * Inertia<3>::Identity();
  ball.pose.position = parameters.position;
  ball.force = parameters.force;
  ball.shape = ball_of(shape, parameters.radius);
  scene.bodies.push_back(ball);

  for (const truth::FixedBall& fixed : parameters.supports) {
    Body<3> support;
    support.name = "support " + std::to_string(scene.bodies.size());
    support.fixed = true;
    support.pose.position = fixed.center;
    support.shape = ball_of(shape, fixed.radius);
    scene.bodies.push_back(support);
  }
  scene.validate();
  return scene;
}

}  // namespace touchstone
