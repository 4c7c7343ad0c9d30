#include "experiments/scenarios/spheres_in_box.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/model/errors.h"
#include "core/model/mass_properties.h"

namespace touchstone {

namespace {

constexpr double kRoom = 1.01;  ///< of the place of a sphere, over what the largest needs

/// Even on [0, 1), the same on every machine, which the standard's distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double number() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Even on the sphere: z and the angle about it are.
  Vector<3> direction() {
    const double z = 2 * number() - 1;
    const double angle = 2 * std::numbers::pi * number();
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

double place_width(const SpheresInBox& p) { return 2 * kRoom * p.largest_radius; }

/// The middle of place `i`: layers of edge x edge places in a square pattern, every other one shifted by half
/// a place along x and y, so that neighbours are a place's width apart, within a layer and between two.
Vector<3> place(int i, int edge, double width) {
  const int layer = i / (edge * edge);
  const int row = i / edge % edge;
  const int column = i % edge;
  const double shift = layer % 2 == 0 ? 0.5 : 1.0;
  return width * Vector<3>(column + shift, row + shift, 0.5 + layer / std::numbers::sqrt2);
}

void require(bool holds, const char* field, double value, const char* allowed) {
  if (!holds) throw InputError(field, value, allowed);
}

void validate(const SpheresInBox& p) {
  require(p.spheres >= 1, "spheres", p.spheres, "at least 1");
  require(p.mass > 0, "mass", p.mass, "> 0 [kg]");
  require(p.smallest_radius > 0, "smallest_radius", p.smallest_radius, "> 0 [m]");
  require(p.largest_radius >= p.smallest_radius, "largest_radius", p.largest_radius,
          "at least the smallest [m]");
  require(p.layers >= 0, "layers", p.layers, "at least 0");
}

Body<3> half_space(const char* name, const Vector<3>& normal, double offset) {
  Body<3> body;
  body.name = name;
  body.fixed = true;
  body.shape.geometry = HalfSpace<3>{normal, offset};
  return body;
}

}  // namespace

int SpheresInBox::spheres_along_edge() const {
  if (layers > 0) return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(spheres) / layers)));
  // n = edge^2 layers, and a layer is 1 / sqrt 2 of a place high.
  return std::max(1, static_cast<int>(std::lround(std::cbrt(spheres / std::numbers::sqrt2))));
}

double SpheresInBox::width() const { return (spheres_along_edge() + 0.5) * place_width(*this); }

Scene<3> spheres_in_box_scene(const SpheresInBox& parameters) {
  validate(parameters);
  Scene<3> scene;
  scene.gravity = {0, 0, -parameters.gravity};
  scene.contact_law.mu = parameters.mu;
  Random random(parameters.seed);
  const double room = place_width(parameters);
  for (int i = 0; i < parameters.spheres; ++i) {
    const double radius = parameters.smallest_radius +
                          (parameters.largest_radius - parameters.smallest_radius) * random.number();
    Body<3> sphere;
    sphere.name = fmt::format("sphere {}", i + 1);
    sphere.mass = parameters.mass;
    sphere.shape.geometry = Sphere<3>{radius};
    sphere.inertia = uniform_inertia(sphere.shape, sphere.mass);
    const double off = (room / 2 - radius) * random.number();
    sphere.pose.position = place(i, parameters.spheres_along_edge(), room) + off * random.direction();
    scene.bodies.push_back(sphere);
  }
  const double width = parameters.width();
  scene.bodies.push_back(half_space("floor", Vector<3>::UnitZ(), 0));
  scene.bodies.push_back(half_space("wall -x", Vector<3>::UnitX(), 0));
  scene.bodies.push_back(half_space("wall +x", -Vector<3>::UnitX(), -width));
  scene.bodies.push_back(half_space("wall -y", Vector<3>::UnitY(), 0));
  scene.bodies.push_back(half_space("wall +y", -Vector<3>::UnitY(), -width));
  scene.validate();
  return scene;
}

}  // namespace touchstone
