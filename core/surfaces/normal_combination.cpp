#include "core/surfaces/normal_combination.h"

#include <Eigen/QR>
#include <algorithm>

/// Nonnegative least squares by the active-set method of Lawson and Hanson (Solving Least Squares Problems,
/// 1974, ch. 23). The passive columns are independent, so there are never more than Dim of them and the
/// workspace is fixed however many inequalities the body has.
namespace touchstone {

namespace {

template <int Dim>
class PassiveSet {
 public:
  PassiveSet(const ConvexSurface<Dim>& surface, const Vector<Dim>& x, const Vector<Dim>& normal)
      : surface_(surface), x_(x), normal_(normal) {
    found_.residual = normal;
  }

  [[nodiscard]] const NormalCombination<Dim>& found() const { return found_; }
  [[nodiscard]] bool full() const { return found_.size == Dim; }
  [[nodiscard]] bool holds(int i) const {
    const auto end = found_.index.begin() + found_.size;
    return std::find(found_.index.begin(), end, i) != end;
  }

  /// Takes inequality i in, and out what then becomes negative.
  void add(int i) {
    append(i);
    while (found_.size > 0) {
      const Weights best = columns().colPivHouseholderQr().solve(normal_);
      const int blocking = move_towards(best);
      if (blocking < 0) break;
      remove(blocking);
    }
    found_.residual = normal_;
    for (int k = 0; k < found_.size; ++k) found_.residual -= weight(k) * gradients_.col(k);
  }

 private:
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1>;
  using Columns = Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim>;

  double& weight(int k) { return found_.multiplier[static_cast<std::size_t>(k)]; }
  int& index(int k) { return found_.index[static_cast<std::size_t>(k)]; }
  [[nodiscard]] Columns columns() const { return gradients_.leftCols(found_.size); }

  /// Changes the weights to `best`, or as far towards it as none becomes negative.
  /// @return the weight that stops it, now 0; -1 if none does
  int move_towards(const Weights& best) {
    int blocking = -1;
    double step = 1.0;
    for (int k = 0; k < found_.size; ++k) {
      if (best[k] > 0) continue;
      const double allowed = weight(k) > 0 ? weight(k) / (weight(k) - best[k]) : 0.0;
      if (blocking >= 0 && allowed >= step) continue;
      blocking = k;
      step = allowed;
    }
    for (int k = 0; k < found_.size; ++k) weight(k) += step * (best[k] - weight(k));
    return blocking;
  }
  void append(int i) {
    gradients_.col(found_.size) = surface_.jet(i, x_).gradient;
    index(found_.size) = i;
    weight(found_.size) = 0.0;
    ++found_.size;
  }
  void remove(int k) {
    const int last = --found_.size;
    index(k) = index(last);
    weight(k) = weight(last);
    gradients_.col(k) = gradients_.col(last).eval();
  }

  const ConvexSurface<Dim>& surface_;
  const Vector<Dim>& x_;
  const Vector<Dim>& normal_;
  NormalCombination<Dim> found_;
  Matrix<Dim> gradients_ = Matrix<Dim>::Zero();
};

/// The active gradient that makes the sharpest angle with the residual; -1 if none reduces it.
template <int Dim>
int steepest(const ConvexSurface<Dim>& surface, const Vector<Dim>& x, double slack,
             const PassiveSet<Dim>& passive, double tolerance) {
  int best = -1;
  double steepest_slope = tolerance;
  for (int i = 0; i < surface.count(); ++i) {
    if (surface.value(i, x) < -slack || passive.holds(i)) continue;
    const Vector<Dim> gradient = surface.jet(i, x).gradient;
    const double slope = gradient.dot(passive.found().residual) / gradient.norm();
    if (slope > steepest_slope) {
      steepest_slope = slope;
      best = i;
    }
  }
  return best;
}

}  // namespace

template <int Dim>
NormalCombination<Dim> normal_combination(const ConvexSurface<Dim>& surface, const Vector<Dim>& x,
                                          const Vector<Dim>& normal, double slack) {
  constexpr int kMaximumExchanges = 100;
  constexpr double kRounding = 1e-14;
  PassiveSet<Dim> passive(surface, x, normal);
  for (int k = 0; k < kMaximumExchanges && !passive.full(); ++k) {
    const int i = steepest(surface, x, slack, passive, kRounding * normal.norm());
    if (i < 0) break;
    passive.add(i);
  }
  return passive.found();
}

template NormalCombination<2> normal_combination(const ConvexSurface<2>&, const Vector<2>&, const Vector<2>&,
                                                 double);
template NormalCombination<3> normal_combination(const ConvexSurface<3>&, const Vector<3>&, const Vector<3>&,
                                                 double);

}  // namespace touchstone
