#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f_0 = c (r(rho) - k (H - z)), rho^2 = x^2 + y^2, k = R/H, c = 1/sqrt(1 + k^2): the lateral surface;
/// f_1 = -z: the base.
///
/// With r = rho this is the cone, f_0 its distance, and the apex its one defect: any normal of a whole cone
/// of directions belongs to it, but one gradient cannot stand for them, and Newton's method has nothing to
/// differentiate. So within rho < e = kTip R of the axis
///   r(rho) = e (3 + 6 u^2 - u^4) / 8,   u = rho / e,
/// which joins r = rho at u = 1 with two continuous derivatives and is convex: f_0 is C2 and convex
/// everywhere, its gradient between c k and 1 long. The surface is the cone's own for rho >= e; the apex is
/// rounded and stands 3/8 kTip H below (0, 0, H). (The square x^2 + y^2 - k^2 (H - z)^2 is neither convex nor
/// has it a gradient at the apex.)
class ConeSurface final : public ConvexSurface<3> {
 public:
  /// Radius of the rounding over the base's: small against the body, large against the error of a predicted
  /// contact point in one time step.
  static constexpr double kTip = 1e-3;

  explicit ConeSurface(const Cone& cone);

  int count() const override { return 2; }
  SurfaceJet<3> jet(int i, const Vector<3>& x) const override;
  double value(int i, const Vector<3>& x) const override;
  /// On the rounded tip, or on the rim (the base's centre if `direction` is exactly -z).
  Vector<3> support(const Vector<3>& direction) const override;
  BoundingBall bounding_ball() const override;

 private:
  /// r(rho) [m].
  [[nodiscard]] double rounded(double rho) const;

  double radius_;     ///< R [m]
  double height_;     ///< H [m]
  double slope_;      ///< k
  double scale_;      ///< c
  double tip_width_;  ///< e [m]
};

}  // namespace touchstone
