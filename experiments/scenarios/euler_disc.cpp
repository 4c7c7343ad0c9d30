#include "experiments/scenarios/euler_disc.h"

#include <cmath>

#include "experiments/scenarios/fixed_plane.h"

namespace touchstone {

Scene<3> euler_disc_scene(const EulerDiscScene& parameters) {
  const truth::EulerDisc& disc = parameters.disc;
  Scene<3> scene;
  scene.gravity = {0, 0, -disc.gravity};
  scene.contact_law.mu = parameters.mu;
  scene.contact_law.e_r = parameters.torsion;

  Body<3> coin;
  coin.name = "coin";
  coin.mass = disc.mass;
  coin.inertia = Vector<3>(disc.transverse, disc.transverse, disc.axial).asDiagonal();
  coin.shape.geometry = Cylinder{disc.radius, disc.half_height};
  const double alpha = parameters.inclination;
  coin.pose.position = {0, 0, disc.center_height(alpha)};
  coin.pose.rotation = SpatialRotation(exp_rotation(Vector<3>(0, alpha, 0)));
  // Turned by alpha about y, the coin's x-axis falls: the steepest way up in its plane is -x.
  const Matrix<3> axes = coin.pose.rotation.matrix();
  const Vector<3> up = -axes.col(0);
  const Vector<3> e3 = axes.col(2);
  const Vector<3> omega = disc.omega(alpha);
  coin.velocity.tail<3>() = omega[0] * up + omega[1] * e3 + omega[2] * e3.cross(up);

  scene.bodies = {coin, fixed_plane<3>("table")};
  scene.validate();
  return scene;
}

EulerDiscMotion euler_disc_motion(const BodyState<3>& coin) {
  const Vector<3> axis = coin.pose.rotation.matrix().col(2);
  const Vector<3> omega = coin.velocity.tail<3>();
  const Vector<3> axis_rate = omega.cross(axis);
  const double sine = axis.head<2>().norm();
  EulerDiscMotion motion;
  motion.inclination = std::atan2(sine, axis.z());
  motion.precession = (axis.x() * axis_rate.y() - axis.y() * axis_rate.x()) / (sine * sine);
  motion.contact_spin = omega.z();
  motion.center_speed = coin.velocity.head<2>().norm();
  return motion;
}

}  // namespace touchstone
