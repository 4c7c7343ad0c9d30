#include "experiments/scenarios/disc_rolling.h"

#include "experiments/scenarios/fixed_plane.h"

namespace touchstone {

Scene<2> disc_rolling_scene(const DiscRolling& parameters) {
  Scene<2> scene;
  scene.gravity = {0.0, -parameters.gravity};
  scene.contact_law.mu = parameters.mu;

  Body<2> disc;
  disc.name = "disc";
  disc.mass = parameters.mass;
  disc.inertia = Inertia<2>(parameters.inertia);
  disc.pose.position = {0.0, parameters.radius};
  // Rolling: the point at the ground, v + omega x (0, -R), is at rest.
  disc.velocity = {-parameters.radius * parameters.angular_velocity, 0.0, parameters.angular_velocity};
  disc.shape.geometry = Sphere<2>{parameters.radius};

  scene.bodies = {disc, fixed_plane<2>("ground")};
  scene.validate();
  return scene;
}

}  // namespace touchstone
