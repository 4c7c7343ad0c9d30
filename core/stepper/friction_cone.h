#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

/// The second-order cone { x : |(x_1 ... x_{N-1})| <= x_0 } and its Jordan algebra, as interior-point methods
/// use them (Alizadeh & Goldfarb, Second-order cone programming, Math. Program. 95, 2003). It is its own
/// dual.
namespace touchstone {

template <int N>
struct FrictionCone {
  using Element = Eigen::Matrix<double, N, 1>;

  /// Product of the two eigenvalues x_0 +- |tail|: > 0 inside the cone.
  static double determinant(const Element& x) {
    const double tail = x.template tail<N - 1>().norm();
    return (x[0] - tail) * (x[0] + tail);
  }
  /// x o z = (x . z, x_0 tail(z) + z_0 tail(x)).
  static Element product(const Element& x, const Element& z) {
    Element result;
    result[0] = x.dot(z);
    result.template tail<N - 1>() = x[0] * z.template tail<N - 1>() + z[0] * x.template tail<N - 1>();
    return result;
  }
  /// The z with x o z = b; x inside the cone.
  static Element quotient(const Element& x, const Element& b) {
    Element z;
    z[0] = (x[0] * b[0] - x.template tail<N - 1>().dot(b.template tail<N - 1>())) / determinant(x);
    z.template tail<N - 1>() = (b.template tail<N - 1>() - z[0] * x.template tail<N - 1>()) / x[0];
    return z;
  }
  /// J x: the tail turned round.
  static Element reflected(const Element& x) {
    Element result = -x;
    result[0] = x[0];
    return result;
  }
  /// The t at which x + t dx leaves the cone, infinity if it never does; x inside.
  static double longest_step(const Element& x, const Element& dx) {
    const double a = determinant(dx);
    const double b = x[0] * dx[0] - x.template tail<N - 1>().dot(dx.template tail<N - 1>());
    const double c = determinant(x);
    double step = dx[0] < 0 ? -x[0] / dx[0] : std::numeric_limits<double>::infinity();
    // First positive root of a t^2 + 2 b t + c = 0, in the form that does not cancel.
    const double discriminant = b * b - a * c;
    if (discriminant < 0) return step;
    for (const double root : {c / (-b + std::sqrt(discriminant)), c / (-b - std::sqrt(discriminant))}) {
      if (root > 0) step = std::min(step, root);
    }
    return step;
  }
};

/// The scaling W of Nesterov and Todd (Primal-dual interior-point methods for self-scaled cones, SIAM J.
/// Optim. 8, 1998) of x and z inside the cone: the symmetric automorphism with W z = W^-1 x. In closed form W
/// = beta (2 v v^T - J), and W^2 = beta^2 (2 s s^T - J) with the scaling point s.
template <int N>
class ConeScaling {
 public:
  using Cone = FrictionCone<N>;
  using Element = typename Cone::Element;
  using Tail = Eigen::Matrix<double, N - 1, 1>;

  ConeScaling() = default;
  ConeScaling(const Element& x, const Element& z) {
    const double size_x = std::sqrt(Cone::determinant(x));
    const double size_z = std::sqrt(Cone::determinant(z));
    const Element unit_x = x / size_x;
    const Element unit_z = z / size_z;
    const double gamma = std::sqrt((1 + unit_x.dot(unit_z)) / 2);
    point_ = (unit_x + Cone::reflected(unit_z)) / (2 * gamma);
    axis_ = point_;
    axis_[0] += 1;
    axis_ /= std::sqrt(2 * axis_[0]);
    beta_squared_ = size_x / size_z;
    beta_ = std::sqrt(beta_squared_);
  }

  [[nodiscard]] Element apply(const Element& z) const {
    return beta_ * (2 * axis_.dot(z) * axis_ - Cone::reflected(z));
  }
  [[nodiscard]] Element apply_inverse(const Element& x) const {
    const Element mirror = Cone::reflected(axis_);
    return (2 * mirror.dot(x) * mirror - Cone::reflected(x)) / beta_;
  }

  // W^2 = [a, b^T; b, B] by its blocks.

  [[nodiscard]] double head() const { return beta_squared_ * (2 * point_[0] * point_[0] - 1); }
  [[nodiscard]] Tail side() const { return 2 * beta_squared_ * point_[0] * point_.template tail<N - 1>(); }
  /// B - b b^T / a.
  [[nodiscard]] Eigen::Matrix<double, N - 1, N - 1> schur_complement() const {
    const Tail tail = point_.template tail<N - 1>();
    return beta_squared_ * (Eigen::Matrix<double, N - 1, N - 1>::Identity() -
                            2 / (2 * point_[0] * point_[0] - 1) * tail * tail.transpose());
  }

 private:
  double beta_ = 1.0;
  double beta_squared_ = 1.0;
  Element point_ = Element::Unit(0);
  Element axis_ = Element::Unit(0);
};

}  // namespace touchstone
