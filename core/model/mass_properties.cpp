#include "core/model/mass_properties.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/model/errors.h"
#include "core/model/moments.h"
#include "core/surfaces/radial_moments.h"

namespace touchstone {

namespace {

/// Second moments E[x x^T] of unit mass about the centre to inertia: tr(C) 1 - C in space, tr(C) in the
/// plane.
Inertia<2> inertia_of_moments(const Matrix<2>& c) { return Inertia<2>(c.trace()); }
Inertia<3> inertia_of_moments(const Matrix<3>& c) { return c.trace() * Matrix<3>::Identity() - c; }

template <int Dim>
Moments<Dim> centered(double measure, const Vector<Dim>& second) {
  return {measure, Vector<Dim>::Zero(), second.asDiagonal()};
}

/// Dirichlet's integrals over sum |x_i/a_i|^p_i <= 1: the mean of x_i^2 is a_i^2 times a ratio of gamma
/// functions.
template <int Dim>
Moments<Dim> superellipsoid(const Vector<Dim>& a, const Vector<Dim>& p) {
  double sum = 0;
  double log_measure = 0;
  for (int i = 0; i < Dim; ++i) {
    sum += 1 / p[i];
    log_measure += std::log(2 * a[i]) + std::lgamma(1 + 1 / p[i]);
  }
  log_measure -= std::lgamma(1 + sum);
  Vector<Dim> second;
  for (int i = 0; i < Dim; ++i) {
    const double log_ratio = std::lgamma(3 / p[i]) - std::lgamma(1 / p[i]) + std::lgamma(1 + sum) -
                             std::lgamma(1 + sum + 2 / p[i]);
    second[i] = a[i] * a[i] * std::exp(log_ratio);
  }
  return centered<Dim>(std::exp(log_measure), second);
}

/// Sums simplices, each given by its corners, about a common point of origin.
template <int Dim>
class SimplexSum {
 public:
  void add(const std::array<Vector<Dim>, Dim + 1>& corner) {
    Matrix<Dim> edges;
    Vector<Dim> sum = corner[0];
    for (int i = 0; i < Dim; ++i) {
      edges.col(i) = corner[static_cast<std::size_t>(i + 1)] - corner[0];
      sum += corner[static_cast<std::size_t>(i + 1)];
    }
    const double measure = std::abs(edges.determinant()) / (Dim == 2 ? 2 : 6);
    Matrix<Dim> products = sum * sum.transpose();
    for (const auto& c : corner) products += c * c.transpose();
    measure_ += measure;
    first_ += measure * sum / (Dim + 1);
    second_ += measure * products / ((Dim + 1) * (Dim + 2));
  }
  [[nodiscard]] Moments<Dim> moments() const {
    const Vector<Dim> center = first_ / measure_;
    return {measure_, center, second_ / measure_ - center * center.transpose()};
  }

 private:
  double measure_ = 0.0;
  Vector<Dim> first_ = Vector<Dim>::Zero();
  Matrix<Dim> second_ = Matrix<Dim>::Zero();
};

/// Corners of face `f`, in order around it.
std::vector<Vector<2>> face_corners(const Polytope<2>& p, std::size_t f, double tolerance) {
  std::vector<Vector<2>> corners;
  for (const auto& v : p.vertices) {
    if (p.normals[f].dot(v) >= p.offsets[f] - tolerance) corners.push_back(v);
  }
  return corners;
}
std::vector<Vector<3>> face_corners(const Polytope<3>& p, std::size_t f, double tolerance) {
  std::vector<Vector<3>> corners;
  Vector<3> middle = Vector<3>::Zero();
  for (const auto& v : p.vertices) {
    if (p.normals[f].dot(v) >= p.offsets[f] - tolerance) corners.push_back(v);
  }
  for (const auto& v : corners) middle += v / static_cast<double>(corners.size());
  const Vector<3> x = p.normals[f].unitOrthogonal();
  const Vector<3> y = p.normals[f].cross(x);
  const auto angle = [&](const Vector<3>& v) { return std::atan2(y.dot(v - middle), x.dot(v - middle)); };
  std::sort(corners.begin(), corners.end(),
            [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
  return corners;
}

void add_face(const std::vector<Vector<2>>& corners, const Vector<2>& apex, SimplexSum<2>& sum) {
  if (corners.size() == 2) sum.add({apex, corners[0], corners[1]});
}
void add_face(const std::vector<Vector<3>>& corners, const Vector<3>& apex, SimplexSum<3>& sum) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum.add({apex, corners[0], corners[i], corners[i + 1]});
}

template <int Dim>
Moments<Dim> polytope(const Polytope<Dim>& p) {
  Vector<Dim> apex = Vector<Dim>::Zero();
  double size = 0;
  for (const auto& v : p.vertices) {
    apex += v / static_cast<double>(p.vertices.size());
    size = std::max(size, v.norm());
  }
  SimplexSum<Dim> sum;
  for (std::size_t f = 0; f < p.normals.size(); ++f) add_face(face_corners(p, f, 1e-9 * size), apex, sum);
  return sum.moments();
}

/// A cylinder with two half balls.
Moments<3> capsule(const Capsule& c) {
  const double r = c.radius;
  const double h = c.half_height;
  const double pi = std::numbers::pi;
  const double tube = 2 * pi * r * r * h;
  const double balls = 4.0 / 3 * pi * r * r * r;
  const double across = tube * r * r / 4 + balls * r * r / 5;
  // A half ball's mean height is 3r/8, so E[z^2] = h^2 + 2 h 3r/8 + r^2/5.
  const double along = tube * h * h / 3 + balls * (h * h + 0.75 * h * r + r * r / 5);
  const double volume = tube + balls;
  return centered<3>(volume, Vector<3>(across, across, along) / volume);
}

template <int Dim>
struct MomentsOf {
  const Shape<Dim>& shape;

  Moments<Dim> operator()(const Sphere<Dim>& s) const {
    return superellipsoid<Dim>(Vector<Dim>::Constant(s.radius), Vector<Dim>::Constant(2));
  }
  Moments<Dim> operator()(const Ellipsoid<Dim>& s) const {
    return superellipsoid<Dim>(s.semi_axes, Vector<Dim>::Constant(2));
  }
  Moments<Dim> operator()(const Superellipsoid<Dim>& s) const {
    return superellipsoid<Dim>(s.semi_axes, s.exponents);
  }
  Moments<Dim> operator()(const Box<Dim>& s) const {
    return centered<Dim>((2 * s.half_extents).prod(), s.half_extents.array().square() / 3);
  }
  Moments<Dim> operator()(const Polytope<Dim>& s) const { return polytope(s); }
  Moments<2> operator()(const RegularPolygon& s) const { return polytope(as_polytope(s)); }
  Moments<3> operator()(const Cylinder& s) const {
    const double r2 = s.radius * s.radius;
    return centered<3>(2 * std::numbers::pi * r2 * s.half_height,
                       Vector<3>(r2 / 4, r2 / 4, s.half_height * s.half_height / 3));
  }
  Moments<3> operator()(const Cone& s) const {
    const double r2 = s.radius * s.radius;
    const double h2 = s.height * s.height;
    return {std::numbers::pi * r2 * s.height / 3, Vector<3>(0, 0, s.height / 4),
            Vector<3>(3 * r2 / 20, 3 * r2 / 20, 3 * h2 / 80).asDiagonal()};
  }
  Moments<3> operator()(const Capsule& s) const { return capsule(s); }
  Moments<Dim> operator()(const Intersection<Dim>& s) const {
    constexpr double kTolerance = 1e-10;
    Shape<Dim> unplaced;
    unplaced.geometry = s;
    return radial_moments(*make_surface(unplaced), kTolerance);
  }
  template <typename Other>
  Moments<Dim> operator()(const Other&) const {
    throw Unsupported(fmt::format("mass properties of a {}: give the inertia as numbers", shape_name(shape)));
  }
};

}  // namespace

template <int Dim>
MassProperties<Dim> mass_properties(const Shape<Dim>& shape) {
  const Moments<Dim> own = std::visit(MomentsOf<Dim>{shape}, shape.geometry);
  const Matrix<Dim> rotation = shape.placement.rotation.matrix();
  return {own.measure, shape.placement.to_world(own.center),
          inertia_of_moments(Matrix<Dim>(rotation * own.second * rotation.transpose()))};
}

template MassProperties<2> mass_properties(const Shape<2>&);
template MassProperties<3> mass_properties(const Shape<3>&);

}  // namespace touchstone
