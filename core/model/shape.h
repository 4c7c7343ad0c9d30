#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/model/pose.h"

/// Shapes as pure data, in the body frame, metres. What they mean as inequalities f_i(x) <= 0 is
/// core/surfaces' business; an engine's adapter reads the same data.
namespace touchstone {

/// |x| <= radius: a disc in the plane, a ball in space.
template <int Dim>
struct Sphere {
  double radius = 1.0;
};

/// sum (x_i / semi_axes_i)^2 <= 1.
template <int Dim>
struct Ellipsoid {
  Vector<Dim> semi_axes = Vector<Dim>::Ones();
};

/// normal . x <= offset is solid; `normal` is a unit vector pointing out of the solid.
template <int Dim>
struct HalfSpace {
  Vector<Dim> normal = Vector<Dim>::Unit(Dim - 1);
  double offset = 0.0;
};

/// sum |x_i / semi_axes_i|^exponents_i <= 1, exponents >= 2 so that the surface has a Hessian everywhere.
template <int Dim>
struct Superellipsoid {
  Vector<Dim> semi_axes = Vector<Dim>::Ones();
  Vector<Dim> exponents = Vector<Dim>::Constant(2.0);
};

/// |x_i| <= half_extents_i.
template <int Dim>
struct Box {
  Vector<Dim> half_extents = Vector<Dim>::Ones();
};

/// The bounded convex set normals_i . x <= offsets_i, and its corners. Build it with polytope_from_planes or
/// polytope_from_vertices, which make the two descriptions agree.
template <int Dim>
struct Polytope {
  std::vector<Vector<Dim>> normals;  ///< unit, outward
  std::vector<double> offsets;
  std::vector<Vector<Dim>> vertices;
};

/// x^2 + y^2 <= radius^2, |z| <= half_height.
struct Cylinder {
  double radius = 1.0;
  double half_height = 1.0;
};

/// Apex at (0, 0, height), base disc of `radius` in z = 0.
struct Cone {
  double radius = 1.0;
  double height = 1.0;
};

/// All points within `radius` of the segment from (0, 0, -half_height) to (0, 0, half_height).
struct Capsule {
  double radius = 1.0;
  double half_height = 1.0;
};

/// A regular polygon centred at the origin with one vertex straight down (at -y) at angle 0.
struct RegularPolygon {
  int edges = 3;
  double circumradius = 1.0;

  /// Vertex `k` in [0, edges), body frame, counter-clockwise from the lowest.
  [[nodiscard]] Vector<2> vertex(int k) const;
};

template <int Dim>
struct Shape;

/// What lies in every one of `parts`: the paper's "intersection of convex inequalities" (its appendix).
template <int Dim>
struct Intersection {
  std::vector<Shape<Dim>> parts;
};

template <int Dim>
struct Geometry;
template <>
struct Geometry<2> {
  using Variant = std::variant<Sphere<2>, Ellipsoid<2>, Superellipsoid<2>, HalfSpace<2>, Box<2>, Polytope<2>,
                               RegularPolygon, Intersection<2>>;
};
template <>
struct Geometry<3> {
  using Variant = std::variant<Sphere<3>, Ellipsoid<3>, Superellipsoid<3>, HalfSpace<3>, Box<3>, Polytope<3>,
                               Cylinder, Cone, Capsule, Intersection<3>>;
};

/// A geometry and where its own frame stands in the body frame (whose origin is the centre of mass).
template <int Dim>
struct Shape {
  typename Geometry<Dim>::Variant geometry;
  Pose<Dim> placement{};
};

/// The polytope normals_i . x <= offsets_i. Planes that touch it nowhere or in less than a face are dropped.
/// @throws InputError naming `field` if it is empty, unbounded, flat, or a normal is not a unit vector
template <int Dim>
Polytope<Dim> polytope_from_planes(const std::vector<Vector<Dim>>& normals,
                                   const std::vector<double>& offsets, const std::string& field);

/// The convex hull of `points`; those inside it are dropped. @throws InputError if it is flat or a point is
/// not finite
template <int Dim>
Polytope<Dim> polytope_from_vertices(const std::vector<Vector<Dim>>& points, const std::string& field);

/// The polygon as a polytope, edges and vertices in counter-clockwise order from the lowest vertex.
Polytope<2> as_polytope(const RegularPolygon& polygon);

/// The name that a scene file uses: "disc", "ellipsoid", "half_space", ...
template <int Dim>
std::string shape_name(const Shape<Dim>& shape);

/// @throws InputError naming `field` if a length is not positive and finite, a normal not of unit length, and
/// so on.
template <int Dim>
void validate(const Shape<Dim>& shape, const std::string& field);

}  // namespace touchstone
