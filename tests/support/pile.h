#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/model/scene.h"

/// Round bodies on top of each other on the ground, in the plane and in space alike.
namespace touchstone {

/// (x, y, height) in space, (x, height) in the plane; of a point [m] or of a velocity [m/s].
template <int Dim>
Vector<Dim> at(double x, double y, double height) {
  Vector<Dim> vector = Vector<Dim>::Zero();
  vector[0] = x;
  if constexpr (Dim == 3) vector[1] = y;
  vector[Dim - 1] = height;
  return vector;
}

/// A ball of radius 1 m at rest, with the inertia of a solid one; in the plane a disc.
/// @param mass  [kg]
template <int Dim>
Body<Dim> ball(double mass, const Vector<Dim>& position) {
  Body<Dim> body;
  body.mass = mass;
  body.inertia = 0.4 * mass * Inertia<Dim>::Identity();
  body.pose.position = position;
  body.shape.geometry = Sphere<Dim>{1.0};
  return body;
}

/// The bodies, which are given names, and behind them the ground, a fixed half-space below height 0. Friction
/// differs in all its directions.
template <int Dim>
Scene<Dim> pile(std::vector<Body<Dim>> bodies) {
  Scene<Dim> scene;
  scene.gravity = at<Dim>(0, 0, -9.81);
  scene.contact_law.mu = 0.3;
  scene.contact_law.e_t = 0.9;
  if constexpr (Dim == 3) {
    scene.contact_law.e_o = 0.7;
    scene.contact_law.e_r = 0.2;
  }
  scene.bodies = std::move(bodies);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].name = "body " + std::to_string(i);
  Body<Dim>& ground = scene.bodies.emplace_back();
  ground.name = "ground";
  ground.fixed = true;
  ground.shape.geometry = HalfSpace<Dim>{};
  return scene;
}

}  // namespace touchstone
