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
FrictionRows<Dim> projection(double mu, double rho, const FrictionVector<Dim>& y,
                             const FrictionVector<Dim>& w, double p, double s) {
  using Rows = FrictionRows<Dim>;
  using Square = typename Rows::Square;
  Rows rows;
  const FrictionVector<Dim> d = y - rho * w;
  const double length = d.norm();
  const double radius = mu * std::max(p, 0.0);
  if (length <= radius) {
    rows.value = rho * w;
    rows.d_w = rho * Square::Identity();
  } else {
    const FrictionVector<Dim> direction = d / length;
    const Square derivative = radius / length * (Square::Identity() - direction * direction.transpose());
    rows.value = y - radius * direction;
    rows.d_y = Square::Identity() - derivative;
    rows.d_w = rho * derivative;
    if (p > 0) rows.d_p = -mu * direction;
  }
  const double speed = w.norm();
  rows.slip_value = s - speed;
  rows.slip_d_s = 1;
  if (speed > 0) rows.slip_d_w = -w.transpose() / speed;
  return rows;
}

}  // namespace

template <int Dim>
FrictionRows<Dim> friction_rows(FrictionForm form, double mu, double rho, const FrictionVector<Dim>& active,
                                const FrictionVector<Dim>& y, const FrictionVector<Dim>& w, double p,
                                double s) {
  const FrictionVector<Dim> carried = active.cwiseProduct(y);
  FrictionRows<Dim> rows = form == FrictionForm::fritz_john ? fritz_john<Dim>(mu, carried, w, p, s)
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

template FrictionRows<2> friction_rows(FrictionForm, double, double, const FrictionVector<2>&,
                                       const FrictionVector<2>&, const FrictionVector<2>&, double, double);
template FrictionRows<3> friction_rows(FrictionForm, double, double, const FrictionVector<3>&,
                                       const FrictionVector<3>&, const FrictionVector<3>&, double, double);

}  // namespace touchstone
