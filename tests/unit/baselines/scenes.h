#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "baselines/formulations/stewart_trinkle.h"

/// Scenes of the tests of our own formulations, and how they are run.
namespace touchstone::testing {

inline constexpr double kGravity = 9.81;

template <int Dim>
Body<Dim> body(const std::string& name, const Shape<Dim>& shape, const Vector<Dim>& position) {
  Body<Dim> result;
  result.name = name;
  result.shape = shape;
  result.pose.position = position;
  return result;
}

/// A fixed half-space through `point`, solid on the side away from `normal`.
template <int Dim>
Body<Dim> wall(const std::string& name, const Vector<Dim>& normal, const Vector<Dim>& point) {
  Body<Dim> result = body<Dim>(name, {HalfSpace<Dim>{normal, 0.0}}, point);
  result.fixed = true;
  return result;
}

template <int Dim>
Body<Dim> ground() {
  return wall<Dim>("ground", Vector<Dim>::Unit(Dim - 1), Vector<Dim>::Zero());
}

template <int Dim>
Scene<Dim> scene(double mu, std::vector<Body<Dim>> bodies) {
  Scene<Dim> result;
  result.gravity = -kGravity * Vector<Dim>::Unit(Dim - 1);
  result.contact_law.mu = mu;
  result.bodies = std::move(bodies);
  return result;
}

/// The paper's disc (section V.A): m = 1, I = 0.5, R = 1.
inline Body<2> disc(const std::string& name, const Vector<2>& position, const Twist<2>& velocity) {
  Body<2> result = body<2>(name, {Sphere<2>{1.0}}, position);
  result.inertia << 0.5;
  result.velocity = velocity;
  return result;
}

/// The paper's first example: mu = 0.4, q = (0, 1, 0), nu = (-3, 0, 3).
inline Scene<2> rolling_disc() { return scene<2>(0.4, {disc("disc", {0, 1}, {-3, 0, 3}), ground<2>()}); }

/// A homogeneous block of unit mass that lies on the ground.
inline Body<2> block(const Vector<2>& half_extents, const Vector<2>& position) {
  Body<2> result = body<2>("block", {Box<2>{half_extents}}, position);
  result.inertia << half_extents.squaredNorm() / 3;
  return result;
}

/// A homogeneous unit ball of unit mass.
inline Body<3> ball(const std::string& name, const Vector<3>& position) {
  Body<3> result = body<3>(name, {Sphere<3>{1.0}}, position);
  result.inertia = 0.4 * Inertia<3>::Identity();
  return result;
}

/// Makes `count` steps, all of which must be solved.
template <int Dim>
void advance(Method<Dim>& method, double h, int count) {
  for (int k = 0; k < count; ++k) {
    const StepReport report = method.step(h);
    ASSERT_EQ(report.status, StepStatus::solved) << "step " << k << ": " << report.reason;
    ASSERT_LE(report.residual, 1e-9) << "step " << k;
  }
}

/// Kinetic energy [J] of a planar body of unit mass.
inline double kinetic_energy(const BodyState<2>& state, double inertia) {
  return 0.5 * state.velocity.head<2>().squaredNorm() + 0.5 * inertia * state.velocity[2] * state.velocity[2];
}

/// Largest difference of position, angle and velocity of two planar states.
inline double difference(const BodyState<2>& a, const BodyState<2>& b) {
  return std::max({(a.pose.position - b.pose.position).lpNorm<Eigen::Infinity>(),
                   std::abs(a.pose.rotation.angle() - b.pose.rotation.angle()),
                   (a.velocity - b.velocity).lpNorm<Eigen::Infinity>()});
}

}  // namespace touchstone::testing
