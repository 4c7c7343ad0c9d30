#include "core/surfaces/superellipsoid.h"

#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// The t with sum_i exp(q_i (c_i - t)) = 1, for finite q_i > 0 and c_i < infinity, not all -infinity.
///
/// Newton's method on the logarithm of the sum, which is convex and decreasing in t (log-sum-exp of affine
/// functions): from the left of the root, where the largest term alone is 1, it ascends monotonically to it,
/// and it takes one step if all q_i are equal, for then the function is affine.
template <int Dim>
double unit_log_sum(const Vector<Dim>& c, const Vector<Dim>& q) {
  constexpr int kMaximumSteps = 100;
  double t = c.maxCoeff();
  for (int k = 0; k < kMaximumSteps; ++k) {
    double sum = 0;
    double slope = 0;
    for (int i = 0; i < Dim; ++i) {
      const double term = std::exp(q[i] * (c[i] - t));
      sum += term;
      slope += q[i] * term;
    }
    const double step = std::log(sum) * sum / slope;
    t += step;
    if (std::abs(step) <= std::numeric_limits<double>::epsilon()) break;
  }
  return t;
}

}  // namespace

template <int Dim>
SuperellipsoidSurface<Dim>::SuperellipsoidSurface(const Superellipsoid<Dim>& superellipsoid)
    : semi_axes_(superellipsoid.semi_axes),
      exponents_(superellipsoid.exponents),
      scale_(std::pow(semi_axes_.prod(), 1.0 / Dim)) {}

template <int Dim>
double SuperellipsoidSurface<Dim>::gauge(const Vector<Dim>& x) const {
  if (x.isZero(0)) return 0;
  return std::exp(unit_log_sum<Dim>(x.cwiseQuotient(semi_axes_).array().abs().log(), exponents_));
}

template <int Dim>
double SuperellipsoidSurface<Dim>::value(int, const Vector<Dim>& x) const {
  const double g = gauge(x);
  return 0.5 * scale_ * (g - 1) * (g + 1);
}

template <int Dim>
SurfaceJet<Dim> SuperellipsoidSurface<Dim>::jet(int, const Vector<Dim>& x) const {
  const double g = gauge(x);
  SurfaceJet<Dim> jet;
  jet.value = 0.5 * scale_ * (g - 1) * (g + 1);
  if (g == 0) {
    jet.hessian = (scale_ * semi_axes_.array().square().inverse()).matrix().asDiagonal();
    return jet;
  }
  // Implicit differentiation of F(x, g) = sum |u_i|^p_i - 1 = 0, u_i = x_i / (a_i g): with D = -g F_g,
  //   grad g = g F_x / D,   g Hess g = g^2 (F_xx + F_xg grad g^T + grad g F_xg^T + F_gg grad g grad g^T) / D.
  Vector<Dim> f_x;   // g F_x
  Vector<Dim> f_xg;  // g^2 F_xg
  Vector<Dim> f_xx;  // g^2 F_xx, diagonal
  double d = 0;
  double f_gg = 0;  // g^2 F_gg
  for (int i = 0; i < Dim; ++i) {
    const double p = exponents_[i];
    const double u = x[i] / (semi_axes_[i] * g);
    const double u_p2 = std::pow(std::abs(u), p - 2);
    const double u_p = u_p2 * u * u;
    f_x[i] = p * u_p2 * u / semi_axes_[i];
    f_xg[i] = -p * f_x[i];
    f_xx[i] = p * (p - 1) * u_p2 / (semi_axes_[i] * semi_axes_[i]);
    d += p * u_p;
    f_gg += p * (p + 1) * u_p;
  }
  const Vector<Dim> slope = f_x / d;  // grad g
  jet.gradient = scale_ * g * slope;
  jet.hessian = f_gg * slope * slope.transpose() + f_xg * slope.transpose() + slope * f_xg.transpose();
  jet.hessian.diagonal() += f_xx;
  jet.hessian = scale_ * (slope * slope.transpose() + jet.hessian / d);
  return jet;
}

template <int Dim>
Vector<Dim> SuperellipsoidSurface<Dim>::support(const Vector<Dim>& direction) const {
  // Lagrange: |d_i| a_i = exp(t) p_i |u_i|^(p_i - 1), and t from sum |u_i|^p_i = 1.
  const Eigen::Array<double, Dim, 1> one_less = exponents_.array() - 1;
  const Vector<Dim> c = (direction.array().abs() * semi_axes_.array() / exponents_.array()).log();
  const double t = unit_log_sum<Dim>(c, exponents_.array() / one_less);
  const Eigen::Array<double, Dim, 1> u = ((c.array() - t) / one_less).exp();
  return (direction.array().sign() * semi_axes_.array() * u).matrix();
}

template <int Dim>
typename ConvexSurface<Dim>::BoundingBall SuperellipsoidSurface<Dim>::bounding_ball() const {
  // max sum a_i^2 u_i^2 over sum |u_i|^p = 1 is, by Hoelder, the norm of (a_i^2) with exponent p / (p - 2):
  // infinite for p = 2, where pow gives the maximum norm.
  const double p = exponents_.maxCoeff();
  const double q = 2 * p / (p - 2);
  const double longest = semi_axes_.maxCoeff();
  const double sum = (semi_axes_ / longest).array().pow(q).sum();
  return {Vector<Dim>::Zero(), longest * std::pow(sum, 1 / q)};
}

template class SuperellipsoidSurface<2>;
template class SuperellipsoidSurface<3>;

}  // namespace touchstone
