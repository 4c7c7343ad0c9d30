#include "experiments/scene_file/read_body.h"

#include <fmt/format.h>

#include "core/model/errors.h"
#include "core/model/mass_properties.h"
#include "experiments/scene_file/read_shape.h"

namespace touchstone::scene_file {

namespace {

const Keys kBodyKeys = {"name",     "fixed",       "mass",     "inertia",
                        "position", "orientation", "velocity", "angular_velocity",
                        "force",    "shape"};

Inertia<2> inertia_of_numbers(const Value& value, Dimension<2>) { return Inertia<2>(value.number()); }

/// Principal values, or the matrix as xx, yy, zz, xy, xz, yz: its elements, so xy is minus the integral of
/// x y dm.
Inertia<3> inertia_of_numbers(const Value& value, Dimension<3>) {
  const std::vector<double> i = value.numbers();
  if (i.size() == 3) return Vector<3>(i[0], i[1], i[2]).asDiagonal();
  if (i.size() != 6) {
    value.fail_length(i.size(), "3 principal moments or the 6 elements xx, yy, zz, xy, xz, yz [kg m^2]");
  }
  Inertia<3> inertia;
  inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return inertia;
}

Angular<2> read_angular(const Value& value, Dimension<2>) { return Angular<2>(value.number()); }
Angular<3> read_angular(const Value& value, Dimension<3>) { return value.vector<3>(); }

/// A body's origin is its centre of mass, so a uniform solid must have its own there.
template <int Dim>
void require_centered(const Value& value, const Body<Dim>& body) {
  constexpr double kTolerance = 1e-9;  // of the radius of gyration, which is as large as the shape
  const MassProperties<Dim> properties = mass_properties(body.shape);
  if (properties.center.norm() <= kTolerance * std::sqrt(properties.inertia.trace())) return;
  const Vector<Dim> center = body.shape.placement.position - properties.center;
  value.fail(fmt::format("'uniform', of a solid with its centre of mass at [{}]",
                         fmt::join(properties.center.begin(), properties.center.end(), ", ")),
             fmt::format("a centre of mass at the body's origin, as with center = [{}] in the shape",
                         fmt::join(center.begin(), center.end(), ", ")));
}

template <int Dim>
Inertia<Dim> uniform_inertia_of(const Value& value, const Body<Dim>& body) {
  try {
    require_centered(value, body);
    return uniform_inertia(body.shape, body.mass);
  } catch (const Unsupported& reason) {
    value.fail("'uniform'", fmt::format("numbers [kg m^2] ({})", reason.what()));
  }
}

template <int Dim>
Inertia<Dim> read_inertia(const Value& value, const Body<Dim>& body) {
  if (!value.is_text()) return inertia_of_numbers(value, Dimension<Dim>{});
  if (value.text() != "uniform")
    value.fail(fmt::format("'{}'", value.text()), "numbers [kg m^2] or \"uniform\"");
  return uniform_inertia_of(value, body);
}

template <int Dim>
void read_motion(const Table& table, Body<Dim>& body) {
  if (const auto position = table.find("position")) body.pose.position = position->vector<Dim>();
  if (const auto turn = table.find("orientation")) body.pose.rotation = read_rotation<Dim>(*turn);
  if (const auto v = table.find("velocity")) body.velocity.template head<Dim>() = v->vector<Dim>();
  if (const auto w = table.find("angular_velocity")) {
    body.velocity.template tail<Dimension<Dim>::angular>() = read_angular(*w, Dimension<Dim>{});
  }
  if (const auto force = table.find("force")) body.force = force->vector<Dim>();
}

/// A fixed body may be given a mass, which nothing reads; a motion or a force that it would not follow is a
/// mistake.
template <int Dim>
void require_still(const Table& table, const Body<Dim>& body) {
  const auto require_zero = [&](const auto& vector, const char* key) {
    if (!vector.isZero(0)) table.find(key)->fail("a value on a fixed body", "0, or no such key");
  };
  require_zero(body.velocity.template head<Dim>(), "velocity");
  require_zero(body.velocity.template tail<Dimension<Dim>::angular>(), "angular_velocity");
  require_zero(body.force, "force");
}

/// Whatever the scene has to say against a body is asked of a scene of this body alone, under no name, so
/// that its words about the body are easy to tell from the name.
template <int Dim>
void check(const Value& value, Body<Dim> body) {
  Scene<Dim> alone;
  body.name.clear();
  alone.bodies = {std::move(body)};
  value.checked("body ''", [&] { alone.validate(); });
}

}  // namespace

template <int Dim>
Body<Dim> read_body(const Value& unnamed) {
  Body<Dim> body;
  body.name = unnamed.table(kBodyKeys, " ").require("name", "a text").text();
  const Value value = unnamed.named(fmt::format("body '{}'", body.name));
  const Table table = value.table(kBodyKeys, " ");
  body.shape = read_shape<Dim>(table.require("shape", "a table: { type = ..., ... }"));
  if (const auto fixed = table.find("fixed")) body.fixed = fixed->flag();
  read_motion(table, body);
  if (body.fixed) {
    require_still(table, body);
  } else {
    body.mass = table.require("mass", "a number > 0 [kg]").number();
    check(value, body);  // before the mass goes into a uniform inertia
    body.inertia = read_inertia(table.require("inertia", "numbers [kg m^2] or \"uniform\""), body);
  }
  check(value, body);
  return body;
}

template Body<2> read_body(const Value&);
template Body<3> read_body(const Value&);

}  // namespace touchstone::scene_file
