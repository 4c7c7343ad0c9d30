// Is the rolling ellipsoid's nonholonomic motion right to 1e-11? Oracles: energy,
// the surfaces' own equations, Newton's and Euler's laws by differences of the
// trajectory, and closed forms for spheres and for planar rocking.
#include "experiments/scenarios/truths/ellipsoid_rolling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/scenarios/truths/gauss_legendre.h"

namespace touchstone::truth {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

std::vector<double> grid(double end, int intervals) {
  std::vector<double> times;
  for (int i = 0; i <= intervals; ++i) times.push_back(end * i / intervals);
  return times;
}

RollingEllipsoid triaxial_on_plane() {
  RollingEllipsoid scene;
  scene.mass = 2.0;
  scene.semi_axes = {1.0, 0.8, 0.6};
  scene.inertia = RollingEllipsoid::solid_inertia(2.0, scene.semi_axes);
  scene.orientation = Quaterniond(AngleAxisd(0.4, Vector3d(1.0, 2.0, -0.5).normalized()));
  scene.omega = {0.6, -0.4, 1.2};
  return scene;
}

RollingEllipsoid triaxial_on_triaxial() {
  RollingEllipsoid scene = triaxial_on_plane();
  scene.support =
      FixedEllipsoid{{0.3, -0.2, -4.0}, {5.0, 6.0, 4.0}, Quaterniond(AngleAxisd(0.3, Vector3d::UnitX()))};
  scene.normal = Vector3d(0.05, 0.1, 1.0).normalized();
  return scene;
}

RollingEllipsoid rattleback() {
  RollingEllipsoid scene;
  scene.semi_axes = {2.0, 0.5, 0.4};
  const Matrix3d turn = AngleAxisd(0.1, Vector3d::UnitZ()).toRotationMatrix();  // inertia askew to the shape
  scene.inertia = turn * Vector3d(0.1, 0.8, 0.85).asDiagonal() * turn.transpose();
  scene.omega = {0.05, 0.02, 2.0};
  return scene;
}

/// The same with its centre of mass off its middle, as in a real one.
RollingEllipsoid loaded_rattleback() {
  RollingEllipsoid scene = rattleback();
  scene.center = {0.02, -0.01, 0.15};
  return scene;
}

/// Value of the ellipsoid's equation, (p - c).D^-1 (p - c) - 1, and its outward normal at p.
struct SurfaceCheck {
  double value;
  Vector3d normal;
};
SurfaceCheck check(const Vector3d& center, const Quaterniond& q, const Vector3d& semi_axes,
                   const Vector3d& p) {
  const Matrix3d rotation = q.toRotationMatrix();
  const Matrix3d inverse =
      rotation * semi_axes.cwiseAbs2().cwiseInverse().asDiagonal() * rotation.transpose();
  const Vector3d gradient = inverse * (p - center);
  return {(p - center).dot(gradient) - 1.0, gradient.normalized()};
}

void expect_rolls(const RollingEllipsoid& scene, double end) {
  const EllipsoidResult result = roll_ellipsoid(scene, grid(end, 200));
  ASSERT_EQ(result.status, EllipsoidStatus::completed);
  ASSERT_EQ(result.samples.size(), 201u);
  for (const EllipsoidSample& s : result.samples) {
    EXPECT_NEAR(s.energy, result.samples.front().energy, 1e-11);
    EXPECT_LT((s.velocity + s.omega.cross(s.contact_point - s.position)).norm(), 1e-14);
    const SurfaceCheck own =
        check(s.position + s.orientation * scene.center, s.orientation, scene.semi_axes, s.contact_point);
    EXPECT_NEAR(own.value, 0.0, 1e-13);
    EXPECT_LT((own.normal + s.normal).norm(), 1e-12);
    if (scene.support) {
      const FixedEllipsoid& f = *scene.support;
      const SurfaceCheck other = check(f.center, f.orientation, f.semi_axes, s.contact_point);
      EXPECT_NEAR(other.value, 0.0, 1e-12) << s.t;
      EXPECT_LT((other.normal - s.normal).norm(), 1e-11);
    } else {
      EXPECT_NEAR(s.contact_point.z(), 0.0, 1e-12) << s.t;
    }
  }
}

TEST(EllipsoidRolling, KeepsEnergyContactAndRolling) {
  expect_rolls(triaxial_on_plane(), 5.0);
  expect_rolls(triaxial_on_triaxial(), 1.2);
  expect_rolls(rattleback(), 5.0);
  expect_rolls(loaded_rattleback(), 3.0);
}

void expect_newton_euler(const RollingEllipsoid& scene, double t) {
  const double h = 1e-3;
  const auto samples = roll_ellipsoid(scene, {t - 2 * h, t - h, t, t + h, t + 2 * h}).samples;
  ASSERT_EQ(samples.size(), 5u);
  const auto slope = [&](const auto& value) -> Vector3d {
    return (8.0 * (value(samples[3]) - value(samples[1])) - (value(samples[4]) - value(samples[0]))) /
           (12.0 * h);
  };
  const auto spin = [&](const EllipsoidSample& s) -> Vector3d {
    const Matrix3d rotation = s.orientation.toRotationMatrix();
    return rotation * scene.inertia * rotation.transpose() * s.omega;
  };
  const EllipsoidSample& now = samples[2];
  EXPECT_LT((slope([](const auto& s) -> Vector3d { return s.position; }) - now.velocity).norm(), 1e-8);
  const Vector3d force = slope([&](const auto& s) -> Vector3d { return scene.mass * s.velocity; });
  EXPECT_LT((force - scene.mass * scene.gravity - now.force).norm(), 1e-7);
  EXPECT_LT((slope(spin) - (now.contact_point - now.position).cross(now.force)).norm(), 1e-7);
}

TEST(EllipsoidRolling, ObeysNewtonAndEuler) {
  for (const double t : {0.3, 0.9}) {
    expect_newton_euler(triaxial_on_plane(), t);
    expect_newton_euler(triaxial_on_triaxial(), t);
    expect_newton_euler(rattleback(), t);
    expect_newton_euler(loaded_rattleback(), t);
  }
}

TEST(EllipsoidRolling, ContactPointMovesAlikeOnBothBodies) {
  // The contact's path on the plane and in the body have the
  // same speed: rolling, seen without the equations of motion.
  const double h = 1e-4;
  const RollingEllipsoid scene = triaxial_on_plane();
  const auto s = roll_ellipsoid(scene, {0.7 - h, 0.7, 0.7 + h}).samples;
  const auto in_body = [](const EllipsoidSample& e) -> Vector3d {
    return e.orientation.inverse() * (e.contact_point - e.position);
  };
  const Vector3d on_plane = (s[2].contact_point - s[0].contact_point) / (2 * h);
  const Vector3d on_body = s[1].orientation * ((in_body(s[2]) - in_body(s[0])) / (2 * h));
  EXPECT_GT(on_plane.norm(), 0.1);
  EXPECT_LT((on_plane - on_body).norm(), 1e-6);
}

TEST(EllipsoidRolling, SphereOnInclineFallsWithFiveSeventhsOfGravity) {
  const double slope = 0.3;
  RollingEllipsoid ball;
  ball.gravity = 9.81 * Vector3d(std::sin(slope), 0.0, -std::cos(slope));
  const auto samples = roll_ellipsoid(ball, {1.5}).samples;
  const double acceleration = 5.0 / 7.0 * 9.81 * std::sin(slope);
  EXPECT_NEAR(samples[0].position.x(), 0.5 * acceleration * 2.25, 1e-12);
  EXPECT_NEAR(samples[0].velocity.x(), acceleration * 1.5, 1e-12);
  EXPECT_NEAR(samples[0].needed_friction(), 2.0 / 7.0 * std::tan(slope), 1e-13);
}

TEST(EllipsoidRolling, SphereLeavesSphereWhereTheClosedFormSays) {
  // From rest at theta0: v^2 = (10/7) g (R + r)(cos theta0 - cos
  // theta), and N = 0 at cos theta = (10/17) cos theta0.
  const double theta0 = 0.2;
  RollingEllipsoid ball;
  ball.support = FixedEllipsoid{{0.0, 0.0, 0.0}, Vector3d::Constant(3.0), Quaterniond::Identity()};
  ball.normal = {std::sin(theta0), 0.0, std::cos(theta0)};
  const EllipsoidResult result = roll_ellipsoid(ball, grid(10.0, 10000));
  ASSERT_EQ(result.status, EllipsoidStatus::lifts_off);
  const EllipsoidSample& last = result.samples.back();
  EXPECT_NEAR(std::cos(theta0) * 10.0 / 17.0, last.normal.z(), 2e-3);  // up to 1 ms before the end
  for (const EllipsoidSample& s : result.samples) {
    const double c = s.position.z() / 4.0;
    EXPECT_NEAR(s.velocity.squaredNorm(), 10.0 / 7.0 * 9.81 * 4.0 * (std::cos(theta0) - c), 1e-11);
    EXPECT_NEAR(s.normal_force(), 9.81 * (17.0 / 7.0 * c - 10.0 / 7.0 * std::cos(theta0)), 1e-11);
  }
  // Time of flight down to the lift-off, by quadrature of the energy integral with theta = theta0 + u^2.
  const double end = std::acos(std::cos(theta0) * 10.0 / 17.0);
  const auto slowness = [&](double u) {
    const double drop = std::cos(theta0) - std::cos(theta0 + u * u);
    return 2.0 * u * 4.0 / std::sqrt(10.0 / 7.0 * 9.81 * 4.0 * drop);
  };
  EXPECT_NEAR(result.end, quadrature(slowness, 0.0, std::sqrt(end - theta0), 8), 1e-11);
}

TEST(EllipsoidRolling, PlanarRockingFollowsItsEnergyIntegral) {
  // phi'^2 = 2 m g (H(phi0) - H(phi)) / (I + m (H^2 + H'^2)), H^2 = a^2 sin^2 + b^2 cos^2; turning about y.
  RollingEllipsoid scene;
  scene.semi_axes = {1.5, 1.0, 0.7};
  scene.inertia = RollingEllipsoid::solid_inertia(1.0, scene.semi_axes);
  const double phi0 = 0.5;
  scene.orientation = Quaterniond(AngleAxisd(phi0, Vector3d::UnitY()));
  for (const EllipsoidSample& s : roll_ellipsoid(scene, grid(6.0, 120)).samples) {
    const Matrix3d rotation = s.orientation.toRotationMatrix();
    const double phi = std::atan2(-rotation(2, 0), rotation(0, 0));
    const auto height = [](double p) { return std::hypot(1.5 * std::sin(p), 0.7 * std::cos(p)); };
    const double h = height(phi);
    const double slope = (1.5 * 1.5 - 0.7 * 0.7) * std::sin(phi) * std::cos(phi) / h;
    const double expected = 2.0 * 9.81 * (height(phi0) - h) / (scene.inertia(1, 1) + h * h + slope * slope);
    EXPECT_NEAR(s.omega.y() * s.omega.y(), expected, 1e-11) << s.t;
    EXPECT_NEAR(s.position.z(), h, 1e-12);
  }
}

TEST(EllipsoidRolling, HugeSupportIsThePlane) {
  const RollingEllipsoid plane = triaxial_on_plane();
  const Vector3d on_plane = roll_ellipsoid(plane, {1.0}).samples[0].position;
  double previous = std::numeric_limits<double>::infinity();
  for (const double radius : {1e3, 1e4, 1e5}) {
    RollingEllipsoid curved = plane;
    curved.support = FixedEllipsoid{{0.0, 0.0, -radius}, Vector3d::Constant(radius), Quaterniond::Identity()};
    const double distance = (roll_ellipsoid(curved, {1.0}).samples[0].position - on_plane).norm();
    EXPECT_LT(distance, 5.0 / radius);
    EXPECT_LT(distance, 0.2 * previous);
    previous = distance;
  }
}

TEST(EllipsoidRolling, RattlebackReversesOneSenseSoonAndNotTheOther) {
  RollingEllipsoid scene = rattleback();
  std::array<double, 2> least{};
  for (int sense = 0; sense < 2; ++sense) {
    scene.omega.z() = sense == 0 ? 2.0 : -2.0;
    least[static_cast<std::size_t>(sense)] = 1.0;
    for (const EllipsoidSample& s : roll_ellipsoid(scene, grid(20.0, 400)).samples) {
      double& lowest = least[static_cast<std::size_t>(sense)];
      lowest = std::min(lowest, s.omega.z() / scene.omega.z());
    }
  }
  EXPECT_LT(std::min(least[0], least[1]), -0.1);  // one sense turns round
  EXPECT_GT(std::max(least[0], least[1]), 0.3);   // the other keeps its own
}

TEST(EllipsoidRolling, ToleranceRefinementChangesNothing) {
  const std::vector<double> times = grid(5.0, 10);
  const auto loose = roll_ellipsoid(triaxial_on_plane(), times, 1e-13).samples;
  const auto tight = roll_ellipsoid(triaxial_on_plane(), times, 1e-14).samples;
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_LT((loose[i].position - tight[i].position).norm(), 1e-12);
    EXPECT_LT(loose[i].orientation.angularDistance(tight[i].orientation), 1e-7);  // acos near 1
    EXPECT_LT((loose[i].omega - tight[i].omega).norm(), 1e-12);
  }
}

TEST(EllipsoidRolling, RefusesBadInput) {
  const auto with = [](auto change) {
    RollingEllipsoid scene;
    change(scene);
    return scene;
  };
  EXPECT_THROW(roll_ellipsoid(with([](auto& s) { s.mass = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_ellipsoid(with([](auto& s) { s.semi_axes.y() = 0.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_ellipsoid(with([](auto& s) { s.inertia(0, 0) = -1.0; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_ellipsoid(with([](auto& s) { s.inertia(0, 1) = 0.1; }), {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_ellipsoid(with([](auto& s) {
                                s.normal = {0.1, 0.0, 1.0};
                              }),
                              {1.0}),
               std::invalid_argument);
  EXPECT_THROW(roll_ellipsoid({}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::truth
