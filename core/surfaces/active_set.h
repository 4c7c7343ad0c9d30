#pragma once

#include <array>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// The inequalities of a body that hold as equations at a point, with their multipliers: one side of the
/// stationarity conditions Eqs. 20-22, N = sum_k l_k grad f_k(x), in the body frame.
///
/// Never more than Dim inequalities (Caratheodory), so that the workspace is fixed. Which they are is guessed
/// from the point and then mended from one Newton step to the next, as a primal-dual active-set method does.
template <int Dim>
class ActiveSet {
 public:
  using Gradients = Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim>;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1>;

  /// Starts with the nonnegative combination of gradients at `x` that comes closest to `normal`, of those
  /// inequalities that have f_i(x) >= -slack [m].
  ActiveSet(const ConvexSurface<Dim>& surface, const Vector<Dim>& x, const Vector<Dim>& normal, double slack);

  [[nodiscard]] int size() const { return static_cast<int>(multipliers_.size()); }
  /// Which inequality of the surface the k-th is.
  [[nodiscard]] int index(int k) const { return index_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const Vector<Dim>& x() const { return x_; }
  [[nodiscard]] const Values& multipliers() const { return multipliers_; }
  [[nodiscard]] const Values& values() const { return values_; }           ///< f_k(x) [m]
  [[nodiscard]] const Gradients& gradients() const { return gradients_; }  ///< grad f_k(x), a column each
  [[nodiscard]] const Vector<Dim>& normal() const { return normal_; }      ///< N
  [[nodiscard]] const Matrix<Dim>& hessian() const { return hessian_; }    ///< sum_k l_k Hess f_k(x) [1/m]

  /// Changes point and multipliers; what depends on them is out of date until update().
  void move(const Vector<Dim>& dx, const Values& dl) {
    x_ += dx;
    multipliers_ += dl;
  }
  /// Out with inequalities of negative multiplier, in with the most violated one if it is outside by more
  /// than `tolerance` [m]. @return true if the set changed
  bool exchange(double tolerance);
  void update();

 private:
  void remove(int k);
  void append(int i, double multiplier);

  const ConvexSurface<Dim>* surface_;
  Vector<Dim> x_;
  std::array<int, Dim> index_{};
  Values multipliers_{};
  Values values_{};
  Gradients gradients_{};
  Vector<Dim> normal_ = Vector<Dim>::Zero();
  Matrix<Dim> hessian_ = Matrix<Dim>::Zero();
};

}  // namespace touchstone
