#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/model/errors.h"
#include "core/model/shape.h"

/// Planes <-> vertices by trying every Dim-subset: O(n^(Dim+1)), done once when a scene is loaded, exact
/// about what is degenerate, and nothing to go wrong for the tens of faces that a rigid convex part has.
namespace touchstone {

namespace {

/// Two planes, or two points, closer than this times the size are one.
constexpr double kSame = 1e-9;

/// Calls use(indices) for every Dim-subset of {0 .. count-1}.
template <int Dim, typename Use>
void for_each_subset(int count, const Use& use) {
  std::array<int, Dim> index{};
  for (int i = 0; i < Dim; ++i) index[static_cast<std::size_t>(i)] = i;
  if (count < Dim) return;
  while (true) {
    use(index);
    int place = Dim - 1;
    while (place >= 0 && index[static_cast<std::size_t>(place)] == count - Dim + place) --place;
    if (place < 0) return;
    ++index[static_cast<std::size_t>(place)];
    for (int i = place + 1; i < Dim; ++i) {
      index[static_cast<std::size_t>(i)] = index[static_cast<std::size_t>(i - 1)] + 1;
    }
  }
}

/// A unit normal of the plane through Dim points; zero if they do not span one.
Vector<2> plane_normal(const std::array<Vector<2>, 2>& p) {
  const Vector<2> edge = p[1] - p[0];
  return edge.norm() > 0 ? Vector<2>(Vector<2>(edge.y(), -edge.x()).normalized())
                         : Vector<2>(Vector<2>::Zero());
}
Vector<3> plane_normal(const std::array<Vector<3>, 3>& p) {
  const Vector<3> a = p[1] - p[0];
  const Vector<3> b = p[2] - p[0];
  const Vector<3> normal = a.cross(b);
  return normal.norm() > kSame * a.norm() * b.norm() ? Vector<3>(normal.normalized())
                                                     : Vector<3>(Vector<3>::Zero());
}

template <int Dim>
double extent(const std::vector<Vector<Dim>>& points) {
  Vector<Dim> low = points.front();
  Vector<Dim> high = points.front();
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace

template <int Dim>
Polytope<Dim> polytope_from_vertices(const std::vector<Vector<Dim>>& points, const std::string& field) {
  if (points.size() <= Dim) {
    throw InputError(field + ".vertices", std::to_string(points.size()),
                     fmt::format("at least {} points", Dim + 1));
  }
  for (const auto& p : points) {
    if (!p.allFinite())
      throw InputError(field + ".vertices", "a point that is not finite", "finite numbers [m]");
  }
  const double tolerance = kSame * extent(points);
  Polytope<Dim> hull;
  const auto add_face = [&](const Vector<Dim>& normal, double offset) {
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
      if ((hull.normals[i] - normal).norm() < kSame && std::abs(hull.offsets[i] - offset) <= tolerance)
        return;
    }
    hull.normals.push_back(normal);
    hull.offsets.push_back(offset);
  };
  for_each_subset<Dim>(static_cast<int>(points.size()), [&](const std::array<int, Dim>& index) {
    std::array<Vector<Dim>, Dim> corner;
    for (std::size_t i = 0; i < Dim; ++i) corner[i] = points[static_cast<std::size_t>(index[i])];
    const Vector<Dim> normal = plane_normal(corner);
    if (normal.isZero()) return;
    double highest = 0;
    double lowest = 0;
    for (const auto& p : points) {
      highest = std::max(highest, normal.dot(p - corner[0]));
      lowest = std::min(lowest, normal.dot(p - corner[0]));
    }
    if (highest <= tolerance && lowest < -tolerance) add_face(normal, normal.dot(corner[0]));
    if (lowest >= -tolerance && highest > tolerance) add_face(-normal, -normal.dot(corner[0]));
  });
  if (hull.normals.size() <= Dim)
    throw InputError(field + ".vertices", "a flat set of points", "a solid hull");
  for (const auto& p : points) {
    int faces = 0;
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
      if (hull.normals[i].dot(p) >= hull.offsets[i] - tolerance) ++faces;
    }
    const bool known = std::any_of(hull.vertices.begin(), hull.vertices.end(),
                                   [&](const auto& v) { return (v - p).norm() <= tolerance; });
    if (faces >= Dim && !known) hull.vertices.push_back(p);
  }
  return hull;
}

template <int Dim>
Polytope<Dim> polytope_from_planes(const std::vector<Vector<Dim>>& normals,
                                   const std::vector<double>& offsets, const std::string& field) {
  if (normals.size() != offsets.size() || normals.size() <= Dim) {
    throw InputError(field + ".planes", std::to_string(normals.size()),
                     fmt::format("at least {} planes", Dim + 1));
  }
  double size = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (!(std::abs(normals[i].norm() - 1) <= kSame) || !std::isfinite(offsets[i])) {
      throw InputError(fmt::format("{}.planes[{}]", field, i),
                       "a normal that is not a unit vector, or no finite offset",
                       "unit normals and finite offsets [m]");
    }
    size = std::max(size, std::abs(offsets[i]));
  }
  std::vector<Vector<Dim>> corners;
  for_each_subset<Dim>(static_cast<int>(normals.size()), [&](const std::array<int, Dim>& index) {
    Matrix<Dim> a;
    Vector<Dim> b;
    for (int i = 0; i < Dim; ++i) {
      a.row(i) = normals[static_cast<std::size_t>(index[static_cast<std::size_t>(i)])].transpose();
      b[i] = offsets[static_cast<std::size_t>(index[static_cast<std::size_t>(i)])];
    }
    if (std::abs(a.determinant()) < kSame) return;
    const Vector<Dim> corner = a.inverse() * b;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (normals[i].dot(corner) > offsets[i] + kSame * size) return;
    }
    corners.push_back(corner);
  });
  if (corners.size() <= Dim) {
    throw InputError(field + ".planes", "an empty, flat or unbounded set",
                     "a bounded polytope with an inside");
  }
  Polytope<Dim> hull = polytope_from_vertices(corners, field);
  // A bounded set is its corners' hull; an unbounded one has a hull face that is none of the given planes.
  for (const auto& normal : hull.normals) {
    const bool given = std::any_of(normals.begin(), normals.end(),
                                   [&](const auto& n) { return (n - normal).norm() < 1e3 * kSame; });
    if (!given) throw InputError(field + ".planes", "an unbounded set", "a bounded polytope");
  }
  return hull;
}

Polytope<2> as_polytope(const RegularPolygon& polygon) {
  Polytope<2> p;
  const double half = std::numbers::pi / polygon.edges;
  for (int k = 0; k < polygon.edges; ++k) {
    const double angle = (2 * k + 1) * half;
    p.normals.emplace_back(std::sin(angle), -std::cos(angle));
    p.offsets.push_back(polygon.circumradius * std::cos(half));
    p.vertices.push_back(polygon.vertex(k));
  }
  return p;
}

template Polytope<2> polytope_from_planes(const std::vector<Vector<2>>&, const std::vector<double>&,
                                          const std::string&);
template Polytope<3> polytope_from_planes(const std::vector<Vector<3>>&, const std::vector<double>&,
                                          const std::string&);
template Polytope<2> polytope_from_vertices(const std::vector<Vector<2>>&, const std::string&);
template Polytope<3> polytope_from_vertices(const std::vector<Vector<3>>&, const std::string&);

}  // namespace touchstone
