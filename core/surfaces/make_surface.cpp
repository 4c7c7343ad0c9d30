#include <algorithm>

#include "core/surfaces/box.h"
#include "core/surfaces/capsule.h"
#include "core/surfaces/cone.h"
#include "core/surfaces/cylinder.h"
#include "core/surfaces/ellipsoid.h"
#include "core/surfaces/half_space.h"
#include "core/surfaces/intersection.h"
#include "core/surfaces/placed.h"
#include "core/surfaces/polytope.h"
#include "core/surfaces/sphere.h"
#include "core/surfaces/superellipsoid.h"

namespace touchstone {

namespace {

template <int Dim>
using SurfacePointer = std::shared_ptr<const ConvexSurface<Dim>>;

template <int Dim>
Pose<Dim> compose(const Pose<Dim>& outer, const Pose<Dim>& inner) {
  return {outer.to_world(inner.position), outer.rotation * inner.rotation};
}

template <int Dim>
bool is_identity(const Pose<Dim>& placement) {
  return placement.position.isZero(0) && placement.rotation.matrix().isIdentity(0);
}

/// Appends the parts of `intersection`, of intersections among them theirs, each with its whole placement.
template <int Dim>
void flatten(const Intersection<Dim>& intersection, const Pose<Dim>& outer, std::vector<Shape<Dim>>& leaves) {
  for (const Shape<Dim>& part : intersection.parts) {
    const Pose<Dim> placement = compose(outer, part.placement);
    if (const auto* inner = std::get_if<Intersection<Dim>>(&part.geometry)) {
      flatten(*inner, placement, leaves);
    } else {
      leaves.push_back({part.geometry, placement});
    }
  }
}

/// True if every inequality of `shape` is a plane.
template <int Dim>
bool is_planar(const Shape<Dim>& shape) {
  const auto is = [&]<typename Geometry>() { return std::holds_alternative<Geometry>(shape.geometry); };
  bool planar = is.template operator()<HalfSpace<Dim>>() || is.template operator()<Box<Dim>>() ||
                is.template operator()<Polytope<Dim>>();
  if constexpr (Dim == 2) planar = planar || is.template operator()<RegularPolygon>();
  return planar;
}

/// Planes alone bound a polytope, whose supports are vertices.
template <int Dim>
SurfacePointer<Dim> make_planar_intersection(const std::vector<SurfacePointer<Dim>>& parts,
                                             const std::string& field) {
  std::vector<Vector<Dim>> normals;
  std::vector<double> offsets;
  for (const auto& part : parts) {
    for (int i = 0; i < part->count(); ++i) {
      const SurfaceJet<Dim> plane = part->jet(i, Vector<Dim>::Zero());
      normals.push_back(plane.gradient);
      offsets.push_back(-plane.value);
    }
  }
  return std::make_shared<PolytopeSurface<Dim>>(polytope_from_planes(normals, offsets, field));
}

template <int Dim>
SurfacePointer<Dim> make_intersection(const Intersection<Dim>& intersection, const std::string& field) {
  std::vector<Shape<Dim>> leaves;
  flatten(intersection, Pose<Dim>{}, leaves);
  std::vector<SurfacePointer<Dim>> parts;
  for (const Shape<Dim>& leaf : leaves) parts.push_back(make_surface(leaf, field));
  if (parts.size() == 1) return parts.front();
  if (std::all_of(leaves.begin(), leaves.end(), is_planar<Dim>))
    return make_planar_intersection(parts, field);
  return std::make_shared<IntersectionSurface<Dim>>(std::move(parts), field);
}

template <int Dim>
struct Maker {
  const std::string& field;

  SurfacePointer<Dim> operator()(const Sphere<Dim>& s) const {
    return std::make_shared<SphereSurface<Dim>>(s);
  }
  SurfacePointer<Dim> operator()(const Ellipsoid<Dim>& s) const {
    return std::make_shared<EllipsoidSurface<Dim>>(s);
  }
  SurfacePointer<Dim> operator()(const HalfSpace<Dim>& s) const {
    return std::make_shared<HalfSpaceSurface<Dim>>(s);
  }
  SurfacePointer<Dim> operator()(const Superellipsoid<Dim>& s) const {
    return std::make_shared<SuperellipsoidSurface<Dim>>(s);
  }
  SurfacePointer<Dim> operator()(const Box<Dim>& s) const { return std::make_shared<BoxSurface<Dim>>(s); }
  SurfacePointer<Dim> operator()(const Polytope<Dim>& s) const {
    return std::make_shared<PolytopeSurface<Dim>>(s);
  }
  SurfacePointer<3> operator()(const Cylinder& s) const { return std::make_shared<CylinderSurface>(s); }
  SurfacePointer<3> operator()(const Cone& s) const { return std::make_shared<ConeSurface>(s); }
  SurfacePointer<3> operator()(const Capsule& s) const { return std::make_shared<CapsuleSurface>(s); }
  SurfacePointer<2> operator()(const RegularPolygon& s) const {
    const ConvexSurface<2>::BoundingBall circumcircle{Vector<2>::Zero(), s.circumradius};
    return std::make_shared<PolytopeSurface<2>>(as_polytope(s), circumcircle);
  }
  SurfacePointer<Dim> operator()(const Intersection<Dim>& s) const { return make_intersection(s, field); }
};

}  // namespace

template <int Dim>
std::shared_ptr<const ConvexSurface<Dim>> make_surface(const Shape<Dim>& shape, const std::string& field) {
  SurfacePointer<Dim> surface = std::visit(Maker<Dim>{field}, shape.geometry);
  if (is_identity(shape.placement)) return surface;
  return std::make_shared<PlacedSurface<Dim>>(std::move(surface), shape.placement);
}

template std::shared_ptr<const ConvexSurface<2>> make_surface(const Shape<2>&, const std::string&);
template std::shared_ptr<const ConvexSurface<3>> make_surface(const Shape<3>&, const std::string&);

}  // namespace touchstone
