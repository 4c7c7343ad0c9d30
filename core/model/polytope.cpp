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

/// A normal of the plane through Dim points, as long as the facet that they span is large [m or m^2].
Vector<2> facet_normal(const std::array<Vector<2>, 2>& p) {
  const Vector<2> edge = p[1] - p[0];
  return {edge.y(), -edge.x()};
}
Vector<3> facet_normal(const std::array<Vector<3>, 3>& p) {
  const Vector<3> a = p[1] - p[0];
  const Vector<3> b = p[2] - p[0];
  const Vector<3> normal = a.cross(b);
  const bool collinear = normal.norm() <= kSame * a.norm() * b.norm();
  return collinear ? Vector<3>(Vector<3>::Zero()) : normal;
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

/// Appends `point` unless one of `points` is within `tolerance` of it. Copies would make facets of rounding
/// errors.
template <int Dim>
void add_distinct(const Vector<Dim>& point, double tolerance, std::vector<Vector<Dim>>& points) {
  const bool known = std::any_of(points.begin(), points.end(),
                                 [&](const auto& p) { return (p - point).norm() <= tolerance; });
  if (!known) points.push_back(point);
}

/// The hull's faces; each from the largest of the facets that span it, whose normal is the most exact.
template <int Dim>
class Faces {
 public:
  explicit Faces(double tolerance) : tolerance_(tolerance) {}

  void add(const Vector<Dim>& normal, double offset, double facet_size) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if ((normals[i] - normal).norm() >= kSame || std::abs(offsets[i] - offset) > tolerance_) continue;
      if (facet_size > sizes_[i]) {
        normals[i] = normal;
        offsets[i] = offset;
        sizes_[i] = facet_size;
      }
      return;
    }
    normals.push_back(normal);
    offsets.push_back(offset);
    sizes_.push_back(facet_size);
  }

  std::vector<Vector<Dim>> normals;
  std::vector<double> offsets;

 private:
  double tolerance_;
  std::vector<double> sizes_;
};

template <int Dim>
Faces<Dim> hull_faces(const std::vector<Vector<Dim>>& points, double tolerance) {
  Faces<Dim> faces(tolerance);
  for_each_subset<Dim>(static_cast<int>(points.size()), [&](const std::array<int, Dim>& index) {
    std::array<Vector<Dim>, Dim> corner;
    for (std::size_t i = 0; i < Dim; ++i) corner[i] = points[static_cast<std::size_t>(index[i])];
    const Vector<Dim> spanned = facet_normal(corner);
    if (spanned.isZero(0)) return;
    const Vector<Dim> normal = spanned.normalized();
    double highest = 0;
    double lowest = 0;
    for (const auto& p : points) {
      const double height = normal.dot(p - corner[0]);
      highest = std::max(highest, height);
      lowest = std::min(lowest, height);
    }
    const double offset = normal.dot(corner[0]);
    if (highest <= tolerance && lowest < -tolerance) faces.add(normal, offset, spanned.norm());
    if (lowest >= -tolerance && highest > tolerance) faces.add(-normal, -offset, spanned.norm());
  });
  return faces;
}

/// The points where Dim of the planes meet and that no plane cuts off.
template <int Dim>
std::vector<Vector<Dim>> corners_of(const std::vector<Vector<Dim>>& normals,
                                    const std::vector<double>& offsets, double tolerance) {
  std::vector<Vector<Dim>> corners;
  for_each_subset<Dim>(static_cast<int>(normals.size()), [&](const std::array<int, Dim>& index) {
    Matrix<Dim> a;
    Vector<Dim> b;
    for (int i = 0; i < Dim; ++i) {
      const auto plane = static_cast<std::size_t>(index[static_cast<std::size_t>(i)]);
      a.row(i) = normals[plane].transpose();
      b[i] = offsets[plane];
    }
    if (std::abs(a.determinant()) < kSame) return;
    const Vector<Dim> corner = a.inverse() * b;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (normals[i].dot(corner) > offsets[i] + tolerance) return;
    }
    add_distinct(corner, tolerance, corners);
  });
  return corners;
}

/// The hull of distinct points; with no more than Dim faces if they are flat.
template <int Dim>
Polytope<Dim> hull_of(const std::vector<Vector<Dim>>& points, double tolerance) {
  const Faces<Dim> faces = hull_faces(points, tolerance);
  Polytope<Dim> hull{faces.normals, faces.offsets, {}};
  for (const auto& p : points) {
    int touching = 0;
    for (std::size_t i = 0; i < hull.normals.size(); ++i) {
      if (hull.normals[i].dot(p) >= hull.offsets[i] - tolerance) ++touching;
    }
    if (touching >= Dim) hull.vertices.push_back(p);
  }
  return hull;
}

/// Replaces each face by the plane of the input that it lies in: exact, where the hull's is computed. False
/// if a face lies in none: a bounded set is its corners' hull, an unbounded one has a face more.
template <int Dim>
bool adopt_planes(const std::vector<Vector<Dim>>& normals, const std::vector<double>& offsets, double size,
                  Polytope<Dim>& hull) {
  constexpr double kSameFace = 1e3 * kSame;  // the hull's faces are differences of computed corners
  for (std::size_t face = 0; face < hull.normals.size(); ++face) {
    const auto distance = [&](std::size_t i) {
      return (normals[i] - hull.normals[face]).norm() + std::abs(offsets[i] - hull.offsets[face]) / size;
    };
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < normals.size(); ++i) {
      if (distance(i) < distance(nearest)) nearest = i;
    }
    if (distance(nearest) >= kSameFace) return false;
    hull.normals[face] = normals[nearest];
    hull.offsets[face] = offsets[nearest];
  }
  return true;
}

}  // namespace

template <int Dim>
Polytope<Dim> polytope_from_vertices(const std::vector<Vector<Dim>>& points, const std::string& field) {
  if (points.size() <= Dim) {
    throw InputError(field + ".vertices", std::to_string(points.size()),
                     fmt::format("at least {} points", Dim + 1));
  }
  for (const auto& p : points) {
    if (!p.allFinite()) {
      throw InputError(field + ".vertices", "a point that is not finite", "finite numbers [m]");
    }
  }
  const double tolerance = kSame * extent(points);
  std::vector<Vector<Dim>> distinct;
  for (const auto& p : points) add_distinct(p, tolerance, distinct);
  Polytope<Dim> hull = hull_of(distinct, tolerance);
  if (hull.normals.size() <= Dim) {
    throw InputError(field + ".vertices", "a flat set of points", "a solid hull");
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
  const std::vector<Vector<Dim>> corners = corners_of(normals, offsets, kSame * size);
  Polytope<Dim> hull;
  if (corners.size() > Dim) hull = hull_of(corners, kSame * extent(corners));
  if (hull.normals.size() <= Dim) {
    throw InputError(field + ".planes", "an empty, flat or unbounded set",
                     "a bounded polytope with an inside");
  }
  if (!adopt_planes(normals, offsets, size, hull)) {
    throw InputError(field + ".planes", "an unbounded set", "a bounded polytope");
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
