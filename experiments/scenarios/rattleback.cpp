#include "experiments/scenarios/rattleback.h"

#include <cmath>

#include "experiments/scenarios/fixed_plane.h"

namespace touchstone {

namespace {

Inertia<3> inertia_of(const Rattleback& p) {
  Inertia<3> inertia = p.moments.asDiagonal();
  inertia(0, 1) = inertia(1, 0) = p.product;
  return inertia;
}

}  // namespace

truth::RollingEllipsoid Rattleback::rolling() const {
  truth::RollingEllipsoid body;
  body.mass = mass;
  body.semi_axes = semi_axes;
  body.center = {0, 0, drop};
  body.inertia = inertia_of(*this);
  body.gravity = {0, 0, -gravity};
  body.omega = {nudge, 0, spin};
  return body;
}

Scene<3> rattleback_scene(const Rattleback& parameters) {
  Scene<3> scene;
  scene.gravity = {0, 0, -parameters.gravity};
  scene.contact_law.mu = parameters.mu;

  Body<3> back;
  back.name = "back";
  back.mass = parameters.mass;
  back.inertia = inertia_of(parameters);
  back.shape.geometry = Ellipsoid<3>{parameters.semi_axes};
  back.shape.placement.position = {0, 0, parameters.drop};
  const double height = parameters.semi_axes.z() - parameters.drop;
  back.pose.position = {0, 0, height};
  const Vector<3> omega(parameters.nudge, 0, parameters.spin);
  back.velocity << -omega.cross(Vector<3>(0, 0, -height)), omega;

  scene.bodies = {back, fixed_plane<3>("table")};
  scene.validate();
  return scene;
}

Reversals count_reversals(const std::vector<double>& times, const std::vector<double>& spins) {
  Reversals reversals;
  if (spins.empty()) return reversals;
  const double least = 0.1 * std::abs(spins.front());
  double sense = std::copysign(1.0, spins.front());
  double crossing = 0.0;
  for (std::size_t i = 1; i < spins.size(); ++i) {
    if (sense * spins[i - 1] > 0 && sense * spins[i] <= 0) {
      crossing = times[i - 1] + (times[i] - times[i - 1]) * spins[i - 1] / (spins[i - 1] - spins[i]);
    }
    if (sense * spins[i] > -least) continue;
    sense = -sense;
    if (++reversals.count == 1) reversals.first = crossing;
  }
  return reversals;
}

}  // namespace touchstone
