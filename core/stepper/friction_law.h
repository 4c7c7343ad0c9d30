#pragma once

#include "core/model/scene.h"

namespace touchstone {

/// How the friction rows are written for the solver. The first two have the same solutions.
enum class FrictionForm {
  /// Eqs. 10-11 as printed: mu p_n w + y sigma = 0, 0 <= sigma _|_ (mu p_n)^2 - |y|^2 >= 0. Singular at p_n =
  /// 0 and where
  /// the contact sticks with no load in the ellipsoid's interior; what every solution is judged on.
  fritz_john,
  /// y = proj_{|.| <= mu p_n}(y - rho w), sigma = |w|: the same maximum dissipation as a fixed point; regular
  /// there.
  projection,
  /// w: what is 0 where the contact sticks. For methods that have the law in a form of their own.
  no_slip,
};

/// The friction rows of one contact and their derivatives in scaled variables: y = E^-1 p_f / (m V), w = E
/// v_f / V, p = p_n / (m V), s = sigma / V.
template <int Dim>
struct FrictionRows {
  static constexpr int n = Dimension<Dim>::friction;
  using Square = Eigen::Matrix<double, n, n>;
  using Row = Eigen::Matrix<double, 1, n>;

  FrictionVector<Dim> value = FrictionVector<Dim>::Zero();  ///< rows paired with y
  Square d_y = Square::Zero();
  Square d_w = Square::Zero();
  FrictionVector<Dim> d_p = FrictionVector<Dim>::Zero();
  FrictionVector<Dim> d_s = FrictionVector<Dim>::Zero();

  double slip_value = 0.0;  ///< row paired with sigma
  Row slip_d_y = Row::Zero();
  Row slip_d_w = Row::Zero();
  double slip_d_p = 0.0;
  double slip_d_s = 0.0;
};

/// @param mu   coefficient of friction
/// @param rho  of the projection form, > 0, dimensionless
/// @param active  1 for a direction that can carry friction, 0 for one whose semi-axis is 0 (there y = 0 is
/// the row)
/// @param smoothing  tau >= 0, in the unit of p, of the projection form: > 0 makes it differentiable
/// everywhere, with friction of a contact that does not load or slip as well; the solutions are those of the
/// law for tau -> 0
template <int Dim>
FrictionRows<Dim> friction_rows(FrictionForm form, double mu, double rho, const FrictionVector<Dim>& active,
                                const FrictionVector<Dim>& y, const FrictionVector<Dim>& w, double p,
                                double s, double smoothing = 0.0);

/// The rows without their derivatives.
template <int Dim>
struct FrictionValues {
  FrictionVector<Dim> value;
  double slip_value = 0.0;
};
template <int Dim>
FrictionValues<Dim> friction_values(FrictionForm form, double mu, double rho,
                                    const FrictionVector<Dim>& active, const FrictionVector<Dim>& y,
                                    const FrictionVector<Dim>& w, double p, double s, double smoothing);

}  // namespace touchstone
