// Are the closed forms of spinning bodies right? Oracles: Euler's equations and the rolling disc's
// equations integrated, conserved angular momentum, and any contact force whatever for Jellett's constant.
#include "experiments/scenarios/truths/gyroscopes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "experiments/scenarios/truths/ode.h"

namespace touchstone::truth {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(Jacobi, SolvesItsOwnEquations) {
  const auto field = [](double, const OdeVector<3>& y) -> OdeVector<3> {
    return {y[1] * y[2], -y[0] * y[2], -0.83 * y[0] * y[1]};
  };
  for (const double u : {0.3, 2.0, 7.0, 25.0}) {
    const OdeVector<3> y = integrate<3>(field, 0.0, {0.0, 1.0, 1.0}, u);
    const JacobiFunctions f = jacobi(u, 0.83);
    EXPECT_LT((OdeVector<3>(f.sn, f.cn, f.dn) - y).norm(), 2e-13) << u;
    EXPECT_NEAR(jacobi(-u, 0.83).sn, -f.sn, 1e-15);
  }
  EXPECT_NEAR(jacobi(0.7, 0.0).sn, std::sin(0.7), 1e-16);
  EXPECT_NEAR(jacobi(0.7, 1.0 - 1e-13).sn, std::tanh(0.7), 1e-12);
  EXPECT_NEAR(jacobi(std::comp_ellint_1(0.6), 0.36).cn, 0.0, 1e-15);
  EXPECT_THROW(jacobi(1.0, 1.0), std::invalid_argument);
}

/// Euler's equations and the quaternion's, body axes.
OdeVector<7> integrated_rotation(const FreeRotation& body, double t) {
  const Vector3d i = body.inertia;
  const auto field = [&](double, const OdeVector<7>& y) -> OdeVector<7> {
    const Vector3d w = y.head<3>();
    OdeVector<7> rate;
    const Quaterniond turn = Quaterniond(y.tail<4>()) * Quaterniond(0.0, w.x(), w.y(), w.z());
    rate << -w.cross(i.cwiseProduct(w)).cwiseQuotient(i), 0.5 * turn.coeffs();
    return rate;
  };
  OdeVector<7> start;
  start << body.omega_body, body.orientation.coeffs();
  return integrate<7>(field, 0.0, start, t);
}

TEST(FreeRotation, AgreesWithEulersEquationsInEveryOrderAndRegime) {
  const Quaterniond tilted(Eigen::AngleAxisd(0.7, Vector3d(1.0, -2.0, 0.5).normalized()));
  std::array<double, 3> moments{1.4, 6.8, 8.1};
  do {
    for (const Vector3d& omega :
         {Vector3d(1.0, 0.2, 0.3), Vector3d(-0.1, 1.0, 0.1), Vector3d(0.2, -0.3, -1.0),
          Vector3d(0.01, 1.0, 0.0), Vector3d(0.5, -0.5, 0.6)}) {
      const FreeRotation body{Vector3d(moments[0], moments[1], moments[2]), omega, tilted};
      const FreeRotationState state = rotate_freely(body, {3.0, 20.0}).back();
      const OdeVector<7> y = integrated_rotation(body, 20.0);
      // Close to the separatrix an error of phase grows e-fold in about a second, in either computation.
      EXPECT_LT((state.omega_body - y.head<3>()).norm(), 1e-11);
      const Matrix3d difference =
          state.orientation.toRotationMatrix() - Quaterniond(y.tail<4>()).normalized().toRotationMatrix();
      EXPECT_LT(difference.norm(), 2e-11);
    }
  } while (std::next_permutation(moments.begin(), moments.end()));
}

TEST(FreeRotation, BoxKeepsMomentumAndEnergyWhileItTumbles) {
  FreeRotation box;
  EXPECT_LT((FreeRotation::box_inertia(1.0, {1.0, 4.0, 9.0}) - box.inertia).norm(), 1e-14);
  box.omega_body = {0.01, 1.0, 0.01};  // about the middle axis: flips over and over
  std::vector<double> times;
  for (int i = 0; i <= 500; ++i) times.push_back(0.2 * i);
  const auto states = rotate_freely(box, times);
  const Vector3d momentum = box.inertia.cwiseProduct(box.omega_body);
  bool flipped = false;
  for (const FreeRotationState& s : states) {
    EXPECT_LT((s.orientation * box.inertia.cwiseProduct(s.omega_body) - momentum).norm(), 1e-12);
    EXPECT_NEAR(s.omega_body.dot(box.inertia.cwiseProduct(s.omega_body)), momentum.dot(box.omega_body),
                1e-12);
    flipped = flipped || s.omega_body.y() < -0.9;
  }
  EXPECT_TRUE(flipped);
}

TEST(FreeRotation, PermanentRotationAndRefusals) {
  FreeRotation box;
  for (const int axis : {0, 2}) {
    box.omega_body = 2.0 * Vector3d::Unit(axis);
    const FreeRotationState s = rotate_freely(box, {1.0}).back();
    EXPECT_LT((s.omega_body - box.omega_body).norm(), 1e-14);
    const Matrix3d expected = Eigen::AngleAxisd(2.0, Vector3d::Unit(axis)).toRotationMatrix();
    EXPECT_LT((s.orientation.toRotationMatrix() - expected).norm(), 1e-13);
  }
  box.omega_body = Vector3d::UnitY();  // the unstable axis is the separatrix itself
  EXPECT_THROW(rotate_freely(box, {1.0}), std::invalid_argument);
  box.omega_body = Vector3d::Zero();
  EXPECT_THROW(rotate_freely(box, {1.0}), std::invalid_argument);
  EXPECT_THROW(rotate_freely({Vector3d(1.0, 1.0, 2.0)}, {1.0}), std::invalid_argument);
  EXPECT_THROW(rotate_freely({}, {1.0, 0.5}), std::invalid_argument);
}

/// The disc that rolls without slip on its rim: e3 and omega. The contact is r = -(a
/// u + d e3) from the centre, with u the steepest direction in the disc's plane.
OdeVector<9> rolling_disc_rate(const EulerDisc& disc, const OdeVector<9>& y) {
  const Vector3d e3 = y.segment<3>(3), omega = y.tail<3>();
  const auto contact = [&](const Vector3d& axis) -> Vector3d {
    const Vector3d up = (Vector3d::UnitZ() - axis * axis.z()).normalized();
    return -(disc.radius * up + disc.half_height * axis);
  };
  const Vector3d r = contact(e3), turn = omega.cross(e3);
  const double h = 1e-3;  // sixth-order difference along the motion of the axis
  const auto pair = [&](int k) -> Vector3d {
    return contact((e3 + k * h * turn).normalized()) - contact((e3 - k * h * turn).normalized());
  };
  const Vector3d r_rate = (45.0 * pair(1) - 9.0 * pair(2) + pair(3)) / (60.0 * h);
  const Matrix3d inertia =
      disc.transverse * Matrix3d::Identity() + (disc.axial - disc.transverse) * e3 * e3.transpose();
  const Vector3d gravity(0.0, 0.0, -disc.gravity);
  const Matrix3d about = inertia + disc.mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  const Vector3d moment = -omega.cross(inertia * omega) - disc.mass * r.cross(omega.cross(r_rate) + gravity);
  OdeVector<9> rate;
  rate << -omega.cross(r), turn, about.ldlt().solve(moment);
  return rate;
}

TEST(EulerDisc, SteadyMotionSolvesTheRollingDisc) {
  for (const double half_height : {0.0, 0.1}) {
    for (const double alpha : {0.2, 0.7}) {
      const EulerDisc disc = EulerDisc::uniform(1.3, 0.8, half_height);
      const Vector3d u(std::cos(alpha), 0.0, std::sin(alpha)), e3(-std::sin(alpha), 0.0, std::cos(alpha));
      const Vector3d w = disc.omega(alpha);
      OdeVector<9> start;
      start << 0.0, 0.0, disc.center_height(alpha), e3, w[0] * u + w[1] * e3 + w[2] * e3.cross(u);
      const double quarter = 0.5 * std::numbers::pi / disc.precession(alpha);
      const auto field = [&](double, const OdeVector<9>& y) { return rolling_disc_rate(disc, y); };
      const OdeVector<9> end = integrate<9>(field, 0.0, start, quarter, {.tolerance = 1e-11});
      EXPECT_LT((end.head<3>() - start.head<3>()).norm(), 1e-8);  // the centre stays
      EXPECT_LT((end.segment<3>(3) - Vector3d(0.0, -std::sin(alpha), std::cos(alpha))).norm(), 1e-7);
    }
  }
}

TEST(EulerDisc, ThinDiscLawAndRefusal) {
  const EulerDisc disc = EulerDisc::uniform(2.0, 0.5, 0.0);
  const double omega = disc.precession(0.3);
  EXPECT_NEAR(omega * omega * std::sin(0.3), 4.0 * 9.81 / 0.5, 1e-12);
  const EulerDisc coin = EulerDisc::uniform(1.0, 1.0, 1.0);
  EXPECT_THROW((void)coin.precession(0.8), std::domain_error);
}

TEST(Jellett, IsKeptUnderAnyForceAtTheContact) {
  // Only Euler's law with a made-up contact force: L' = r x F(t).
  const double axial = 0.5, transverse = 0.45, radius = 1.0, offset = 0.3;
  using State = OdeVector<6>;  // axis, omega
  const auto field = [&](double t, const State& y) -> State {
    const Vector3d axis = y.head<3>(), omega = y.tail<3>();
    const Matrix3d inertia =
        transverse * Matrix3d::Identity() + (axial - transverse) * axis * axis.transpose();
    const Vector3d r = offset * axis - radius * Vector3d::UnitZ();
    const Vector3d force(std::sin(3.0 * t), 1.5 * std::cos(t), 4.0 + std::sin(2.0 * t));
    State rate;
    rate << omega.cross(axis), inertia.ldlt().solve(r.cross(force) - omega.cross(inertia * omega));
    return rate;
  };
  State start;
  start << Vector3d(0.1, 0.0, 1.0).normalized(), 0.2, -0.1, 15.0;
  const State end = integrate<6>(field, 0.0, start, 3.0);
  const auto constant = [&](const State& y) {
    return jellett_constant(axial, transverse, radius, offset, y.head<3>(), y.tail<3>());
  };
  EXPECT_NEAR(constant(end), constant(start), 1e-12);
  EXPECT_GT((end - start).norm(), 0.5);
}

}  // namespace
}  // namespace touchstone::truth
