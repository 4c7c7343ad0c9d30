#include "core/surfaces/farthest_point.h"

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <optional>

#include "core/surfaces/active_set.h"
#include "core/surfaces/deepest_point.h"

/// max d.x over f_i(x) <= 0 by the barrier method (Boyd and Vandenberghe, Convex Optimization, ch. 11), which
/// stays inside and cannot fail, and Newton's method on the KKT system of the inequalities that it finds
/// active, which is exact. The result of the second is taken only if it proves to be the maximum: with
/// d = sum l_i grad f_i(x), l_i >= 0, f_i(x) = 0 for l_i > 0, every y with f_i(y) <= 0 has, by convexity,
/// d.(y - x) <= sum l_i (f_i(y) - f_i(x)) <= 0.
namespace touchstone {

namespace {

template <int Dim>
struct Program {
  const ConvexSurface<Dim>& surface;
  Vector<Dim> direction;  ///< unit
  double size;            ///< [m]
};

/// The change of the barrier function -d.x / mu - sum log(-f_i(x)) from `x` to x + step; infinite outside.
/// Summed as differences, for the function itself has too many digits before the point to show them.
template <int Dim>
double barrier_change(const Program<Dim>& program, double mu, const Vector<Dim>& x, const Vector<Dim>& step) {
  double change = -program.direction.dot(step) / mu;
  for (int i = 0; i < program.surface.count(); ++i) {
    const double ratio = program.surface.value(i, x + step) / program.surface.value(i, x);
    if (!(ratio > 0)) return std::numeric_limits<double>::infinity();
    change -= std::log(ratio);
  }
  return change;
}

/// A symmetric positive matrix sum_k r_k r_k^T as its triangular factor, built row by row with Givens
/// rotations.
///
/// Near a face the rows' squares span 26 decades, and adding them up would lose the small ones, which decide
/// where along the face to go; the factor keeps all of them.
template <int Dim>
class SumOfSquares {
 public:
  void add(Vector<Dim> row) {
    for (int k = 0; k < Dim; ++k) {
      Eigen::JacobiRotation<double> turn;
      double length = 0;
      turn.makeGivens(factor_(k, k), row[k], &length);
      for (int j = k; j < Dim; ++j) {
        const double upper = factor_(k, j);
        factor_(k, j) = turn.c() * upper - turn.s() * row[j];
        row[j] = turn.s() * upper + turn.c() * row[j];
      }
      factor_(k, k) = length;
      row[k] = 0;
    }
  }
  [[nodiscard]] Vector<Dim> solve(const Vector<Dim>& right) const {
    const auto upper = factor_.template triangularView<Eigen::Upper>();
    return upper.solve(Vector<Dim>(upper.transpose().solve(right)));
  }

 private:
  Matrix<Dim> factor_ = Matrix<Dim>::Zero();
};

/// Newton's step of the barrier function at `x`, and how much of a decrease it promises, twice.
template <int Dim>
struct BarrierStep {
  Vector<Dim> step;
  double decrement;
};

template <int Dim>
BarrierStep<Dim> barrier_newton(const Program<Dim>& program, double mu, const Vector<Dim>& x) {
  Vector<Dim> gradient = -program.direction / mu;
  Matrix<Dim> bend = Matrix<Dim>::Zero();
  SumOfSquares<Dim> hessian;
  for (int i = 0; i < program.surface.count(); ++i) {
    const SurfaceJet<Dim> jet = program.surface.jet(i, x);
    const Vector<Dim> scaled = jet.gradient / -jet.value;
    gradient += scaled;
    bend += jet.hessian / -jet.value;
    hessian.add(scaled);
  }
  const Eigen::LDLT<Matrix<Dim>> root(bend);
  const Matrix<Dim> rows = root.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                           Matrix<Dim>(root.matrixU()) * root.transpositionsP();
  for (int k = 0; k < Dim; ++k) hessian.add(rows.row(k).transpose());
  const Vector<Dim> step = -hessian.solve(gradient);
  return {step, -gradient.dot(step)};
}

/// Minimises the barrier function from `x`, a point inside, by damped Newton steps.
template <int Dim>
void centre(const Program<Dim>& program, double mu, Vector<Dim>& x) {
  constexpr int kMaximumSteps = 50;
  constexpr double kDecrement = 1e-3;  // close enough to start from for the next, smaller mu
  constexpr double kShortest = 1e-10;
  for (int k = 0; k < kMaximumSteps; ++k) {
    const BarrierStep<Dim> newton = barrier_newton(program, mu, x);
    if (!(newton.decrement > kDecrement) || !newton.step.allFinite()) return;
    double t = 1.0;
    while (t > kShortest &&
           !(barrier_change<Dim>(program, mu, x, t * newton.step) < -0.1 * t * newton.decrement)) {
      t *= 0.5;
    }
    if (t <= kShortest) return;  // rounding: no descent left to be had
    x += t * newton.step;
  }
}

/// Newton's method on  d - sum l_i grad f_i(x) = 0, f_i(x) = 0  over the inequalities that are active at the
/// barrier's `x`; none if it does not end in a proven maximum.
template <int Dim>
std::optional<Vector<Dim>> proven_maximum(const Program<Dim>& program, double slack, const Vector<Dim>& x) {
  constexpr int kMaximumSteps = 12;
  constexpr double kRounding = 1e-14;
  using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * Dim, 2 * Dim>;
  using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * Dim, 1>;
  ActiveSet<Dim> active(program.surface, x, program.direction, slack);
  for (int step = 0; step < kMaximumSteps; ++step) {
    const int size = active.size();
    Unknowns residual(Dim + size);
    residual << program.direction - active.normal(), -active.values() / program.size;
    if (residual.cwiseAbs().maxCoeff() <= kRounding) {
      if (active.exchange(kRounding * program.size)) {
        active.update();
        continue;
      }
      const double outside =
          program.surface.value(largest_inequality(program.surface, active.x()), active.x());
      if (outside <= kRounding * program.size) return active.x();
      return std::nullopt;
    }
    System matrix = System::Zero(Dim + size, Dim + size);
    matrix.template topLeftCorner<Dim, Dim>() = program.size * active.hessian();
    matrix.topRightCorner(Dim, size) = active.gradients();
    matrix.bottomLeftCorner(size, Dim) = active.gradients().transpose();
    const Unknowns change = matrix.completeOrthogonalDecomposition().solve(residual);
    active.move(program.size * change.template head<Dim>(), change.tail(size));
    active.update();
  }
  return std::nullopt;
}

}  // namespace

template <int Dim>
Vector<Dim> farthest_point(const ConvexSurface<Dim>& surface, const Vector<Dim>& inside, double size,
                           const Vector<Dim>& direction) {
  constexpr double kStart = 0.1;      // mu over size: how far from the surface the path begins
  constexpr double kProvable = 1e-4;  // the active inequalities begin to show
  constexpr double kEnd = 1e-13;
  const Program<Dim> program{surface, direction.normalized(), size};
  Vector<Dim> x = inside;
  for (double mu = kStart; mu > kEnd / surface.count(); mu *= 0.1) {
    centre(program, mu * size, x);
    if (mu > kProvable) continue;
    // On the path f_i = -mu / l_i: what is active is far closer than sqrt(mu), what is not far deeper.
    if (const auto exact = proven_maximum(program, std::sqrt(mu) * size, x)) return *exact;
  }
  return x;
}

template Vector<2> farthest_point(const ConvexSurface<2>&, const Vector<2>&, double, const Vector<2>&);
template Vector<3> farthest_point(const ConvexSurface<3>&, const Vector<3>&, double, const Vector<3>&);

}  // namespace touchstone
