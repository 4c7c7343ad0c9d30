#include "experiments/scenarios/truths/ellipsoid_rolling.h"

#include <algorithm>

#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Position, quaternion (x, y, z, w as Eigen stores it), normal, omega.
using State = OdeVector<13>;
enum { position_at = 0, quaternion_at = 3, normal_at = 7, omega_at = 10 };

/// An ellipsoid's support function at the normal n, with its first two derivatives.
struct Support {
  Vector3d point;  ///< D n / s: where the outward normal is n, from the centre
  Matrix3d k;      ///< K, the derivative of `point`: symmetric, K n = 0

  Support(const Matrix3d& rotation, const Vector3d& semi_axes, const Vector3d& n) {
    const Matrix3d d = rotation * semi_axes.cwiseAbs2().asDiagonal() * rotation.transpose();
    const double s = std::sqrt(n.dot(d * n));
    point = d * n / s;
    k = (d - point * point.transpose()) / s;
  }
};

class Rolling {
 public:
  explicit Rolling(const RollingEllipsoid& scene) : scene_(scene) {}

  /// Everything at one instant; the rates follow from the configuration and omega.
  struct Instant {
    Vector3d x, n, omega, r, v, n_rate, omega_rate, force;
    Quaterniond q;
  };

  [[nodiscard]] Instant at(const State& s) const {
    Instant i;
    i.x = s.segment<3>(position_at);
    i.q = Quaterniond(s.segment<4>(quaternion_at)).normalized();
    i.n = s.segment<3>(normal_at).normalized();
    i.omega = s.segment<3>(omega_at);
    const Matrix3d rotation = i.q.toRotationMatrix();
    // The contact's outward normal is -n, and the support
    // function is even: point(-n) = -point(n), K(-n) = K(n).
    const Support body(rotation, scene_.semi_axes, i.n);
    i.r = rotation * scene_.center - body.point;
    i.v = -i.omega.cross(i.r);
    i.n_rate = turning(body, i.n, i.omega);
    const Vector3d r_rate = i.omega.cross(i.r) - body.k * (i.n_rate - i.omega.cross(i.n));
    solve_accelerations(i, rotation * scene_.inertia * rotation.transpose(), r_rate);
    return i;
  }

  [[nodiscard]] State rate(const State& s) const {
    const Instant i = at(s);
    const Quaterniond turn = Quaterniond(0.0, i.omega.x(), i.omega.y(), i.omega.z()) * i.q;
    State result;
    result << i.v, 0.5 * turn.coeffs(), i.n_rate, i.omega_rate;
    return result;
  }

  [[nodiscard]] State start() const {
    const Vector3d n = scene_.normal.normalized();
    const Matrix3d rotation = scene_.orientation.normalized().toRotationMatrix();
    const Support body(rotation, scene_.semi_axes, n);
    Vector3d touching(scene_.contact.x(), scene_.contact.y(), 0.0);
    if (scene_.support) touching = scene_.support->center + support_at(n).point;
    State s;
    s << touching + body.point - rotation * scene_.center, scene_.orientation.normalized().coeffs(), n,
        scene_.omega;
    return s;
  }

  [[nodiscard]] EllipsoidSample sample(double t, const State& s) const {
    const Instant i = at(s);
    const Matrix3d rotation = i.q.toRotationMatrix();
    const Vector3d omega_body = rotation.transpose() * i.omega;
    EllipsoidSample result{t, i.x, i.v, i.omega, i.q, i.n, i.x + i.r, i.force, 0.0};
    result.energy = 0.5 * scene_.mass * i.v.squaredNorm() +
                    0.5 * omega_body.dot(scene_.inertia * omega_body) - scene_.mass * scene_.gravity.dot(i.x);
    return result;
  }

 private:
  [[nodiscard]] Support support_at(const Vector3d& n) const {
    return {scene_.support->orientation.normalized().toRotationMatrix(), scene_.support->semi_axes, n};
  }

  [[nodiscard]] Vector3d turning(const Support& body, const Vector3d& n, const Vector3d& omega) const {
    if (!scene_.support) return Vector3d::Zero();
    // Both K vanish along n; n n^T makes the matrix regular and keeps n' in the tangent plane.
    const Matrix3d matrix = body.k + support_at(n).k + n * n.transpose();
    return matrix.ldlt().solve(body.k * omega.cross(n));
  }

  void solve_accelerations(Instant& i, const Matrix3d& inertia, const Vector3d& r_rate) const {
    const Matrix3d about_contact =
        inertia + scene_.mass * (i.r.squaredNorm() * Matrix3d::Identity() - i.r * i.r.transpose());
    const Vector3d moment =
        -i.omega.cross(inertia * i.omega) - scene_.mass * i.r.cross(i.omega.cross(r_rate) + scene_.gravity);
    i.omega_rate = about_contact.ldlt().solve(moment);
    i.force = scene_.mass * (-i.omega_rate.cross(i.r) - i.omega.cross(r_rate) - scene_.gravity);
  }

  const RollingEllipsoid& scene_;
};

}  // namespace

Matrix3d RollingEllipsoid::solid_inertia(double mass, const Vector3d& semi_axes) {
  const Vector3d squares = semi_axes.cwiseAbs2();
  return (mass / 5.0) * (Vector3d::Constant(squares.sum()) - squares).asDiagonal();
}

void RollingEllipsoid::validate() const {
  require(mass > 0.0, "mass", mass, "> 0");
  require(semi_axes.minCoeff() > 0.0, "least of semi_axes", semi_axes.minCoeff(), "> 0");
  require((inertia - inertia.transpose()).norm() <= 1e-12 * inertia.norm(), "inertia must be symmetric");
  require(Eigen::LLT<Matrix3d>(inertia).info() == Eigen::Success, "inertia must be positive definite");
  if (support) {
    const double least = support->semi_axes.minCoeff();
    require(least > 0.0, "least of support.semi_axes", least, "> 0");
  }
  require(support || normal.normalized() == Vector3d::UnitZ(), "normal must be (0, 0, 1) on the plane");
  require(normal.norm() > 0.0, "normal must not be zero");
}

EllipsoidResult roll_ellipsoid(const RollingEllipsoid& scene, const std::vector<double>& times,
                               double tolerance) {
  scene.validate();
  require(!times.empty(), "times must be given");
  require_increasing(times);
  const Rolling rolling(scene);
  EllipsoidResult result;
  const auto field = [&](double, const State& s) { return rolling.rate(s); };
  const auto events = [&](double, const State& s) {
    const Rolling::Instant i = rolling.at(s);
    return std::array{i.force.dot(i.n)};
  };
  const auto observer = [&](const DenseStep<13>& step, double end) {
    while (result.samples.size() < times.size() && times[result.samples.size()] <= end) {
      const double t = times[result.samples.size()];
      result.samples.push_back(rolling.sample(t, step(t)));
    }
  };
  const double end = std::max(times.back(), std::numeric_limits<double>::min());
  const auto at =
      integrate<13, 1>(field, 0.0, rolling.start(), end, events, {true}, observer, {.tolerance = tolerance});
  result.end = at.t;
  if (at.status == OdeStatus::event) {
    result.status = EllipsoidStatus::lifts_off;
  } else if (at.status != OdeStatus::reached_end) {
    result.status = EllipsoidStatus::integration_failed;
  }
  return result;
}

}  // namespace touchstone::truth
