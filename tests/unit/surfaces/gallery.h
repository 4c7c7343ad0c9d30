#pragma once

#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "core/surfaces/convex_surface.h"

/// One shape of every kind, with random points and poses to try them at, for the tests that hold for all of
/// them.
namespace touchstone::testing {

template <int Dim>
struct Exhibit {
  std::string name;
  Shape<Dim> shape;
};

template <int Dim>
std::ostream& operator<<(std::ostream& out, const Exhibit<Dim>& exhibit) {
  return out << exhibit.name;
}

/// Every bounded shape: each geometry, extreme proportions, placed, and intersections (nested, thin, planar).
template <int Dim>
std::vector<Exhibit<Dim>> gallery();

/// What two balls of radius 1 have in common whose centres are 2 c apart on the last axis.
template <int Dim>
Intersection<Dim> lens(double c);

using Random = std::mt19937_64;

template <int Dim>
Vector<Dim> random_direction(Random& random) {
  std::normal_distribution<double> normal;
  Vector<Dim> v;
  for (int i = 0; i < Dim; ++i) v[i] = normal(random);
  return v.normalized();
}

/// Uniform in the cube |x_i - center_i| <= reach.
template <int Dim>
Vector<Dim> random_point(Random& random, const Vector<Dim>& center, double reach) {
  std::uniform_real_distribution<double> uniform(-reach, reach);
  Vector<Dim> x = center;
  for (int i = 0; i < Dim; ++i) x[i] += uniform(random);
  return x;
}

template <int Dim>
Rotation<Dim> random_rotation(Random& random) {
  if constexpr (Dim == 2) {
    std::uniform_real_distribution<double> angle(-3, 3);
    return PlanarRotation(angle(random));
  } else {
    std::normal_distribution<double> normal;
    const double w = normal(random);
    const double x = normal(random);
    const double y = normal(random);
    return SpatialRotation(Eigen::Quaterniond(w, x, y, normal(random)));
  }
}

}  // namespace touchstone::testing
