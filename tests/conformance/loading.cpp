#include <gtest/gtest.h>

#include "baselines/engines/engine.h"
#include "core/model/errors.h"
#include "tests/conformance/feature.h"
#include "tests/conformance/scenes.h"

/// Is what a method has loaded what the scene says?
namespace touchstone::conformance {

namespace {

Inertia<2> skew_inertia(Inertia<2>) { return Inertia<2>(0.7); }
/// Principal moments 1, 2 and 2.5 about axes that are not the body's.
Inertia<3> skew_inertia(Inertia<3>) {
  const Matrix<3> r = SpatialRotation(Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2)).matrix();
  return r * Vector<3>(1.0, 2.0, 2.5).asDiagonal() * r.transpose();
}

template <int Dim>
Body<Dim> skew_ball() {
  Body<Dim> body = ball<Dim>("skew", 3 * up<Dim>() + Vector<Dim>::Unit(0), 0.5);
  body.mass = 2.5;
  body.inertia = skew_inertia(body.inertia);
  body.pose.rotation = skew_rotation(body.pose.rotation);
  for (int i = 0; i < Dimension<Dim>::velocity; ++i) body.velocity[i] = 0.3 * i - 0.5;
  return body;
}

template <int Dim>
double rotation_error(const Rotation<Dim>& a, const Rotation<Dim>& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

template <int Dim>
void state_is_echoed(const Subject<Dim>& subject) {
  Scene<Dim> scene = on_ground(skew_ball<Dim>(), 0.3);
  scene.bodies.push_back(ball<Dim>("second", 5 * up<Dim>()));
  scene.bodies.push_back(ball<Dim>("fixed", 8 * up<Dim>()));
  scene.bodies.back().fixed = true;
  const auto method = subject.entry.make(scene, {});
  const auto expected = initial_state(scene);
  ASSERT_EQ(method->state().size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& state = method->state()[i];
    const double tolerance = 10 * subject.traits.rounding;
    EXPECT_LE((state.pose.position - expected[i].pose.position).norm(), tolerance) << scene.bodies[i].name;
    EXPECT_LE(rotation_error<Dim>(state.pose.rotation, expected[i].pose.rotation), tolerance);
    EXPECT_LE((state.velocity - expected[i].velocity).norm(), tolerance) << scene.bodies[i].name;
  }
}

/// Only methods with a copy of their own can get it wrong; the others read the scene.
template <int Dim>
void mass_is_echoed(const Subject<Dim>& subject) {
  const Body<Dim> body = skew_ball<Dim>();
  const auto method = subject.entry.make(on_ground(body, 0.3), {});
  const auto* tells = dynamic_cast<const engines::TellsMass<Dim>*>(method.get());
  if (tells == nullptr) return;
  const auto loaded = tells->mass_properties(0);
  EXPECT_NEAR(loaded.mass, body.mass, 10 * subject.traits.rounding);
  EXPECT_LE((loaded.inertia - body.inertia).norm(), 10 * subject.traits.rounding);
}

/// Kinetic energy of the body that the method has, as far as it has a copy of its own: mass, inertia and
/// velocity in frames that belong together.
template <int Dim>
void energy_is_echoed(const Subject<Dim>& subject) {
  const Body<Dim> body = skew_ball<Dim>();
  const auto kinetic = [](double mass, const Inertia<Dim>& inertia, const BodyState<Dim>& state) {
    const Vector<Dim> v = state.velocity.template head<Dim>();
    const Angular<Dim> w = state.velocity.template tail<Dimension<Dim>::angular>();
    return 0.5 * mass * v.squaredNorm() + 0.5 * w.dot(world_inertia(inertia, state.pose.rotation) * w);
  };
  const double expected = kinetic(body.mass, body.inertia, {body.pose, body.velocity});
  ASSERT_GT(expected, 0.1);
  const auto method = subject.entry.make(on_ground(body, 0.3), {});
  const auto* tells = dynamic_cast<const engines::TellsMass<Dim>*>(method.get());
  const auto loaded =
      tells != nullptr ? tells->mass_properties(0) : engines::MassProperties<Dim>{body.mass, body.inertia};
  EXPECT_NEAR(kinetic(loaded.mass, loaded.inertia, method->state()[0]), expected,
              10 * subject.traits.rounding * expected);
}

template <int Dim>
void options_come_back(const Subject<Dim>& subject) {
  const Scene<Dim> scene = on_ground(ball<Dim>("ball", up<Dim>()), 0.3);
  const Options effective = subject.entry.make(scene, {})->effective_options();
  EXPECT_EQ(subject.entry.make(scene, effective)->effective_options(), effective);
}

template <int Dim>
void unknown_options_are_refused(const Subject<Dim>& subject) {
  const Scene<Dim> scene = on_ground(ball<Dim>("ball", up<Dim>()), 0.3);
  static_cast<void>(subject.entry.make(scene, {}));  // so that Unsupported does not look like a refusal
  EXPECT_THROW(static_cast<void>(subject.entry.make(scene, {{"no_such_option", "1"}})), InputError);
  for (const auto& [name, value] : subject.entry.make(scene, {})->effective_options()) {
    EXPECT_THROW(static_cast<void>(subject.entry.make(scene, {{name, "nonsense"}})), InputError) << name;
  }
}

template <int Dim>
void engine_names_its_version(const Subject<Dim>& subject) {
  if (subject.entry.version == nullptr) return;
  const std::string version = subject.entry.version();
  const auto method = subject.entry.make(on_ground(ball<Dim>("ball", up<Dim>()), 0.3), {});
  const bool has_a_world = dynamic_cast<const engines::TellsMass<Dim>*>(method.get()) != nullptr;
  EXPECT_EQ(version.empty(), !has_a_world)
      << "who has an engine behind it has a version: '" << version << "'";
  EXPECT_TRUE(version.empty() || std::isdigit(static_cast<unsigned char>(version.front()))) << version;
}

}  // namespace

template <int Dim>
std::vector<Feature<Dim>> loading_features() {
  return {
      {"state_echo", "pose and velocity after loading are the scene's", &state_is_echoed<Dim>},
      {"mass_echo", "mass and inertia, about the right axes, are the scene's", &mass_is_echoed<Dim>},
      {"energy_echo", "kinetic energy after loading is the scene's", &energy_is_echoed<Dim>},
      {"options_echo", "the options in force can be given back", &options_come_back<Dim>},
      {"options_checked", "unknown options and bad values are refused", &unknown_options_are_refused<Dim>},
      {"version", "the library tells its version", &engine_names_its_version<Dim>},
  };
}
template std::vector<Feature<2>> loading_features();
template std::vector<Feature<3>> loading_features();

}  // namespace touchstone::conformance
