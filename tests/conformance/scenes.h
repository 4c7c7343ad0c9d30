#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "baselines/registry.h"

/// Small scenes that read the same in the plane and in space: "up" is the last axis, motion is along x.
namespace touchstone::conformance {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]
inline constexpr double kStep = 0.01;     ///< [s]

template <int Dim>
Vector<Dim> up() {
  return Vector<Dim>::Unit(Dim - 1);
}

/// I / (m r^2) of a round body: a disc, a solid ball.
template <int Dim>
constexpr double inertia_ratio() {
  return Dim == 2 ? 0.5 : 0.4;
}

/// A disc or a ball of 1 kg and `radius`, its centre at `position`.
template <int Dim>
Body<Dim> ball(const std::string& name, const Vector<Dim>& position, double radius = 1.0) {
  Body<Dim> body;
  body.name = name;
  body.inertia = inertia_ratio<Dim>() * radius * radius * Inertia<Dim>::Identity();
  body.pose.position = position;
  body.shape.geometry = Sphere<Dim>{radius};
  return body;
}

/// The fixed half-space below height 0.
template <int Dim>
Body<Dim> ground() {
  Body<Dim> body;
  body.name = "ground";
  body.fixed = true;
  body.shape.geometry = HalfSpace<Dim>{};
  return body;
}

/// `body` and the ground under gravity.
template <int Dim>
Scene<Dim> on_ground(const Body<Dim>& body, double mu) {
  Scene<Dim> scene;
  scene.gravity = -kGravity * up<Dim>();
  scene.contact_law.mu = mu;
  scene.bodies = {body, ground<Dim>()};
  return scene;
}

template <int Dim>
Scene<Dim> alone(const Body<Dim>& body) {
  Scene<Dim> scene;
  scene.bodies = {body};
  return scene;
}

/// Angular velocity of rolling along +x: the component of omega that is `speed` / radius.
template <int Dim>
Angular<Dim> rolling(double speed, double radius) {
  if constexpr (Dim == 2) return Angular<2>(-speed / radius);
  if constexpr (Dim == 3) return {0, speed / radius, 0};
}

/// Speed of a round body's material points around its centre in the sense of rolling along +x [m/s].
template <int Dim>
double rim_speed(const Twist<Dim>& nu, double radius) {
  return nu.template tail<Dimension<Dim>::angular>().dot(rolling<Dim>(1.0, radius)) * radius * radius;
}

/// An orientation that no axis is special to.
inline PlanarRotation skew_rotation(PlanarRotation) { return PlanarRotation(0.7); }
inline SpatialRotation skew_rotation(SpatialRotation) {
  return SpatialRotation(Eigen::Quaterniond(0.5, 0.6, -0.2, 0.4));
}

/// Takes `steps` steps of `h`. @throws std::runtime_error if one fails
template <int Dim>
void advance(Method<Dim>& method, double h, int steps) {
  for (int k = 0; k < steps; ++k) {
    const StepReport report = method.step(h);
    if (report.status == StepStatus::solved) continue;
    throw std::runtime_error("step " + std::to_string(k) + ": " + std::string(to_string(report.status)) +
                             ", " + std::string(report.reason));
  }
}

}  // namespace touchstone::conformance
