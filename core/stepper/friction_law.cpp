#include "core/stepper/friction_law.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Eq. 5, rows divided by e_i, and zeta of Eq. 11.
template <int Dim>
FrictionRows<Dim> fritz_john(double mu, const FrictionVector<Dim>& y, const FrictionVector<Dim>& w, double p,
                             double s) {
  using Rows = FrictionRows<Dim>;
  Rows rows;
  rows.value = mu * p * w + s * y;
  rows.d_y = s * Rows::Square::Identity();
  rows.d_w = mu * p * Rows::Square::Identity();
  rows.d_p = mu * w;
  rows.d_s = y;
  rows.slip_value = mu * mu * p * p - y.squaredNorm();
  rows.slip_d_y = -2 * y.transpose();
  rows.slip_d_p = 2 * mu * mu * p;
  return rows;
}

/// With d = y - rho w: inside the ball the row is rho w = 0 (stick); outside it is y - mu p d/|d| (slip along
/// -w).
template <int Dim>
struct Projection {
  Projection(double mu, double rho, const FrictionVector<Dim>& y, const FrictionVector<Dim>& w, double p,
             double s)
      : direction(y - rho * w), radius(mu * std::max(p, 0.0)), length(direction.norm()), speed(w.norm()) {
    slip_value = s - speed;
    sticks = length <= radius;
    if (sticks) {
      value = rho * w;
    } else {
      direction /= length;
      value = y - radius * direction;
    }
  }

  FrictionVector<Dim> direction;  ///< d, or d/|d| where it slips
  double radius, length, speed;
  bool sticks;
  FrictionVector<Dim> value;
  double slip_value;
};

template <int Dim>
inline FrictionRows<Dim> projection(double mu, double rho, const FrictionVector<Dim>& y,
                                    const FrictionVector<Dim>& w, double p, double s) {
  using Rows = FrictionRows<Dim>;
  using Square = typename Rows::Square;
  const Projection<Dim> projected(mu, rho, y, w, p, s);
  Rows rows;
  rows.value = projected.value;
  if (projected.sticks) {
    rows.d_w = rho * Square::Identity();
  } else {
    const FrictionVector<Dim>& direction = projected.direction;
    const Square derivative =
        projected.radius / projected.length * (Square::Identity() - direction * direction.transpose());
    rows.d_y = Square::Identity() - derivative;
    rows.d_w = rho * derivative;
    if (p > 0) rows.d_p = -mu * direction;
  }
  rows.slip_value = projected.slip_value;
  rows.slip_d_s = 1;
  if (projected.speed > 0) rows.slip_d_w = -w.transpose() / projected.speed;
  return rows;
}

template <int Dim>
FrictionRows<Dim> no_slip(const FrictionVector<Dim>& w, double s) {
  FrictionRows<Dim> rows;
  rows.value = w;
  rows.d_w = FrictionRows<Dim>::Square::Identity();
  rows.slip_value = s;
  rows.slip_d_s = 1;
  return rows;
}

/// The projection smoothed. Outside the ball of radius R it shortens d by max(1, |d| / R), the root of
/// max(1, X) with X = |d|^2 / R^2; here the maximum is (1 + X + sqrt((1 - X)^2 + 4 e^2)) / 2 with e = tau /
/// R, and R = mu (p + sqrt(p^2 + 4 tau^2)) / 2 is positive whatever p is. Differentiable everywhere, and the
/// projection for tau -> 0.
template <int Dim>
[[gnu::noinline, gnu::cold]] FrictionRows<Dim> smoothed_projection(double mu, double rho, double tau,
                                                                   const FrictionVector<Dim>& y,
                                                                   const FrictionVector<Dim>& w, double p,
                                                                   double s) {
  using Rows = FrictionRows<Dim>;
  using Square = typename Rows::Square;
  Rows rows;
  const double speed = w.norm();
  rows.slip_value = s - speed;
  rows.slip_d_s = 1;
  if (speed > 0) rows.slip_d_w = -w.transpose() / speed;
  rows.value = y;  // without friction
  rows.d_y = Square::Identity();
  const double root = std::sqrt(p * p + 4 * tau * tau);
  const double radius = mu * (p + root) / 2;
  if (!(radius > 0)) return rows;
  const FrictionVector<Dim> d = y - rho * w;
  const double excess = d.squaredNorm() / (radius * radius);
  const double e = tau / radius;
  const double corner = std::sqrt((1 - excess) * (1 - excess) + 4 * e * e);
  const double squared = (1 + excess + corner) / 2;
  const double by_excess = (1 + (excess - 1) / corner) / 2;
  const double shrink = 1 / std::sqrt(squared);
  const double shrink_by_squared = -0.5 * shrink / squared;
  const Square derivative = shrink * Square::Identity() +
                            (2 * shrink_by_squared * by_excess / (radius * radius)) * d * d.transpose();
  const double shrink_by_radius =
      shrink_by_squared * (by_excess * (-2 * excess / radius) - 2 * e * e / (corner * radius));
  const double radius_by_p = mu * (1 + p / root) / 2;
  rows.value = y - shrink * d;
  rows.d_y = Square::Identity() - derivative;
  rows.d_w = rho * derivative;
  rows.d_p = -shrink_by_radius * radius_by_p * d;
  return rows;
}

}  // namespace

template <int Dim>
FrictionRows<Dim> friction_rows(FrictionForm form, double mu, double rho, const FrictionVector<Dim>& active,
                                const FrictionVector<Dim>& y, const FrictionVector<Dim>& w, double p,
                                double s, double smoothing) {
  const FrictionVector<Dim> carried = active.cwiseProduct(y);
  FrictionRows<Dim> rows = form == FrictionForm::fritz_john ? fritz_john<Dim>(mu, carried, w, p, s)
                           : form == FrictionForm::no_slip  ? no_slip<Dim>(w, s)
                           : smoothing > 0 ? smoothed_projection<Dim>(mu, rho, smoothing, carried, w, p, s)
                                           : projection<Dim>(mu, rho, carried, w, p, s);
  for (int i = 0; i < FrictionRows<Dim>::n; ++i) {
    if (active[i] != 0) continue;
    rows.value[i] = y[i];
    rows.d_y.row(i).setZero();
    rows.d_y.col(i).setZero();
    rows.d_y(i, i) = 1;
    rows.d_w.row(i).setZero();
    rows.d_p[i] = 0;
    rows.d_s[i] = 0;
    rows.slip_d_y[i] = 0;
  }
  return rows;
}

template <int Dim>
FrictionValues<Dim> friction_values(FrictionForm form, double mu, double rho,
                                    const FrictionVector<Dim>& active, const FrictionVector<Dim>& y,
                                    const FrictionVector<Dim>& w, double p, double s, double smoothing) {
  if (form != FrictionForm::projection || smoothing > 0) {
    const FrictionRows<Dim> rows = friction_rows<Dim>(form, mu, rho, active, y, w, p, s, smoothing);
    return {rows.value, rows.slip_value};
  }
  const Projection<Dim> projected(mu, rho, active.cwiseProduct(y), w, p, s);
  return {(active.array() != 0).select(projected.value, y), projected.slip_value};
}

template FrictionValues<2> friction_values(FrictionForm, double, double, const FrictionVector<2>&,
                                           const FrictionVector<2>&, const FrictionVector<2>&, double, double,
                                           double);
template FrictionValues<3> friction_values(FrictionForm, double, double, const FrictionVector<3>&,
                                           const FrictionVector<3>&, const FrictionVector<3>&, double, double,
                                           double);
template FrictionRows<2> friction_rows(FrictionForm, double, double, const FrictionVector<2>&,
                                       const FrictionVector<2>&, const FrictionVector<2>&, double, double,
                                       double);
template FrictionRows<3> friction_rows(FrictionForm, double, double, const FrictionVector<3>&,
                                       const FrictionVector<3>&, const FrictionVector<3>&, double, double,
                                       double);

}  // namespace touchstone
