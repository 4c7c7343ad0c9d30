#include "experiments/scenarios/ellipsoid_rolling.h"

#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

/// Where the outward normal of an ellipsoid is n, from its centre: D n / sqrt(n . D n), D = R diag(a^2, b^2,
/// c^2) R^T.
Vector<3> support_point(const Eigen::Quaterniond& orientation, const Vector<3>& semi_axes,
                        const Vector<3>& n) {
  const Vector<3> scaled = semi_axes.cwiseProduct(orientation.conjugate() * n);
  return orientation * Vector<3>(semi_axes.cwiseProduct(scaled) / scaled.norm());
}

}  // namespace

truth::RollingEllipsoid ellipsoid_on_plane() {
  truth::RollingEllipsoid rolling;
  rolling.semi_axes = {1.0, 0.8, 0.6};
  rolling.inertia = truth::RollingEllipsoid::solid_inertia(rolling.mass, rolling.semi_axes);
  rolling.omega = {0.3, 2.0, 0.5};
  return rolling;
}

truth::RollingEllipsoid ellipsoid_spinning() {
  truth::RollingEllipsoid rolling = ellipsoid_on_plane();
  rolling.omega = {0.1, 0.1, 10.0};
  return rolling;
}

truth::RollingEllipsoid ellipsoid_over_its_end() {
  constexpr double before_the_top = 0.7;  // [rad]; 1.2 rad/s are enough to get over it, and not much more
  truth::RollingEllipsoid rolling;
  rolling.semi_axes = {1.0, 0.9, 0.8};
  rolling.inertia = truth::RollingEllipsoid::solid_inertia(rolling.mass, rolling.semi_axes);
  rolling.orientation = Eigen::AngleAxisd(std::numbers::pi / 2 - before_the_top, Vector<3>::UnitY());
  rolling.omega = {0.05, 1.2, 0.05};
  return rolling;
}

truth::RollingEllipsoid ellipsoid_on_ellipsoid() {
  truth::RollingEllipsoid rolling;
  rolling.semi_axes = {0.5, 0.4, 0.3};
  rolling.inertia = truth::RollingEllipsoid::solid_inertia(rolling.mass, rolling.semi_axes);
  rolling.orientation = Eigen::Quaterniond(0.8, 0.0, 0.0, 0.6);  // about the vertical
  rolling.omega = {0.5, 1.0, 0.0};
  rolling.support = truth::FixedEllipsoid{.semi_axes = {2.0, 1.5, 1.0}};
  return rolling;
}

Scene<3> ellipsoid_scene(const truth::RollingEllipsoid& parameters, double mu) {
  Scene<3> scene;
  scene.gravity = parameters.gravity;
  scene.contact_law.mu = mu;

  const Vector<3> n = parameters.normal.normalized();
  const Vector<3> from_contact = support_point(parameters.orientation, parameters.semi_axes, n);
  Body<3> support;
  support.fixed = true;
  Vector<3> touching(parameters.contact.x(), parameters.contact.y(), 0.0);
  if (parameters.support) {
    support.name = "support";
    support.pose.position = parameters.support->center;
    support.pose.rotation = SpatialRotation(parameters.support->orientation);
    support.shape.geometry = Ellipsoid<3>{parameters.support->semi_axes};
    touching = parameters.support->center +
               support_point(parameters.support->orientation, parameters.support->semi_axes, n);
  } else {
    support.name = "ground";
    support.shape.geometry = HalfSpace<3>{};
  }

  Body<3> ellipsoid;
  ellipsoid.name = "ellipsoid";
  ellipsoid.mass = parameters.mass;
  ellipsoid.inertia = parameters.inertia;
  ellipsoid.pose.position = touching + from_contact;
  ellipsoid.pose.rotation = SpatialRotation(parameters.orientation);
  // Rolling: the point at the contact, v + omega x (-from_contact), is at rest.
  ellipsoid.velocity << parameters.omega.cross(from_contact), parameters.omega;
  ellipsoid.shape.geometry = Ellipsoid<3>{parameters.semi_axes};

  scene.bodies = {ellipsoid, support};
  scene.validate();
  return scene;
}

}  // namespace touchstone
