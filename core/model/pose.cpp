#include "core/model/pose.h"

namespace touchstone {

namespace {
// Below this angle [rad] the series are exact to rounding and the closed forms lose digits.
constexpr double kSmallAngle = 1e-2;
}  // namespace

Eigen::Quaterniond exp_rotation(const Vector<3>& turn) {
  const double angle2 = turn.squaredNorm();
  const double half2 = angle2 / 4;
  double w = 0;
  double scale = 0;  // sin(angle/2) / angle
  if (angle2 < kSmallAngle * kSmallAngle) {
    w = 1 - half2 / 2 * (1 - half2 / 12 * (1 - half2 / 30));
    scale = 0.5 * (1 - half2 / 6 * (1 - half2 / 20 * (1 - half2 / 42)));
  } else {
    const double angle = std::sqrt(angle2);
    w = std::cos(angle / 2);
    scale = std::sin(angle / 2) / angle;
  }
  return {w, scale * turn.x(), scale * turn.y(), scale * turn.z()};
}

Matrix<3> left_jacobian(const Vector<3>& theta) {
  const double angle2 = theta.squaredNorm();
  double a = 0;  // (1 - cos) / angle^2
  double b = 0;  // (angle - sin) / angle^3
  if (angle2 < kSmallAngle * kSmallAngle) {
    a = 0.5 * (1 - angle2 / 12 * (1 - angle2 / 30 * (1 - angle2 / 56)));
    b = 1.0 / 6 * (1 - angle2 / 20 * (1 - angle2 / 42 * (1 - angle2 / 72)));
  } else {
    const double angle = std::sqrt(angle2);
    a = (1 - std::cos(angle)) / angle2;
    b = (angle - std::sin(angle)) / (angle2 * angle);
  }
  Matrix<3> cross;
  cross << 0, -theta.z(), theta.y(), theta.z(), 0, -theta.x(), -theta.y(), theta.x(), 0;
  return Matrix<3>::Identity() + a * cross + b * cross * cross;
}

}  // namespace touchstone
