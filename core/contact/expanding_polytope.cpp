#include "core/contact/expanding_polytope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// A vector normal to the facet with these corners, of any length and sign.
Vector<2> across(const std::array<Vector<2>, 2>& p) { return {p[1].y() - p[0].y(), p[0].x() - p[1].x()}; }
Vector<3> across(const std::array<Vector<3>, 3>& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }

/// A polytope with corners in C, as the list of its facets.
template <int Dim>
class InnerPolytope {
 public:
  struct Facet {
    std::array<int, Dim> corner;
    Vector<Dim> normal;  ///< unit, outward
    double offset;       ///< of its plane; < 0 if the origin is outside of it
  };

  /// @param corners  Dim + 1 points that span a solid
  explicit InnerPolytope(const std::array<Vector<Dim>, Dim + 1>& corners) {
    for (const auto& corner : corners) {
      centre_ += corner / (Dim + 1);
      points_[static_cast<std::size_t>(point_count_++)] = corner;
    }
    for (int left_out = 0; left_out <= Dim; ++left_out) {
      std::array<int, Dim> corner{};
      for (int k = 0; k < Dim; ++k) corner[static_cast<std::size_t>(k)] = k < left_out ? k : k + 1;
      add_facet(corner);
    }
  }

  [[nodiscard]] const Facet& nearest_facet() const {
    int nearest = 0;
    for (int i = 1; i < facet_count_; ++i) {
      if (facet(i).offset < facet(nearest).offset) nearest = i;
    }
    return facet(nearest);
  }

  /// Replaces the facets that `point` sees by those from it to their horizon. False, and unchanged, if there
  /// is no room or it sees none.
  bool grow(const Vector<Dim>& point, double tolerance) {
    const auto sees = [&](int i) { return facet(i).normal.dot(point) > facet(i).offset + tolerance; };
    int ridges = 0;
    std::array<Ridge, kFacets> horizon;
    int seen = 0;
    for (int i = 0; i < facet_count_; ++i) {
      if (!sees(i)) continue;
      ++seen;
      if (ridges + Dim > kFacets) return false;
      for (int left_out = 0; left_out < Dim; ++left_out) toggle(ridge(facet(i), left_out), horizon, ridges);
    }
    if (seen == 0 || facet_count_ - seen + ridges > kFacets || point_count_ == kPoints) return false;
    int kept = 0;
    for (int i = 0; i < facet_count_; ++i) {
      if (!sees(i)) facets_[static_cast<std::size_t>(kept++)] = facet(i);
    }
    facet_count_ = kept;
    points_[static_cast<std::size_t>(point_count_++)] = point;
    for (int i = 0; i < ridges; ++i) {
      std::array<int, Dim> corner{};
      std::copy(horizon[static_cast<std::size_t>(i)].begin(), horizon[static_cast<std::size_t>(i)].end(),
                corner.begin());
      corner[Dim - 1] = point_count_ - 1;
      add_facet(corner);
    }
    return true;
  }

 private:
  static constexpr int kPoints = 96;
  static constexpr int kFacets = 2 * kPoints;
  using Ridge = std::array<int, Dim - 1>;

  [[nodiscard]] const Facet& facet(int i) const { return facets_[static_cast<std::size_t>(i)]; }

  static Ridge ridge(const Facet& facet, int left_out) {
    Ridge corners{};
    std::size_t k = 0;
    for (int i = 0; i < Dim; ++i) {
      if (i != left_out) corners[k++] = facet.corner[static_cast<std::size_t>(i)];
    }
    if (Dim == 3 && corners.front() > corners.back()) std::swap(corners.front(), corners.back());
    return corners;
  }
  /// Takes a ridge in, or out if it is there: what two seen facets share is not on the horizon.
  static void toggle(const Ridge& ridge, std::array<Ridge, kFacets>& horizon, int& count) {
    for (int i = 0; i < count; ++i) {
      if (horizon[static_cast<std::size_t>(i)] != ridge) continue;
      horizon[static_cast<std::size_t>(i)] = horizon[static_cast<std::size_t>(--count)];
      return;
    }
    horizon[static_cast<std::size_t>(count++)] = ridge;
  }
  void add_facet(const std::array<int, Dim>& corner) {
    std::array<Vector<Dim>, Dim> at;
    for (std::size_t k = 0; k < Dim; ++k) at[k] = points_[static_cast<std::size_t>(corner[k])];
    Vector<Dim> normal = across(at);
    const double length = normal.norm();
    // A facet without area, of a corner on an edge's line, has no plane of its own: never the nearest.
    if (!(length > 0)) {
      facets_[static_cast<std::size_t>(facet_count_++)] = {corner, Vector<Dim>::Zero(),
                                                           std::numeric_limits<double>::infinity()};
      return;
    }
    normal /= length;
    if (normal.dot(at[0] - centre_) < 0) normal = -normal;
    facets_[static_cast<std::size_t>(facet_count_++)] = {corner, normal, normal.dot(at[0])};
  }

  std::array<Vector<Dim>, kPoints> points_;
  std::array<Facet, kFacets> facets_;
  int point_count_ = 0;
  int facet_count_ = 0;
  Vector<Dim> centre_ = Vector<Dim>::Zero();
};

/// A direction normal to the first `count` corners' hull.
template <int Dim>
Vector<Dim> normal_to(const std::array<Vector<Dim>, Dim + 1>& corners, int count) {
  if (count == Dim) {
    std::array<Vector<Dim>, Dim> p;
    for (std::size_t k = 0; k < Dim; ++k) p[k] = corners[k];
    return across(p).normalized();
  }
  if (count == 1) return Vector<Dim>::UnitX();
  const Vector<Dim> edge = corners[1] - corners[0];
  return edge.unitOrthogonal();
}

/// Dim + 1 points of C that span a solid: each the farther of the two supports normal to those before it.
template <int Dim>
std::array<Vector<Dim>, Dim + 1> spanning_simplex(const BodyPair<Dim>& bodies) {
  std::array<Vector<Dim>, Dim + 1> corners;
  corners[0] = bodies.support(-Vector<Dim>::UnitX()).w;
  for (int count = 1; count <= Dim; ++count) {
    const Vector<Dim> d = normal_to<Dim>(corners, count);
    const Vector<Dim> above = bodies.support(d).w;
    const Vector<Dim> below = bodies.support(-d).w;
    const double up = d.dot(above - corners[0]);
    const double down = d.dot(corners[0] - below);
    corners[static_cast<std::size_t>(count)] = up >= down ? above : below;
  }
  return corners;
}

}  // namespace

template <int Dim>
Vector<Dim> least_overlap_direction(const BodyPair<Dim>& bodies, double absolute, double relative) {
  constexpr double kRounding = 1e-14;
  InnerPolytope<Dim> polytope(spanning_simplex(bodies));
  Vector<Dim> best = Vector<Dim>::UnitX();
  double least_reach = std::numeric_limits<double>::infinity();
  while (true) {
    const auto facet = polytope.nearest_facet();
    const Vector<Dim> farthest = bodies.support(facet.normal).w;
    const double reach = facet.normal.dot(farthest);
    if (reach < least_reach) {
      least_reach = reach;
      best = -facet.normal;
    }
    if (reach - facet.offset <= std::max(absolute * bodies.size, relative * std::abs(reach))) return best;
    if (!polytope.grow(farthest, kRounding * bodies.size)) return best;
  }
}

template Vector<2> least_overlap_direction(const BodyPair<2>&, double, double);
template Vector<3> least_overlap_direction(const BodyPair<3>&, double, double);

}  // namespace touchstone
