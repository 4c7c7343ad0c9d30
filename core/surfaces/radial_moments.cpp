#include "core/surfaces/radial_moments.h"

#include <cmath>
#include <numbers>

#include "core/surfaces/adaptive_quadrature.h"

namespace touchstone {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// 1, x and the upper triangle of x x^T in one column, the bounding ball's radius as unit of length.
template <int Dim>
using Column = Eigen::Matrix<double, 1 + Dim + Dim*(Dim + 1) / 2, 1>;

template <int Dim>
class Rays {
 public:
  explicit Rays(const ConvexSurface<Dim>& surface)
      : surface_(surface), unit_(surface.bounding_ball().radius) {
    for (int k = 0; k < Dim; ++k) {
      inside_ += surface.support(Vector<Dim>::Unit(k)) / (2 * Dim);
      inside_ += surface.support(-Vector<Dim>::Unit(k)) / (2 * Dim);
    }
  }

  [[nodiscard]] const Vector<Dim>& inside() const { return inside_; }
  [[nodiscard]] double unit() const { return unit_; }

  /// The integrals' share of the direction u, per solid angle.
  [[nodiscard]] Column<Dim> integrand(const Vector<Dim>& u) const {
    const double r = length(u) / unit_;
    const double r_n = std::pow(r, Dim);
    Column<Dim> column;
    column[0] = r_n / Dim;
    int at = 1;
    for (int i = 0; i < Dim; ++i) column[at++] = u[i] * r_n * r / (Dim + 1);
    for (int i = 0; i < Dim; ++i) {
      for (int j = i; j < Dim; ++j) column[at++] = u[i] * u[j] * r_n * r * r / (Dim + 2);
    }
    return column;
  }

 private:
  /// The least root of the f_i along the ray. Each is convex there and negative at its start, so that
  /// Newton's method descends to its root monotonically from any point where it is positive.
  [[nodiscard]] double length(const Vector<Dim>& u) const {
    constexpr int kMaximumSteps = 100;
    double r = 2 * unit_;
    for (int i = 0; i < surface_.count(); ++i) {
      if (surface_.value(i, inside_ + r * u) <= 0) continue;
      for (int step = 0; step < kMaximumSteps; ++step) {
        const SurfaceJet<Dim> jet = surface_.jet(i, inside_ + r * u);
        const double change = jet.value / jet.gradient.dot(u);
        r -= change;
        if (!(change > 1e-15 * unit_)) break;
      }
    }
    return r;
  }

  const ConvexSurface<Dim>& surface_;
  double unit_;
  Vector<Dim> inside_ = Vector<Dim>::Zero();
};

Column<2> integrate(const Rays<2>& rays, double tolerance) {
  const auto at_angle = [&](double phi) { return rays.integrand({std::cos(phi), std::sin(phi)}); };
  return AdaptiveQuadrature<Column<2>, decltype(at_angle)>(at_angle, tolerance).over(0, kTurn).value;
}

/// Over heights z of the unit sphere (Archimedes: du = dz dphi) and, inside, around each circle of latitude.
Column<3> integrate(const Rays<3>& rays, double tolerance) {
  constexpr double kInner = 0.1;  // the outer rule must not see the inner one's error
  const auto at_height = [&](double z) {
    const double rho = std::sqrt((1 - z) * (1 + z));
    const auto at_angle = [&](double phi) {
      return rays.integrand({rho * std::cos(phi), rho * std::sin(phi), z});
    };
    return AdaptiveQuadrature<Column<3>, decltype(at_angle)>(at_angle, kInner * tolerance)
        .over(0, kTurn)
        .value;
  };
  return AdaptiveQuadrature<Column<3>, decltype(at_height)>(at_height, tolerance).over(-1, 1).value;
}

}  // namespace

template <int Dim>
Moments<Dim> radial_moments(const ConvexSurface<Dim>& surface, double tolerance) {
  const Rays<Dim> rays(surface);
  // A first pass tells how large the integrals are, hence what the relative tolerance means.
  const double rough = integrate(rays, 1e-2)[0];
  const Column<Dim> column = integrate(rays, tolerance * rough);
  const double unit = rays.unit();
  Moments<Dim> moments;
  moments.measure = column[0] * std::pow(unit, Dim);
  const Vector<Dim> mean = column.template segment<Dim>(1) / column[0];
  int at = 1 + Dim;
  for (int i = 0; i < Dim; ++i) {
    for (int j = i; j < Dim; ++j) {
      moments.second(i, j) = moments.second(j, i) =
          unit * unit * (column[at++] / column[0] - mean[i] * mean[j]);
    }
  }
  moments.center = rays.inside() + unit * mean;
  return moments;
}

template Moments<2> radial_moments(const ConvexSurface<2>&, double);
template Moments<3> radial_moments(const ConvexSurface<3>&, double);

}  // namespace touchstone
