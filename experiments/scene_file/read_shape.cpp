#include "experiments/scene_file/read_shape.h"

#include <array>

#include "core/surfaces/convex_surface.h"

namespace touchstone::scene_file {

namespace {

template <int Dim>
using AnyGeometry = typename Geometry<Dim>::Variant;

/// How one type of shape is written. Disc and sphere, ellipse and ellipsoid are two words for one thing, and
/// both are understood in the plane and in space.
template <int Dim>
struct ShapeType {
  std::string_view name;
  Keys keys;  ///< besides those that every shape has
  AnyGeometry<Dim> (*read)(const Table& table);
};

double read_length(const Table& table, std::string_view key) {
  return table.require(key, "a number > 0 [m]").number();
}

template <int Dim>
Vector<Dim> read_lengths(const Table& table, std::string_view key) {
  return table.require(key, std::to_string(Dim) + " numbers > 0 [m]").template vector<Dim>();
}

template <int Dim>
AnyGeometry<Dim> read_sphere(const Table& table) {
  return Sphere<Dim>{read_length(table, "radius")};
}

template <int Dim>
AnyGeometry<Dim> read_ellipsoid(const Table& table) {
  return Ellipsoid<Dim>{read_lengths<Dim>(table, "semi_axes")};
}

template <int Dim>
AnyGeometry<Dim> read_superellipsoid(const Table& table) {
  const Value exponents = table.require("exponents", std::to_string(Dim) + " numbers >= 2");
  return Superellipsoid<Dim>{read_lengths<Dim>(table, "semi_axes"), exponents.vector<Dim>()};
}

template <int Dim>
HalfSpace<Dim> read_plane(const Table& table) {
  const Value normal = table.require("normal", "a unit vector, out of the solid");
  return {normal.unit_vector<Dim>(),
          table.require("offset", "a number [m]: normal.x <= offset is solid").number()};
}

template <int Dim>
AnyGeometry<Dim> read_half_space(const Table& table) {
  return read_plane<Dim>(table);
}

template <int Dim>
AnyGeometry<Dim> read_box(const Table& table) {
  return Box<Dim>{read_lengths<Dim>(table, "half_extents")};
}

/// The polytope's own messages are about its "shape"; whoever calls the reader knows where that is.
template <int Dim>
AnyGeometry<Dim> read_polytope(const Table& table) {
  const auto planes = table.find("planes");
  const auto vertices = table.find("vertices");
  if (planes.has_value() == vertices.has_value()) {
    table.fail(planes ? "both planes and vertices" : "neither planes nor vertices", "one of them");
  }
  if (vertices) {
    std::vector<Vector<Dim>> points;
    for (const Value& vertex : vertices->list()) points.push_back(vertex.vector<Dim>());
    return polytope_from_vertices<Dim>(points, "shape");
  }
  std::vector<Vector<Dim>> normals;
  std::vector<double> offsets;
  for (const Value& item : planes->list()) {
    const HalfSpace<Dim> plane = read_plane<Dim>(item.table({"normal", "offset"}));
    normals.push_back(plane.normal);
    offsets.push_back(plane.offset);
  }
  return polytope_from_planes<Dim>(normals, offsets, "shape");
}

template <int Dim>
AnyGeometry<Dim> read_intersection(const Table& table) {
  Intersection<Dim> intersection;
  for (const Value& part : table.require("parts", "a list of shapes").list()) {
    intersection.parts.push_back(read_shape<Dim>(part));
  }
  return intersection;
}

AnyGeometry<3> read_cylinder(const Table& table) {
  return Cylinder{read_length(table, "radius"), read_length(table, "half_height")};
}

AnyGeometry<3> read_cone(const Table& table) {
  return Cone{read_length(table, "radius"), read_length(table, "height")};
}

AnyGeometry<3> read_capsule(const Table& table) {
  return Capsule{read_length(table, "radius"), read_length(table, "half_height")};
}

AnyGeometry<2> read_regular_polygon(const Table& table) {
  return RegularPolygon{table.require("edges", "an integer >= 3").integer(),
                        read_length(table, "circumradius")};
}

/// Sorted by name.
template <int Dim>
std::vector<ShapeType<Dim>> shape_types() {
  std::vector<ShapeType<Dim>> types = {
      {"box", {"half_extents"}, &read_box<Dim>},
      {"disc", {"radius"}, &read_sphere<Dim>},
      {"ellipse", {"semi_axes"}, &read_ellipsoid<Dim>},
      {"ellipsoid", {"semi_axes"}, &read_ellipsoid<Dim>},
      {"half_space", {"normal", "offset"}, &read_half_space<Dim>},
      {"intersection", {"parts"}, &read_intersection<Dim>},
      {"polytope", {"planes", "vertices"}, &read_polytope<Dim>},
      {"sphere", {"radius"}, &read_sphere<Dim>},
      {"superellipse", {"semi_axes", "exponents"}, &read_superellipsoid<Dim>},
      {"superellipsoid", {"semi_axes", "exponents"}, &read_superellipsoid<Dim>},
  };
  if constexpr (Dim == 2) {
    types.push_back({"regular_polygon", {"edges", "circumradius"}, &read_regular_polygon});
  } else {
    types.push_back({"capsule", {"radius", "half_height"}, &read_capsule});
    types.push_back({"cone", {"radius", "height"}, &read_cone});
    types.push_back({"cylinder", {"radius", "half_height"}, &read_cylinder});
  }
  std::sort(types.begin(), types.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return types;
}

}  // namespace

template <>
PlanarRotation read_rotation<2>(const Value& value) {
  return PlanarRotation(value.number());
}
template <>
SpatialRotation read_rotation<3>(const Value& value) {
  const Eigen::Vector4d q = value.unit_vector<4>();
  return SpatialRotation(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
}

template <int Dim>
Shape<Dim> read_shape(const Value& value) {
  static const std::vector<ShapeType<Dim>> types = shape_types<Dim>();
  std::vector<std::string_view> names;
  for (const auto& type : types) names.push_back(type.name);
  const Value name = value.member("type", fmt::format("{}", fmt::join(names, ", ")));
  const ShapeType<Dim>& type = types[name.choice(names)];
  Keys keys = {"type", "center", "rotation"};
  keys.insert(keys.end(), type.keys.begin(), type.keys.end());
  const Table table = value.table(keys);
  return value.checked("shape", [&] {
    Shape<Dim> shape{type.read(table), {}};
    if (const auto center = table.find("center")) shape.placement.position = center->vector<Dim>();
    if (const auto rotation = table.find("rotation"))
      shape.placement.rotation = read_rotation<Dim>(*rotation);
    validate(shape, "shape");
    make_surface(shape, "shape");  // finds out whether an intersection has an inside
    return shape;
  });
}

template Shape<2> read_shape(const Value&);
template Shape<3> read_shape(const Value&);

}  // namespace touchstone::scene_file
