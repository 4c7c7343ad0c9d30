#include "core/contact/gjk.h"

#include <Eigen/QR>
#include <array>
#include <limits>

namespace touchstone {

namespace {

template <int Dim>
class Simplex {
 public:
  static constexpr unsigned kCapacity = Dim + 1;

  explicit Simplex(const Difference<Dim>& first) {
    vertices_[0] = first;
    weights_[0] = 1.0;
    v_ = first.w;
  }

  [[nodiscard]] const Vector<Dim>& v() const { return v_; }
  /// True if the origin is inside: no face is nearer to it.
  [[nodiscard]] bool encloses_origin() const { return size_ == kCapacity; }
  [[nodiscard]] bool has(const Vector<Dim>& w) const {
    for (unsigned k = 0; k < size_; ++k) {
      if (vertices_[k].w == w) return true;
    }
    return false;
  }

  /// Goes on to the point closest to the origin of the hull with `vertex`, and to the fewest vertices that
  /// hold it. False, and unchanged, if that is no closer.
  bool move_towards(const Difference<Dim>& vertex) {
    Face best;
    best.squared_distance = v_.squaredNorm();
    // The new nearest point lies on a face with the new vertex. Faces are few: all are tried (the backup
    // procedure of the paper), which needs no sign of a near-singular determinant to be right.
    vertices_[size_] = vertex;
    for (unsigned others = 0; others < (1U << size_); ++others) {
      const Face face = project(others | (1U << size_));
      if (face.squared_distance < best.squared_distance) best = face;
    }
    if (best.members == 0) return false;
    keep(best);
    return true;
  }

  [[nodiscard]] Distance<Dim> nearest() const {
    Distance<Dim> distance;
    for (unsigned k = 0; k < size_; ++k) {
      distance.a_1 += weights_[k] * vertices_[k].a_1;
      distance.a_2 += weights_[k] * vertices_[k].a_2;
    }
    distance.v = distance.a_1 - distance.a_2;
    return distance;
  }

 private:
  struct Face {
    unsigned members = 0;  ///< bit set of vertices
    std::array<double, kCapacity> weights{};
    Vector<Dim> v = Vector<Dim>::Zero();
    double squared_distance = std::numeric_limits<double>::infinity();
  };

  /// The point closest to the origin of the affine hull of `members`; at infinity if it is not in their
  /// convex hull.
  [[nodiscard]] Face project(unsigned members) const {
    using Edges = Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim>;
    Face face;
    std::array<unsigned, kCapacity> index{};
    unsigned count = 0;
    for (unsigned k = 0; k < kCapacity; ++k) {
      if ((members >> k & 1U) != 0) index[count++] = k;
    }
    const Vector<Dim>& base = vertices_[index[count - 1]].w;
    Edges edges(Dim, count - 1);
    for (unsigned k = 0; k + 1 < count; ++k) edges.col(k) = vertices_[index[k]].w - base;
    face.v = base;
    double last = 1.0;
    if (count > 1) {
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1> weights =
          edges.colPivHouseholderQr().solve(-base);
      if (!(weights.minCoeff() > 0)) return face;
      for (unsigned k = 0; k + 1 < count; ++k) face.weights[index[k]] = weights[k];
      face.v += edges * weights;
      last -= weights.sum();
      if (!(last > 0)) return face;
    }
    face.weights[index[count - 1]] = last;
    face.members = members;
    face.squared_distance = count == kCapacity ? 0.0 : face.v.squaredNorm();
    return face;
  }

  void keep(const Face& face) {
    unsigned kept = 0;
    for (unsigned k = 0; k < kCapacity; ++k) {
      if ((face.members >> k & 1U) == 0) continue;
      vertices_[kept] = vertices_[k];
      weights_[kept] = face.weights[k];
      ++kept;
    }
    size_ = kept;
    v_ = face.v;
  }

  std::array<Difference<Dim>, kCapacity> vertices_{};
  std::array<double, kCapacity> weights_{};
  unsigned size_ = 1;
  Vector<Dim> v_;
};

}  // namespace

template <int Dim>
Distance<Dim> gjk(const BodyPair<Dim>& bodies, const GjkOptions& options) {
  constexpr int kMaximumSteps = 200;
  constexpr double kRounding = 1e-15;
  Simplex<Dim> simplex(bodies.support(bodies.body_2.to_world(Vector<Dim>::Zero()) -
                                      bodies.body_1.to_world(Vector<Dim>::Zero())));
  double lower = -std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMaximumSteps; ++step) {
    const double length = simplex.v().norm();
    if (simplex.encloses_origin() || length <= kRounding * bodies.size) break;
    const Difference<Dim> next = bodies.support(-simplex.v());
    lower = simplex.v().dot(next.w) / length;
    const double gap = length - lower;
    if (gap <= options.absolute * bodies.size && gap <= options.relative * length) break;
    if (simplex.has(next.w) || !simplex.move_towards(next)) break;
    lower = -std::numeric_limits<double>::infinity();
  }
  Distance<Dim> distance = simplex.nearest();
  distance.lower = lower;
  return distance;
}

template Distance<2> gjk(const BodyPair<2>&, const GjkOptions&);
template Distance<3> gjk(const BodyPair<3>&, const GjkOptions&);

}  // namespace touchstone
