#include "core/model/mass_properties.h"

#include <gtest/gtest.h>

#include <random>

#include "core/model/errors.h"
#include "core/surfaces/convex_surface.h"

namespace touchstone {
namespace {

/// By counting random points of a box around the shape: an oracle that knows nothing but the inequalities.
template <int Dim>
MassProperties<Dim> by_counting(const Shape<Dim>& shape) {
  const auto surface = make_surface(shape);
  const auto ball = surface->bounding_ball();
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-ball.radius, ball.radius);
  constexpr int kSamples = 400000;
  Vector<Dim> first = Vector<Dim>::Zero();
  Matrix<Dim> second = Matrix<Dim>::Zero();
  int inside = 0;
  for (int k = 0; k < kSamples; ++k) {
    Vector<Dim> x = ball.center;
    for (int i = 0; i < Dim; ++i) x[i] += uniform(random);
    bool in = true;
    for (int i = 0; i < surface->count() && in; ++i) in = surface->value(i, x) <= 0;
    if (!in) continue;
    ++inside;
    first += x;
    second += x * x.transpose();
  }
  const Vector<Dim> center = first / inside;
  const Matrix<Dim> c = second / inside - center * center.transpose();
  Inertia<Dim> inertia;
  if constexpr (Dim == 2) {
    inertia << c.trace();
  } else {
    inertia = c.trace() * Matrix<3>::Identity() - c;
  }
  return {std::pow(2 * ball.radius, Dim) * inside / kSamples, center, inertia};
}

template <int Dim>
void expect_as_counted(const Shape<Dim>& shape) {
  const auto exact = mass_properties(shape);
  const auto counted = by_counting(shape);
  EXPECT_NEAR(exact.measure, counted.measure, 0.01 * exact.measure) << shape_name(shape);
  EXPECT_LT((exact.center - counted.center).norm(), 0.01) << shape_name(shape);
  EXPECT_LT((exact.inertia - counted.inertia).norm(), 0.01 * exact.inertia.norm()) << shape_name(shape);
}

TEST(MassProperties, AreThoseThatCountingPointsGives) {
  const Pose<2> turned = {{0.1, -0.2}, PlanarRotation(0.4)};
  expect_as_counted<2>({Sphere<2>{0.7}, turned});
  expect_as_counted<2>({Ellipsoid<2>{{0.7, 0.4}}, turned});
  expect_as_counted<2>({Box<2>{{0.7, 0.4}}, turned});
  expect_as_counted<2>({RegularPolygon{5, 0.8}, turned});
  const Pose<3> placed = {{0.1, -0.2, 0.3}, SpatialRotation(Eigen::Quaterniond(0.8, 0.1, -0.4, 0.3))};
  expect_as_counted<3>({Sphere<3>{0.7}, placed});
  expect_as_counted<3>({Ellipsoid<3>{{0.7, 0.4, 0.5}}, placed});
  expect_as_counted<3>({Superellipsoid<3>{{0.7, 0.4, 0.5}, {4, 2, 3}}, placed});
  expect_as_counted<3>({Box<3>{{0.7, 0.4, 0.5}}, placed});
  expect_as_counted<3>({Cylinder{0.5, 0.4}, placed});
  expect_as_counted<3>({Cone{0.5, 0.9}, placed});
  expect_as_counted<3>({Capsule{0.3, 0.5}, placed});
  const std::vector<Vector<3>> corners = {{0, 0, 0}, {1, 0, 0}, {0, 0.8, 0}, {0, 0, 0.6}, {0.7, 0.6, 0.5}};
  expect_as_counted<3>({polytope_from_vertices<3>(corners, "test"), placed});
}

TEST(MassProperties, OfAHalfSpaceAreRefused) {
  EXPECT_THROW((void)mass_properties<3>({HalfSpace<3>{}}), Unsupported);
}

}  // namespace
}  // namespace touchstone
