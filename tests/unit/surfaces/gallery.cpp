#include "tests/unit/surfaces/gallery.h"

namespace touchstone::testing {

namespace {

Pose<2> placed(double x, double y, double angle) { return {Vector<2>(x, y), PlanarRotation(angle)}; }
Pose<3> placed(const Vector<3>& position, const Vector<3>& turn) {
  return {position, SpatialRotation(exp_rotation(turn))};
}

Polytope<3> octahedron() {
  return polytope_from_vertices<3>({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                                   "octahedron");
}

template <int Dim>
Polytope<Dim> random_hull(int points) {
  Random random(7);
  std::vector<Vector<Dim>> vertices;
  for (int i = 0; i < points; ++i) vertices.push_back(random_direction<Dim>(random));
  return polytope_from_vertices(vertices, "random_hull");
}

template <int Dim, typename Geometry>
Shape<Dim> shape(Geometry geometry, const Pose<Dim>& placement = Pose<Dim>()) {
  Shape<Dim> made;
  made.geometry = std::move(geometry);
  made.placement = placement;
  return made;
}

/// A capsule's end cut by two planes inside an outer intersection with a box: nested, and turned at each
/// level.
Intersection<3> nested() {
  Intersection<3> inner;
  inner.parts.push_back(shape<3>(Capsule{0.8, 0.5}));
  inner.parts.push_back(shape<3>(HalfSpace<3>{Vector<3>(1, 0, 1).normalized(), 0.6}));
  inner.parts.push_back(shape<3>(HalfSpace<3>{Vector<3>(0, -1, 0), 0.5}, placed({0, 0.1, 0}, {0.2, 0, 0})));
  Intersection<3> outer;
  outer.parts.push_back(shape<3>(inner, placed({0.1, 0, 0.2}, {0, 0.3, 0.4})));
  outer.parts.push_back(shape<3>(Box<3>{Vector<3>(0.6, 0.7, 0.8)}, placed({0, 0, 0.1}, {0.5, 0, 0})));
  outer.parts.push_back(shape<3>(Superellipsoid<3>{Vector<3>(0.9, 0.9, 0.9), Vector<3>(4, 3, 2)}));
  return outer;
}

template <int Dim>
Intersection<Dim> ball_cut(const Vector<Dim>& normal) {
  Intersection<Dim> cut;
  cut.parts.push_back(shape<Dim>(Sphere<Dim>{1.0}));
  cut.parts.push_back(shape<Dim>(HalfSpace<Dim>{normal, 0.2}));
  return cut;
}

Intersection<2> planar(const RegularPolygon& polygon) {
  Intersection<2> both;
  both.parts.push_back(shape<2>(Box<2>{Vector<2>(1, 1)}));
  both.parts.push_back(shape<2>(polygon, placed(0.2, 0, 0.3)));
  return both;
}

Intersection<3> planar(const Polytope<3>& polytope) {
  Intersection<3> both;
  both.parts.push_back(shape<3>(Box<3>{Vector<3>(1, 1, 0.8)}));
  both.parts.push_back(shape<3>(polytope, placed({0.2, 0.1, 0}, {0.3, 0, 0})));
  return both;
}

}  // namespace

template <int Dim>
Intersection<Dim> lens(double c) {
  Intersection<Dim> both;
  for (const double side : {c, -c}) {
    Pose<Dim> placement;
    placement.position[Dim - 1] = side;
    both.parts.push_back(shape<Dim>(Sphere<Dim>{1.0}, placement));
  }
  return both;
}
template Intersection<2> lens(double);
template Intersection<3> lens(double);

template <>
std::vector<Exhibit<2>> gallery() {
  std::vector<Exhibit<2>> all;
  const auto show = [&](const char* name, auto geometry, const Pose<2>& placement = Pose<2>()) {
    all.push_back({name, shape<2>(std::move(geometry), placement)});
  };
  show("disc", Sphere<2>{0.7});
  show("ellipse", Ellipsoid<2>{Vector<2>(1.5, 0.4)});
  show("superellipse", Superellipsoid<2>{Vector<2>(1.0, 0.6), Vector<2>(4, 4)});
  show("superellipse_mixed", Superellipsoid<2>{Vector<2>(1.0, 0.6), Vector<2>(2, 7.5)});
  show("box", Box<2>{Vector<2>(1.0, 0.3)});
  show("polytope", random_hull<2>(9));
  show("regular_polygon", RegularPolygon{5, 0.9});
  show("regular_polygon_fine", RegularPolygon{200, 1.0});
  show("lens", lens<2>(0.6));
  show("lens_thin", lens<2>(0.999));
  show("disc_cut", ball_cut<2>({0.6, 0.8}));
  show("planar_intersection", planar(RegularPolygon{5, 1.1}));
  show("ellipse_placed", Ellipsoid<2>{Vector<2>(0.5, 1.0)}, placed(0.3, -0.2, 0.7));
  return all;
}

template <>
std::vector<Exhibit<3>> gallery() {
  std::vector<Exhibit<3>> all;
  const auto show = [&](const char* name, auto geometry, const Pose<3>& placement = Pose<3>()) {
    all.push_back({name, shape<3>(std::move(geometry), placement)});
  };
  show("sphere", Sphere<3>{0.7});
  show("ellipsoid", Ellipsoid<3>{Vector<3>(1.5, 0.4, 0.8)});
  show("superellipsoid", Superellipsoid<3>{Vector<3>(1.0, 0.6, 0.8), Vector<3>(4, 4, 4)});
  show("superellipsoid_mixed", Superellipsoid<3>{Vector<3>(1.0, 0.6, 0.8), Vector<3>(2, 3, 6.5)});
  show("superellipsoid_boxy", Superellipsoid<3>{Vector<3>(1.0, 0.7, 0.5), Vector<3>(20, 20, 20)});
  show("box", Box<3>{Vector<3>(1.0, 0.3, 0.5)});
  show("octahedron", octahedron());
  show("polytope", random_hull<3>(14));
  show("cylinder", Cylinder{0.6, 0.9});
  show("cylinder_flat", Cylinder{1.0, 0.05});
  show("cone", Cone{0.8, 1.2});
  show("cone_flat", Cone{1.0, 0.2});
  show("capsule", Capsule{0.4, 0.7});
  show("lens", lens<3>(0.6));
  show("lens_thin", lens<3>(0.999));
  show("nested_intersection", nested());
  show("ball_cut", ball_cut<3>({0.6, 0, 0.8}));
  show("planar_intersection", planar(octahedron()));
  show("cylinder_placed", Cylinder{0.5, 0.4}, placed({0.3, -0.2, 0.1}, {0.7, 0.2, -0.4}));
  show("cone_placed", Cone{0.5, 0.7}, placed({0, 0, -0.2}, {0.1, -0.9, 0.4}));
  return all;
}

}  // namespace touchstone::testing
