#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace touchstone::truth {

/// P_0(x) .. P_{Count-1}(x), x in [-1, 1], by Bonnet's
/// recursion (k + 1) P_{k+1} = (2k + 1) x P_k - k P_{k-1}.
template <std::size_t Count, class Real>
std::array<Real, Count> legendre(Real x) {
  std::array<Real, Count> p{};
  p[0] = 1;
  if constexpr (Count > 1) p[1] = x;
  for (std::size_t k = 1; k + 1 < Count; ++k) {
    const Real degree = static_cast<Real>(k);
    p[k + 1] = ((2 * degree + 1) * x * p[k] - degree * p[k - 1]) / (degree + 1);
  }
  return p;
}

/// The Gauss-Legendre rule on [0, 1], exact for polynomials of degree 2 Points - 1, and the
/// matrices of collocation at its nodes. Computed rather than tabulated, so that no digit of it
/// is of unknown origin, and in long double, so that the last bit of each is right.
template <std::size_t Points>
struct GaussRule {
  using Matrix = std::array<std::array<double, Points>, Points>;

  std::array<double, Points> node{};    ///< c_i, increasing
  std::array<double, Points> weight{};  ///< b_i > 0, sum 1
  Matrix to_modes{};  ///< [k][j]: f_hat_k = sum_j to_modes[k][j] f(c_j) in f(c) = sum_k f_hat_k P_k(2c - 1)
  Matrix integral{};  ///< [i][j]: integral from 0 to c_i of the j-th Lagrange polynomial (Butcher's a_ij)

  static const GaussRule& instance() {
    static const GaussRule rule;
    return rule;
  }

 private:
  GaussRule() {
    std::array<std::array<long double, Points + 1>, Points> p{};  // [i][k] = P_k(x_i)
    for (std::size_t i = 0; i < Points; ++i) p[i] = legendre<Points + 1>(abscissa(i));
    for (std::size_t j = 0; j < Points; ++j) {
      const long double b = weight_at(p[j]);
      node[j] = static_cast<double>((1 + p[j][1]) / 2);
      weight[j] = static_cast<double>(b);
      for (std::size_t k = 0; k < Points; ++k) {
        to_modes[k][j] = static_cast<double>((2 * static_cast<long double>(k) + 1) * b * p[j][k]);
      }
      // (2k + 1) times the integral of P_k from -1 to x is P_{k+1}(x) - P_{k-1}(x).
      for (std::size_t i = 0; i < Points; ++i) {
        long double sum = (1 + p[i][1]) / 2;
        for (std::size_t k = 1; k < Points; ++k) sum += p[j][k] * (p[i][k + 1] - p[i][k - 1]) / 2;
        integral[i][j] = static_cast<double>(b * sum);
      }
    }
  }

  /// P_n'(x) from n P_{n-1} = n x P_n - (x^2 - 1) P_n'.
  static long double slope(const std::array<long double, Points + 1>& p) {
    return static_cast<long double>(Points) * (p[1] * p[Points] - p[Points - 1]) / (p[1] * p[1] - 1);
  }

  static long double weight_at(const std::array<long double, Points + 1>& p) {
    return 1 / ((1 - p[1] * p[1]) * slope(p) * slope(p));  // half of the weight on [-1, 1]
  }

  /// The i-th zero of P_Points in increasing order: Newton from Chebyshev's estimate.
  static long double abscissa(std::size_t i) {
    const auto n = static_cast<long double>(Points);
    long double x =
        -std::cos(std::numbers::pi_v<long double> * (static_cast<long double>(i) + 0.75L) / (n + 0.5L));
    for (int iteration = 0; iteration < 8; ++iteration) {
      const auto p = legendre<Points + 1>(x);
      x -= p[Points] / slope(p);
    }
    return x;
  }
};

/// Integral of `f` over [a, b] by a composite 20-point rule on `panels` equal panels. For integrands that
/// are analytic near the interval; there 1e-15 (relative to the integral of |f|) takes a handful of panels.
template <class Function>
double quadrature(const Function& f, double a, double b, int panels) {
  const auto& rule = GaussRule<20>::instance();
  const double width = (b - a) / panels;
  double sum = 0.0;
  for (int panel = 0; panel < panels; ++panel) {
    const double left = a + width * panel;
    for (std::size_t i = 0; i < rule.node.size(); ++i) sum += rule.weight[i] * f(left + width * rule.node[i]);
  }
  return sum * width;
}

}  // namespace touchstone::truth
