#include "baselines/engines/shapes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/model/errors.h"

namespace touchstone::engines {

namespace {

std::vector<Vector<2>> corners(const Geometry<2>::Variant& geometry) {
  if (const auto* box = std::get_if<Box<2>>(&geometry)) {
    const Vector<2> h = box->half_extents;
    return {{-h.x(), -h.y()}, {h.x(), -h.y()}, {h.x(), h.y()}, {-h.x(), h.y()}};
  }
  if (const auto* polytope = std::get_if<Polytope<2>>(&geometry)) return polytope->vertices;
  std::vector<Vector<2>> vertices;
  if (const auto* polygon = std::get_if<RegularPolygon>(&geometry)) {
    for (int k = 0; k < polygon->edges; ++k) vertices.push_back(polygon->vertex(k));
  }
  return vertices;
}

void sort_counter_clockwise(std::vector<Vector<2>>& vertices) {
  Vector<2> middle = Vector<2>::Zero();
  for (const auto& v : vertices) middle += v / static_cast<double>(vertices.size());
  std::sort(vertices.begin(), vertices.end(), [&](const Vector<2>& a, const Vector<2>& b) {
    return std::atan2(a.y() - middle.y(), a.x() - middle.x()) <
           std::atan2(b.y() - middle.y(), b.x() - middle.x());
  });
}

constexpr double kOnPlane = 1e-9;  ///< relative to the size

std::vector<int> corners_on(const Polytope<3>& polytope, std::size_t plane, double size) {
  std::vector<int> on;
  for (std::size_t k = 0; k < polytope.vertices.size(); ++k) {
    const double distance = polytope.normals[plane].dot(polytope.vertices[k]) - polytope.offsets[plane];
    if (std::abs(distance) <= kOnPlane * size) on.push_back(static_cast<int>(k));
  }
  return on;
}

double size_of(const Polytope<3>& polytope) {
  double size = 0;
  for (const auto& v : polytope.vertices) size = std::max(size, v.norm());
  return size;
}

Polytope<3> inflated(const Polytope<3>& polytope, double distance) {
  Polytope<3> larger = polytope;
  for (auto& offset : larger.offsets) offset += distance;
  const double size = size_of(polytope);
  for (std::size_t k = 0; k < polytope.vertices.size(); ++k) {
    Matrix<3> sum = Matrix<3>::Zero();
    Vector<3> right = Vector<3>::Zero();
    for (std::size_t i = 0; i < polytope.normals.size(); ++i) {
      const Vector<3>& n = polytope.normals[i];
      if (n.dot(polytope.vertices[k]) < polytope.offsets[i] - kOnPlane * size) continue;
      sum += n * n.transpose();
      right += distance * n;
    }
    larger.vertices[k] += sum.ldlt().solve(right);  // least squares of n_i . shift = distance
  }
  return larger;
}

struct Inflate {
  double distance;
  using Solid = Geometry<3>::Variant;

  Solid operator()(const Sphere<3>& s) const { return Sphere<3>{s.radius + distance}; }
  Solid operator()(const HalfSpace<3>& s) const { return HalfSpace<3>{s.normal, s.offset + distance}; }
  Solid operator()(const Ellipsoid<3>& s) const { return Ellipsoid<3>{s.semi_axes.array() + distance}; }
  Solid operator()(const Box<3>& s) const { return Box<3>{s.half_extents.array() + distance}; }
  Solid operator()(const Cylinder& s) const {
    return Cylinder{s.radius + distance, s.half_height + distance};
  }
  Solid operator()(const Capsule& s) const { return Capsule{s.radius + distance, s.half_height}; }
  Solid operator()(const Polytope<3>& s) const { return inflated(s, distance); }
  template <typename Other>
  Solid operator()(const Other& s) const {
    return s;
  }
};

}  // namespace

std::vector<Vector<3>> convex_corners(const Geometry<3>::Variant& geometry) {
  if (const auto* polytope = std::get_if<Polytope<3>>(&geometry)) return polytope->vertices;
  std::vector<Vector<3>> corners;
  if (const auto* box = std::get_if<Box<3>>(&geometry)) {
    const Vector<3> h = box->half_extents;
    for (int k = 0; k < 8; ++k) {
      corners.emplace_back((k & 1) ? h.x() : -h.x(), (k & 2) ? h.y() : -h.y(), (k & 4) ? h.z() : -h.z());
    }
  }
  return corners;
}

void keep_one_of_each_in_plane(std::vector<Vector<3>>& points) {
  std::vector<Vector<3>> flat;
  for (auto point : points) {
    point.z() = 0;
    if (std::find(flat.begin(), flat.end(), point) == flat.end()) flat.push_back(point);
  }
  points = std::move(flat);
}

std::vector<std::vector<int>> face_corners(const Polytope<3>& polytope) {
  std::vector<std::vector<int>> faces;
  const double size = size_of(polytope);
  for (std::size_t i = 0; i < polytope.normals.size(); ++i) {
    std::vector<int> face = corners_on(polytope, i, size);
    const auto corner = [&](int k) { return polytope.vertices[static_cast<std::size_t>(k)]; };
    Vector<3> middle = Vector<3>::Zero();
    for (const int k : face) middle += corner(k) / static_cast<double>(face.size());
    const Vector<3> x = (corner(face.front()) - middle).normalized();
    const Vector<3> y = polytope.normals[i].cross(x);
    const auto angle = [&](int k) {
      const Vector<3> r = corner(k) - middle;
      return std::atan2(r.dot(y), r.dot(x));
    };
    std::sort(face.begin(), face.end(), [&](int a, int b) { return angle(a) < angle(b); });
    faces.push_back(std::move(face));
  }
  return faces;
}

Geometry<3>::Variant inflated(const Geometry<3>::Variant& geometry, double distance) {
  return std::visit(Inflate{distance}, geometry);
}

std::vector<Vector<2>> polygon_vertices(const Shape<2>& shape) {
  std::vector<Vector<2>> vertices = corners(shape.geometry);
  for (auto& v : vertices) v = shape.placement.to_world(v);
  sort_counter_clockwise(vertices);
  return vertices;
}

template <int Dim>
void refuse_shape(const std::string& engine, const Body<Dim>& body, const std::string& why) {
  throw Unsupported(
      fmt::format("{}: body '{}' of shape {}: {}", engine, body.name, shape_name(body.shape), why));
}
template void refuse_shape(const std::string&, const Body<2>&, const std::string&);
template void refuse_shape(const std::string&, const Body<3>&, const std::string&);

template <int Dim>
void refuse_moving_half_spaces(const std::string& engine, const Scene<Dim>& scene) {
  for (const auto& body : scene.bodies) {
    const bool half_space = std::holds_alternative<HalfSpace<Dim>>(body.shape.geometry);
    if (half_space && !body.fixed) refuse_shape(engine, body, "a half-space must be fixed");
  }
}
template void refuse_moving_half_spaces(const std::string&, const Scene<2>&);
template void refuse_moving_half_spaces(const std::string&, const Scene<3>&);

}  // namespace touchstone::engines
