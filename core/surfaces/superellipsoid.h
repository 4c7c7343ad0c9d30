#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f(x) = s/2 (g(x)^2 - 1), s the geometric mean of the semi-axes a_i and g the gauge of the body: the factor
/// by which it must be scaled about its centre for x to lie on it, sum_i |x_i / (a_i g)|^p_i = 1.
///
/// Why not sum |x_i/a_i|^p_i - 1 itself: its gradient grows like the distance to the power p - 1 and vanishes
/// like it inside, which leaves Newton's method a small basin. The gauge is convex and homogeneous of degree
/// 1, so that |grad f| = s g / h(n), h(n) the centre's distance from the tangent plane with normal n: between
/// s/a_max and s/a_min on the surface for any exponents, and linear in the distance along every ray. With all
/// p_i = 2 this is the ellipsoid's f. C2 but for the origin, where the ellipsoid's Hessian is given.
template <int Dim>
class SuperellipsoidSurface final : public ConvexSurface<Dim> {
 public:
  explicit SuperellipsoidSurface(const Superellipsoid<Dim>& superellipsoid);

  SurfaceJet<Dim> jet(int, const Vector<Dim>& x) const override;
  double value(int, const Vector<Dim>& x) const override;
  Vector<Dim> support(const Vector<Dim>& direction) const override;
  /// Exact if all exponents are equal, else that of the superellipsoid with the greatest exponent.
  typename ConvexSurface<Dim>::BoundingBall bounding_ball() const override;

 private:
  [[nodiscard]] double gauge(const Vector<Dim>& x) const;

  Vector<Dim> semi_axes_;  ///< a_i [m]
  Vector<Dim> exponents_;  ///< p_i >= 2
  double scale_;           ///< s [m]
};

}  // namespace touchstone
