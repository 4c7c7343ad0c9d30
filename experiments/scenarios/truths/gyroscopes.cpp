#include "experiments/scenarios/truths/gyroscopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "experiments/scenarios/truths/gauss_legendre.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// omega(t) in body axes, in closed form.
class EulerTop {
 public:
  explicit EulerTop(const FreeRotation& body) {
    const Vector3d momentum = body.inertia.cwiseProduct(body.omega_body);
    const double l2 = momentum.squaredNorm();
    const double t2 = momentum.dot(body.omega_body);  // twice the kinetic energy
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return body.inertia[a] < body.inertia[b]; });
    // L turns about the axis of the largest moment if L^2 > 2
    // T I_2, else about that of the smallest: counted third.
    if (l2 < t2 * body.inertia[order[1]]) std::swap(order[0], order[2]);
    axis_ = order;
    const double i1 = body.inertia[axis_[0]], i2 = body.inertia[axis_[1]], i3 = body.inertia[axis_[2]];
    const double wobble = t2 * i3 - l2;
    const double main = l2 - t2 * i1;
    parameter_ = (i2 - i1) * wobble / ((i3 - i2) * main);
    require(parameter_ <= 1.0 - 1e-10, "m (1 on the separatrix)", parameter_, "<= 1 - 1e-10");
    parameter_ = std::max(parameter_, 0.0);  // rounding, at permanent rotation
    rate_ = std::sqrt((i3 - i2) * main / (i1 * i2 * i3));
    const auto start = [&](std::size_t k) { return body.omega_body[axis_[k]]; };
    amplitude_[0] = std::sqrt(std::max(wobble / (i1 * (i3 - i1)), 0.0));
    amplitude_[2] = std::copysign(std::sqrt(main / (i3 * (i3 - i1))), start(2));
    // Euler's second equation, I2 omega2' = (I3 - I1) omega3
    // omega1 up to the handedness of the order, gives the sense.
    const double handed = (axis_[1] - axis_[0] + 3) % 3 == 1 ? 1.0 : -1.0;
    const double direction = handed * (i3 > i1 ? 1.0 : -1.0) * std::copysign(1.0, amplitude_[2]);
    amplitude_[1] = direction * std::sqrt(std::max(wobble / (i2 * (i3 - i2)), 0.0));
    if (amplitude_[0] > 0.0) {
      const double angle = std::atan2(start(1) / amplitude_[1], start(0) / amplitude_[0]);
      phase_ = std::ellint_1(std::sqrt(parameter_), angle);
    }
  }

  [[nodiscard]] Vector3d omega(double t) const {
    const JacobiFunctions f = jacobi(rate_ * t + phase_, parameter_);
    Vector3d result;
    result[axis_[0]] = amplitude_[0] * f.cn;
    result[axis_[1]] = amplitude_[1] * f.sn;
    result[axis_[2]] = amplitude_[2] * f.dn;
    return result;
  }

  [[nodiscard]] double rate() const { return rate_; }
  /// A body axis that L keeps well away from: the nodes of L and this axis are always defined.
  [[nodiscard]] int figure_axis() const { return axis_[0]; }

 private:
  std::array<int, 3> axis_{};
  std::array<double, 3> amplitude_{};
  double parameter_ = 0.0, rate_ = 0.0, phase_ = 0.0;
};

/// Columns: the node line f x l, l x (f x l), l, in body axes; l is the direction of L.
Matrix3d node_frame(const Vector3d& momentum, int figure_axis) {
  const Vector3d l = momentum.normalized();
  const Vector3d node = Vector3d::Unit(figure_axis).cross(l).normalized();
  Matrix3d frame;
  frame << node, l.cross(node), l;
  return frame;
}

}  // namespace

JacobiFunctions jacobi(double u, double m) {
  require(m >= 0.0 && m < 1.0, "m", m, "in [0, 1)");
  // Abramowitz & Stegun 16.4: a, c of the mean, then the amplitude from phi_n = 2^n a_n u down.
  constexpr std::size_t most = 24;
  std::array<double, most> a{}, c{};
  a[0] = 1.0;
  c[0] = std::sqrt(m);
  double b = std::sqrt(1.0 - m);
  std::size_t n = 0;
  while (n + 1 < most && c[n] > 1e-17) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] * std::sin(phi) / a[n]));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1.0 - m * sn * sn)};
}

Vector3d FreeRotation::box_inertia(double mass, const Vector3d& edges) {
  const Vector3d squares = edges.cwiseAbs2();
  return (mass / 12.0) * (Vector3d::Constant(squares.sum()) - squares);
}

std::vector<FreeRotationState> rotate_freely(const FreeRotation& body, const std::vector<double>& times) {
  require(body.inertia.minCoeff() > 0.0, "least of inertia", body.inertia.minCoeff(), "> 0");
  require(body.inertia[0] != body.inertia[1] && body.inertia[1] != body.inertia[2] &&
              body.inertia[0] != body.inertia[2],
          "moments of inertia must differ");
  require(body.omega_body.norm() > 0.0, "omega must not be zero");
  require_increasing(times);
  const EulerTop top(body);
  const Vector3d start_momentum = body.inertia.cwiseProduct(body.omega_body);
  const double length = start_momentum.norm();
  const double t2 = start_momentum.dot(body.omega_body);
  const int f = top.figure_axis();
  const auto precession = [&](double t) {
    const double omega_f = top.omega(t)[f];
    const double l_f = body.inertia[f] * omega_f;
    return length * (t2 - l_f * omega_f) / (length * length - l_f * l_f);
  };
  const Matrix3d to_world = body.orientation.normalized().toRotationMatrix() *
                            node_frame(start_momentum, f);  // L's frame, nodes at t = 0
  std::vector<FreeRotationState> states;
  double now = 0.0;
  double turned = 0.0;
  for (const double t : times) {
    turned += quadrature(precession, now, t, 1 + static_cast<int>(2.0 * top.rate() * (t - now)));
    now = t;
    FreeRotationState state{t, top.omega(t), {}, {}};
    const Matrix3d nodes = Eigen::AngleAxisd(turned, Vector3d::UnitZ()).toRotationMatrix();
    const Matrix3d frame = node_frame(body.inertia.cwiseProduct(state.omega_body), f);
    state.orientation = Quaterniond(to_world * nodes * frame.transpose()).normalized();
    state.omega = state.orientation * state.omega_body;
    states.push_back(state);
  }
  return states;
}

EulerDisc EulerDisc::uniform(double mass, double radius, double half_height) {
  EulerDisc disc;
  disc.mass = mass, disc.radius = radius, disc.half_height = half_height;
  disc.transverse = mass * (3.0 * radius * radius + 4.0 * half_height * half_height) / 12.0;
  disc.axial = 0.5 * mass * radius * radius;
  return disc;
}

double EulerDisc::precession(double alpha) const {
  const double s = std::sin(alpha), c = std::cos(alpha);
  const double gyroscopic = transverse * s * c - axial * s * s * half_height / radius;
  const double moment = mass * gravity * (radius * c - half_height * s);
  if (!(moment / gyroscopic > 0.0)) throw std::domain_error("Euler's disc: no steady motion at this angle");
  return std::sqrt(moment / gyroscopic);
}

Vector3d EulerDisc::omega(double alpha) const {
  return precession(alpha) * std::sin(alpha) * Vector3d(1.0, half_height / radius, 0.0);
}

double EulerDisc::center_height(double alpha) const {
  return radius * std::sin(alpha) + half_height * std::cos(alpha);
}

double jellett_constant(double inertia_axial, double inertia_transverse, double foot_radius, double offset,
                        const Vector3d& axis, const Vector3d& omega) {
  const double omega_axial = axis.dot(omega);
  const Vector3d momentum =
      inertia_transverse * (omega - omega_axial * axis) + inertia_axial * omega_axial * axis;
  return foot_radius * momentum.z() - offset * inertia_axial * omega_axial;
}

}  // namespace touchstone::truth
