#include "tests/conformance/traits.h"

#include <array>

namespace touchstone::conformance {

namespace {

struct Row {
  std::string_view prefix;
  Traits traits;
};

constexpr auto kRows = std::to_array<Row>({
    // Extrapolation of velocity_first, whose error in the position is (g/2) t h exactly: nothing is left.
    // A combination of two poses that hold a joint each holds it to second order, h^2 = 1e-4 here.
    {"implicit_ncp_extrapolated", {.free_flight = FreeFlight::parabola, .joint_gap = 1e-4}},
    {"stewart_trinkle_extrapolated", {.free_flight = FreeFlight::parabola}},
    // Single precision; depth within the band that Box2D leaves alone.
    {"box2d",
     {.rounding = 2e-6,
      .contact_speed = 2e-4,
      .slip_speed = 4e-4,
      .contact_depth = 1e-5,
      .flat_speed = 1e-3,
      .flat_depth = 1e-4,
      .settling_speed = 1e-3,
      .impulse = 1e-4}},
    // Rolls on its skin, which makes the radius 2.5e-6 longer.
    {"chipmunk", {.free_flight = FreeFlight::position_first, .contact_speed = 1e-5, .settling_speed = 1e-4}},
    {"bullet_si_float",
     {.rounding = 2e-6,
      .contact_speed = 2e-4,
      .slip_speed = 4e-4,
      .contact_depth = 1e-4,
      .flat_speed = 1e-3,
      .flat_depth = 1e-3,
      .settling_speed = 0.1,
      .impulse = 1e-4}},
    {"bullet", {.flat_speed = 2e-4, .flat_depth = 1e-3, .settling_speed = 0.1}},
    // Soft contacts: a resting body sinks by up to a millimetre, and a slipping one hops, because MuJoCo's
    // convex
    // friction asks for a normal velocity of mu times the slip.
    {"mujoco",
     {.contact_speed = 1e-2,
      .slip_speed = 0.15,
      .contact_depth = 1e-3,
      .flat_speed = 1e-2,
      .flat_depth = 1e-3,
      .settling_speed = 1e-2}},
    // Triangle meshes in single precision rock on flat ground.
    {"dart",
     {.contact_speed = 1e-5,
      .slip_speed = 1e-5,
      .flat_speed = 3e-2,
      .flat_depth = 1e-3,
      .settling_speed = 3e-2}},
    {"siconos", {.free_flight = FreeFlight::parabola}},
    // Its collider of convex solids finds one point a step, so a prism on a prism rocks.
    {"ode", {.flat_speed = 5e-2, .flat_depth = 1e-3, .settling_speed = 5e-2}},
    // An integrator with error control; compliant, with friction that creeps at its transition velocity.
    {"simbody_hunt_crossley",
     {.free_flight = FreeFlight::parabola,
      .rounding = 1e-6,
      .contact_speed = 1e-2,
      .slip_speed = 1e-2,
      .contact_depth = 1e-4}},
});

}  // namespace

Traits traits_of(std::string_view key) {
  for (const auto& row : kRows) {
    if (key.starts_with(row.prefix)) return row.traits;
  }
  return {};
}

}  // namespace touchstone::conformance
