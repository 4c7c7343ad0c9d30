#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/conformance/claims.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/scenes.h"

/// Friction: its size, its direction, its mixing, its torsion.
namespace touchstone::conformance {

namespace {

/// A ball thrown flat without spin slides, losing mu g, until v0 / (1 + b) (b = I / (m r^2)) is the speed of
/// both its centre and its rim: exactly, because the angular momentum about the ground's points is kept.
template <int Dim>
void slide_to_roll(const Subject<Dim>& subject) {
  constexpr double kSpeed = 2.0;
  constexpr double kMu = 0.1;
  constexpr double b = inertia_ratio<Dim>();
  Body<Dim> body = ball<Dim>("ball", up<Dim>());
  body.velocity[0] = kSpeed;
  const auto method = subject.entry.make(on_ground(body, kMu), {});
  advance(*method, kStep, 40);
  const double lost = kMu * kGravity * 40 * kStep;
  const double slip = subject.traits.slip_speed;
  const double tolerance = 2 * subject.traits.contact_speed;
  EXPECT_NEAR(method->state()[0].velocity[0], kSpeed - lost, slip) << "while it slides";
  EXPECT_NEAR(rim_speed<Dim>(method->state()[0].velocity, 1.0), lost / b, slip / b) << "while it slides";
  advance(*method, kStep, 60);
  EXPECT_NEAR(method->state()[0].velocity[0], kSpeed / (1 + b), tolerance) << "rolling";
  EXPECT_NEAR(rim_speed<Dim>(method->state()[0].velocity, 1.0), kSpeed / (1 + b), 2 * tolerance) << "rolling";
}

/// Three coefficients in one scene: the default, and a law for each of two pairs.
template <int Dim>
void pair_laws(const Subject<Dim>& subject) {
  Scene<Dim> scene = on_ground(ball<Dim>("default", up<Dim>()), 0.3);
  scene.bodies.push_back(ball<Dim>("slippery", up<Dim>() + 10 * Vector<Dim>::Unit(0)));
  scene.bodies.push_back(ball<Dim>("rough", up<Dim>() - 10 * Vector<Dim>::Unit(0)));
  ContactLaw<Dim> slippery = scene.contact_law;
  slippery.mu = 0.1;
  ContactLaw<Dim> rough = scene.contact_law;
  rough.mu = 0.5;
  scene.pair_laws = {{2, 1, slippery}, {1, 3, rough}};
  for (auto& body : scene.bodies) {
    if (!body.fixed) body.velocity[0] = 3.0;
  }
  const auto method = subject.entry.make(scene, {});
  constexpr int kSteps = 10;
  advance(*method, kStep, kSteps);
  const auto speed = [&](int body) { return method->state()[static_cast<std::size_t>(body)].velocity[0]; };
  const double tolerance = subject.traits.slip_speed;
  EXPECT_NEAR(speed(0), 3.0 - 0.3 * kGravity * kSteps * kStep, tolerance) << "default law";
  EXPECT_NEAR(speed(2), 3.0 - 0.1 * kGravity * kSteps * kStep, tolerance) << "law of the slippery pair";
  EXPECT_NEAR(speed(3), 3.0 - 0.5 * kGravity * kSteps * kStep, tolerance) << "law of the rough pair";
}

/// Two bodies of different coefficients on one ground, which an engine with one number a body can mix, too.
template <int Dim>
void two_laws(const Subject<Dim>& subject) {
  Scene<Dim> scene = on_ground(ball<Dim>("default", up<Dim>()), 0.3);
  scene.bodies.push_back(ball<Dim>("slippery", up<Dim>() + 10 * Vector<Dim>::Unit(0)));
  ContactLaw<Dim> slippery = scene.contact_law;
  slippery.mu = 0.1;
  scene.pair_laws = {{1, 2, slippery}, {0, 2, slippery}};
  scene.bodies[0].velocity[0] = scene.bodies[2].velocity[0] = 3.0;
  const auto method = subject.entry.make(scene, {});
  constexpr int kSteps = 10;
  advance(*method, kStep, kSteps);
  const double tolerance = subject.traits.slip_speed;
  EXPECT_NEAR(method->state()[0].velocity[0], 3.0 - 0.3 * kGravity * kSteps * kStep, tolerance);
  EXPECT_NEAR(method->state()[2].velocity[0], 3.0 - 0.1 * kGravity * kSteps * kStep, tolerance);
}

/// A ball that rolls more slowly than any engine's threshold for sleep rolls on.
template <int Dim>
void slow_rolling(const Subject<Dim>& subject) {
  constexpr double kSpeed = 5e-3;
  Body<Dim> body = ball<Dim>("ball", up<Dim>());
  body.velocity[0] = kSpeed;
  body.velocity.template tail<Dimension<Dim>::angular>() = rolling<Dim>(kSpeed, 1.0);
  const auto method = subject.entry.make(on_ground(body, 0.5), {});
  advance(*method, kStep, 500);
  EXPECT_NEAR(method->state()[0].velocity[0], kSpeed, std::min(0.1 * kSpeed, subject.traits.contact_speed));
  EXPECT_NEAR(rim_speed<Dim>(method->state()[0].velocity, 1.0), kSpeed, 0.1 * kSpeed);
}

/// Without friction nothing but the normal acts.
template <int Dim>
void frictionless(const Subject<Dim>& subject) {
  Body<Dim> body = ball<Dim>("ball", up<Dim>());
  body.velocity[0] = 1.0;
  body.velocity.template tail<Dimension<Dim>::angular>() = -rolling<Dim>(2.0, 1.0);
  const auto method = subject.entry.make(on_ground(body, 0.0), {});
  advance(*method, kStep, 50);
  EXPECT_NEAR(method->state()[0].velocity[0], 1.0, subject.traits.contact_speed);
  EXPECT_NEAR(rim_speed<Dim>(method->state()[0].velocity, 1.0), -2.0, subject.traits.contact_speed);
}

/// The spinning sphere of the paper: omega_z falls by mu e_r m g h / I a step, to exactly 0.
void torsion(const Subject<3>& subject) {
  Body<3> body = ball<3>("ball", up<3>());
  body.velocity[5] = 1.0;
  Scene<3> scene = on_ground(body, 0.2);
  scene.contact_law.e_r = 0.4;
  const auto method = make_claimed(subject.entry, scene, &Capabilities::torsional_friction);
  advance(*method, kStep, 20);
  EXPECT_NEAR(method->state()[0].velocity[5], 1.0 - 0.2 * 0.4 * kGravity / 0.4 * 20 * kStep,
              subject.traits.slip_speed);
  advance(*method, kStep, 80);
  EXPECT_NEAR(method->state()[0].velocity[5], 0.0, subject.traits.contact_speed);
}

/// A ball sliding along t meets mu e_t, along o mu e_o, wherever t points.
void anisotropy(const Subject<3>& subject) {
  const Vector<3> t = Vector<3>(3, 4, 0) / 5;
  for (const auto& [direction, mu] :
       {std::pair{t, 0.2 * 1.5}, std::pair{up<3>().cross(t).eval(), 0.2 * 0.5}}) {
    Body<3> body = ball<3>("ball", up<3>());
    body.velocity.head<3>() = 3.0 * direction;
    Scene<3> scene = on_ground(body, 0.2);
    scene.contact_law.e_t = 1.5;
    scene.contact_law.e_o = 0.5;
    scene.contact_law.tangent = t;
    const auto method = make_claimed(subject.entry, scene, &Capabilities::anisotropic_friction);
    advance(*method, kStep, 10);
    EXPECT_NEAR(method->state()[0].velocity.head<3>().dot(direction), 3.0 - mu * kGravity * 10 * kStep,
                2 * subject.traits.slip_speed);
  }
}

/// A ball sliding at 30 degrees to every axis keeps its direction if friction is a cone; a box or pyramid
/// bends its path. That is no failure of an adapter, but told in the matrix.
void isotropy(const Subject<3>& subject) {
  constexpr double kAngle = std::numbers::pi / 6;
  const Vector<3> along(std::cos(kAngle), std::sin(kAngle), 0);
  const Vector<3> across(-std::sin(kAngle), std::cos(kAngle), 0);
  Body<3> body = ball<3>("ball", up<3>());
  body.velocity.head<3>() = 3.0 * along;
  const auto method = subject.entry.make(on_ground(body, 0.2), {});
  advance(*method, kStep, 20);
  const double sideways = method->state()[0].velocity.head<3>().dot(across);
  if (std::abs(sideways) > subject.traits.contact_speed) {
    throw Unsupported(
        fmt::format("friction depends on the direction: {:.2g} m/s sideways after 0.2 s", sideways));
  }
}

}  // namespace

template <int Dim>
std::vector<Feature<Dim>> friction_features() {
  std::vector<Feature<Dim>> features = {
      {"slide_to_roll", "friction is mu times the normal force, and ends when it rolls", &slide_to_roll<Dim>},
      {"pair_laws", "each pair of bodies has its own coefficient", &pair_laws<Dim>},
      {"two_laws", "two bodies of different coefficients, on one ground", &two_laws<Dim>},
      {"slow_rolling", "a ball that rolls slowly rolls on: no sleep in contact", &slow_rolling<Dim>},
      {"frictionless", "mu = 0 is no friction", &frictionless<Dim>},
  };
  if constexpr (Dim == 3) {
    features.push_back({"torsional_friction", "a spinning ball stops as mu e_r says", &torsion});
    features.push_back({"anisotropic_friction", "mu e_t and mu e_o act along t and o", &anisotropy});
    features.push_back({"friction_cone", "friction is the same in every direction", &isotropy});
  }
  return features;
}
template std::vector<Feature<2>> friction_features();
template std::vector<Feature<3>> friction_features();

}  // namespace touchstone::conformance
