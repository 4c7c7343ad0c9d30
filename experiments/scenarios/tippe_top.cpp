#include "experiments/scenarios/tippe_top.h"

#include <cmath>

#include "experiments/scenarios/fixed_plane.h"
#include "experiments/scenarios/truths/gyroscopes.h"

namespace touchstone {

namespace {

Vector<3> axis_of(const BodyState<3>& top) { return top.pose.rotation.matrix().col(2); }

/// From the centre of mass to the lowest point of the ball.
Vector<3> contact_arm(const TippeTop& p, const Vector<3>& axis) {
  return p.offset * axis - p.radius * Vector<3>::UnitZ();
}

}  // namespace

double TippeTop::jellett(const BodyState<3>& top) const {
  return truth::jellett_constant(axial, transverse, radius, offset, axis_of(top), top.velocity.tail<3>());
}

double TippeTop::inclination(const BodyState<3>& top) const {
  const Vector<3> axis = axis_of(top);
  return std::atan2(axis.head<2>().norm(), axis.z());
}

double TippeTop::slip(const BodyState<3>& top) const {
  return point_velocity<3>(top.velocity, contact_arm(*this, axis_of(top))).head<2>().norm();
}

Scene<3> tippe_top_scene(const TippeTop& parameters) {
  Scene<3> scene;
  scene.gravity = {0, 0, -parameters.gravity};
  scene.contact_law.mu = parameters.mu;

  Body<3> top;
  top.name = "top";
  top.mass = parameters.mass;
  top.inertia = Vector<3>(parameters.transverse, parameters.transverse, parameters.axial).asDiagonal();
  top.shape.geometry = Sphere<3>{parameters.radius};
  top.shape.placement.position = {0, 0, parameters.offset};
  top.pose.rotation = SpatialRotation(exp_rotation(Vector<3>(parameters.tilt, 0, 0)));
  const Vector<3> axis = top.pose.rotation.matrix().col(2);
  top.pose.position = parameters.radius * Vector<3>::UnitZ() - parameters.offset * axis;  // ball at (0, 0, R)
  const Vector<3> omega = parameters.spin * (parameters.about_axis ? axis : Vector<3>::UnitZ());
  top.velocity.tail<3>() = omega;
  if (parameters.about_axis) {
    top.velocity.head<3>() = -omega.cross(contact_arm(parameters, axis));
  }

  scene.bodies = {top, fixed_plane<3>("table")};
  scene.validate();
  return scene;
}

}  // namespace touchstone
