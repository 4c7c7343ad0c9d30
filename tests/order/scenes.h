#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "baselines/registry.h"
#include "experiments/scenarios/truths/ellipsoid_rolling.h"
#include "experiments/scenarios/truths/sphere_on_spheres.h"

/// Scenes of truths, and methods run on them.
namespace touchstone::order {

/// How balls are modelled: by their own shape, or as ellipsoids with equal semi-axes, which no method may
/// tell from them.
enum class Balls { spheres, ellipsoids };

inline Shape<3> ball_shape(double radius, Balls as) {
  if (as == Balls::spheres) return {Sphere<3>{radius}, {}};
  return {Ellipsoid<3>{Vector<3>::Constant(radius)}, {}};
}

/// Bodies "ball", "support 1" and "support 2".
inline Scene<3> scene_of(const truth::SphereOnSpheres& truth, Balls as) {
  Scene<3> scene;
  scene.contact_law = {.mu = truth.mu, .e_t = truth.e_slip, .e_o = truth.e_slip, .e_r = truth.e_r};
  Body<3> ball{.name = "ball", .mass = truth.mass};
  ball.inertia = truth.inertia * Inertia<3>::Identity();
  ball.pose.position = truth.position;
  ball.force = truth.force;
  ball.shape = ball_shape(truth.radius, as);
  scene.bodies.push_back(ball);
  for (const truth::FixedBall& fixed : truth.supports) {
    Body<3> support{.name = "support " + std::to_string(scene.bodies.size()), .fixed = true};
    support.pose.position = fixed.center;
    support.shape = ball_shape(fixed.radius, as);
    scene.bodies.push_back(support);
  }
  return scene;
}

/// A triaxial ellipsoid that rolls and wobbles on the plane z = 0.
inline truth::RollingEllipsoid rolling_ellipsoid() {
  truth::RollingEllipsoid truth;
  truth.semi_axes = {1.0, 0.8, 0.6};
  truth.inertia = truth::RollingEllipsoid::solid_inertia(truth.mass, truth.semi_axes);
  truth.omega = {0.3, 2.0, 0.5};
  return truth;
}

/// The same on a larger fixed ellipsoid, from the top of it.
inline truth::RollingEllipsoid ellipsoid_on_ellipsoid() {
  truth::RollingEllipsoid truth = rolling_ellipsoid();
  truth.support = truth::FixedEllipsoid{{0, 0, -4}, {6, 5, 4}, Eigen::Quaterniond::Identity()};
  return truth;
}

/// Bodies "ellipsoid" and "support"; friction enough for no slip, no torsion. The start is the truth's own.
inline Scene<3> scene_of(const truth::RollingEllipsoid& truth) {
  const truth::EllipsoidSample start = truth::roll_ellipsoid(truth, {0.0}).samples.front();
  Scene<3> scene;
  scene.gravity = truth.gravity;
  scene.contact_law.mu = 2.0;
  Body<3> body{.name = "ellipsoid", .mass = truth.mass};
  body.inertia = truth.inertia;
  body.pose = {start.position, SpatialRotation(start.orientation)};
  body.velocity << start.velocity, start.omega;
  body.shape.geometry = Ellipsoid<3>{truth.semi_axes};
  Body<3> support{.name = "support", .fixed = true};
  support.shape.geometry = HalfSpace<3>{};
  if (truth.support) {
    support.pose = {truth.support->center, SpatialRotation(truth.support->orientation)};
    support.shape.geometry = Ellipsoid<3>{truth.support->semi_axes};
  }
  scene.bodies = {body, support};
  return scene;
}

/// State of body 0 at each of `times`, multiples of h, by the method `key`. Fails the test if a step fails.
inline std::vector<BodyState<3>> run(const std::string& key, const Scene<3>& scene, double h,
                                     const std::vector<double>& times) {
  const auto method = find_method<3>(key).make(scene, {});
  std::vector<BodyState<3>> states;
  long k = 0;
  for (const double t : times) {
    for (const long end = std::lround(t / h); k < end; ++k) {
      const StepReport report = method->step(h);
      if (report.status != StepStatus::solved) {
        ADD_FAILURE() << key << ", h = " << h << ", step " << k + 1 << ": " << report.reason;
        return states;
      }
    }
    states.push_back(method->state()[0]);
  }
  return states;
}

}  // namespace touchstone::order
