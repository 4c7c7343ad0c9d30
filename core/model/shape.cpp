#include "core/model/shape.h"

#include <cmath>
#include <numbers>

#include "core/model/errors.h"

namespace touchstone {

namespace {

void require_positive(double value, const std::string& field) {
  if (!(value > 0) || !std::isfinite(value)) throw InputError(field, value, "a finite number > 0 [m]");
}

template <int Dim>
struct Name {
  std::string operator()(const Sphere<Dim>&) const { return Dim == 2 ? "disc" : "sphere"; }
  std::string operator()(const Ellipsoid<Dim>&) const { return Dim == 2 ? "ellipse" : "ellipsoid"; }
  std::string operator()(const HalfSpace<Dim>&) const { return "half_space"; }
  std::string operator()(const Superellipsoid<Dim>&) const {
    return Dim == 2 ? "superellipse" : "superellipsoid";
  }
  std::string operator()(const Box<Dim>&) const { return "box"; }
  std::string operator()(const Polytope<Dim>&) const { return "polytope"; }
  std::string operator()(const Cylinder&) const { return "cylinder"; }
  std::string operator()(const Cone&) const { return "cone"; }
  std::string operator()(const Capsule&) const { return "capsule"; }
  std::string operator()(const RegularPolygon&) const { return "regular_polygon"; }
  std::string operator()(const Intersection<Dim>&) const { return "intersection"; }
};

template <int Dim>
class Check {
 public:
  explicit Check(const std::string& name) : field(name) {}

  void operator()(const Sphere<Dim>& s) const { require_positive(s.radius, field + ".radius"); }
  void operator()(const Ellipsoid<Dim>& s) const { lengths(s.semi_axes, "semi_axes"); }
  void operator()(const Superellipsoid<Dim>& s) const {
    lengths(s.semi_axes, "semi_axes");
    for (int i = 0; i < Dim; ++i) {
      if (!(s.exponents[i] >= 2) || !std::isfinite(s.exponents[i])) {
        throw InputError(fmt::format("{}.exponents[{}]", field, i), s.exponents[i], "a finite number >= 2");
      }
    }
  }
  void operator()(const Box<Dim>& s) const { lengths(s.half_extents, "half_extents"); }
  void operator()(const Polytope<Dim>& s) const {
    if (s.normals.size() <= Dim || s.vertices.size() <= Dim) {
      throw InputError(field, "too few planes or vertices", "a bounded polytope with an inside");
    }
  }
  void operator()(const Cylinder& s) const { solid_of_revolution(s.radius, s.half_height, "half_height"); }
  void operator()(const Cone& s) const { solid_of_revolution(s.radius, s.height, "height"); }
  void operator()(const Capsule& s) const { solid_of_revolution(s.radius, s.half_height, "half_height"); }
  void operator()(const Intersection<Dim>& s) const {
    if (s.parts.empty()) throw InputError(field + ".parts", "none", "at least one shape");
    for (std::size_t i = 0; i < s.parts.size(); ++i)
      validate(s.parts[i], fmt::format("{}.parts[{}]", field, i));
  }
  void operator()(const HalfSpace<Dim>& s) const {
    constexpr double kUnitTolerance = 1e-9;
    if (!(std::abs(s.normal.norm() - 1) <= kUnitTolerance)) {
      throw InputError(field + ".normal (its length)", s.normal.norm(), "a unit vector, within 1e-9");
    }
    if (!std::isfinite(s.offset)) throw InputError(field + ".offset", s.offset, "a finite number [m]");
  }
  void operator()(const RegularPolygon& s) const {
    if (s.edges < 3) throw InputError(field + ".edges", std::to_string(s.edges), "an integer >= 3");
    require_positive(s.circumradius, field + ".circumradius");
  }

 private:
  const std::string& field;

  void lengths(const Vector<Dim>& values, const char* name) const {
    for (int i = 0; i < Dim; ++i) require_positive(values[i], fmt::format("{}.{}[{}]", field, name, i));
  }
  void solid_of_revolution(double radius, double height, const char* height_name) const {
    require_positive(radius, field + ".radius");
    require_positive(height, fmt::format("{}.{}", field, height_name));
  }
};

}  // namespace

Vector<2> RegularPolygon::vertex(int k) const {
  const double angle = 2 * std::numbers::pi * k / edges;
  return circumradius * Vector<2>(std::sin(angle), -std::cos(angle));
}

template <int Dim>
std::string shape_name(const Shape<Dim>& shape) {
  return std::visit(Name<Dim>{}, shape.geometry);
}

template <int Dim>
void validate(const Shape<Dim>& shape, const std::string& field) {
  if (!shape.placement.is_finite()) throw InputError(field + " placement", "not finite", "finite numbers");
  const Check<Dim> check{field};
  std::visit(check, shape.geometry);
}

template std::string shape_name<2>(const Shape<2>&);
template std::string shape_name<3>(const Shape<3>&);
template void validate<2>(const Shape<2>&, const std::string&);
template void validate<3>(const Shape<3>&, const std::string&);

}  // namespace touchstone
