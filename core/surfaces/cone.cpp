#include "core/surfaces/cone.h"

#include <cmath>

namespace touchstone {

ConeSurface::ConeSurface(const Cone& cone)
    : radius_(cone.radius),
      height_(cone.height),
      slope_(cone.radius / cone.height),
      scale_(1 / std::hypot(1.0, slope_)),
      tip_width_(kTip * cone.radius) {}

double ConeSurface::rounded(double rho) const {
  if (rho >= tip_width_) return rho;
  const double u2 = rho * rho / (tip_width_ * tip_width_);
  return tip_width_ * (3 + u2 * (6 - u2)) / 8;
}

double ConeSurface::value(int i, const Vector<3>& x) const {
  if (i == 1) return -x.z();
  return scale_ * (rounded(x.head<2>().norm()) - slope_ * (height_ - x.z()));
}

SurfaceJet<3> ConeSurface::jet(int i, const Vector<3>& x) const {
  if (i == 1) return {value(i, x), -Vector<3>::UnitZ(), Matrix<3>::Zero()};
  const Vector<2> across = x.head<2>();
  const double rho = across.norm();
  // grad r = a x, Hess r = a I + b x x^T with a = r'/rho and b = (r'' - r'/rho) / rho^2.
  double a = 0;
  double b = 0;
  if (rho >= tip_width_) {
    a = 1 / rho;
    b = -1 / (rho * rho * rho);
  } else {
    const double per_e2 = 1 / (tip_width_ * tip_width_);
    a = (3 - rho * rho * per_e2) / (2 * tip_width_);
    b = -per_e2 / tip_width_;
  }
  SurfaceJet<3> jet;
  jet.value = value(i, x);
  jet.gradient << scale_ * a * across, scale_ * slope_;
  jet.hessian.topLeftCorner<2, 2>() = scale_ * (a * Matrix<2>::Identity() + b * across * across.transpose());
  return jet;
}

Vector<3> ConeSurface::support(const Vector<3>& direction) const {
  const double across = direction.head<2>().norm();
  const Vector<2> outward = across > 0 ? Vector<2>(direction.head<2>() / across) : Vector<2>(0, 0);
  Vector<3> point = Vector<3>::Zero();
  if (slope_ * across >= direction.z()) {
    point.head<2>() = radius_ * outward;
    return point;
  }
  // On the tip r'(rho) = k d_rho / d_z = t, the cubic u^3 - 3 u + 2 t = 0: u = 2 sin(asin(t) / 3).
  const double u = 2 * std::sin(std::asin(slope_ * across / direction.z()) / 3);
  const double rho = tip_width_ * u;
  point.head<2>() = rho * outward;
  point.z() = height_ - rounded(rho) / slope_;
  return point;
}

ConeSurface::BoundingBall ConeSurface::bounding_ball() const {
  if (height_ <= radius_) return {Vector<3>::Zero(), radius_};
  const double radius = (radius_ * radius_ + height_ * height_) / (2 * height_);  // circumcircle of a section
  return {Vector<3>(0, 0, height_ - radius), radius};
}

}  // namespace touchstone
