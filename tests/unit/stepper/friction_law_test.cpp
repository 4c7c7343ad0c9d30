// The friction rows that solvers see: the smoothed ones against differences and against what they smooth.
#include "core/stepper/friction_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace touchstone {
namespace {

constexpr double kMu = 0.4;
constexpr double kRho = 1.0 / 3;
const FrictionVector<3> kActive = FrictionVector<3>::Ones();

FrictionRows<3> smoothed(const FrictionVector<3>& y, const FrictionVector<3>& w, double p, double tau) {
  return friction_rows<3>(FrictionForm::projection, kMu, kRho, kActive, y, w, p, w.norm(), tau);
}

/// What a contact may be in: open, without load, loaded; stuck, at the limit, slipping.
struct State {
  FrictionVector<3> y, w;
  double p;
};

std::vector<State> states() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto direction = [&] {
    return FrictionVector<3>(unit(random), unit(random), unit(random)).normalized();
  };
  std::vector<State> all;
  for (const double p : {-0.3, 0.0, 1e-3, 1.0}) {
    const double limit = kMu * std::max(p, 0.0);
    for (const double load : {0.0, 0.5, 1.0, 1.5}) {
      for (const double speed : {0.0, 1e-3, 1.0})
        all.push_back({load * limit * direction(), speed * direction(), p});
    }
  }
  return all;
}

TEST(SmoothedFriction, DerivativesAreThoseOfCentralDifferences) {
  constexpr double kStep = 1e-6;
  for (const double tau : {0.3, 0.03}) {
    for (const State& at : states()) {
      const FrictionRows<3> rows = smoothed(at.y, at.w, at.p, tau);
      // Third derivatives are at most of the order of 1 / tau^2.
      const double allowed = 10 * kStep * kStep / (tau * tau) + 1e-9;
      for (int i = 0; i < 3; ++i) {
        const FrictionVector<3> change = kStep * FrictionVector<3>::Unit(i);
        const FrictionVector<3> by_y = (smoothed(at.y + change, at.w, at.p, tau).value -
                                        smoothed(at.y - change, at.w, at.p, tau).value) /
                                       (2 * kStep);
        const FrictionVector<3> by_w = (smoothed(at.y, at.w + change, at.p, tau).value -
                                        smoothed(at.y, at.w - change, at.p, tau).value) /
                                       (2 * kStep);
        EXPECT_LE((rows.d_y.col(i) - by_y).norm(), allowed) << "tau " << tau << ", p " << at.p;
        EXPECT_LE((rows.d_w.col(i) - by_w).norm(), allowed) << "tau " << tau << ", p " << at.p;
      }
      const FrictionVector<3> by_p =
          (smoothed(at.y, at.w, at.p + kStep, tau).value - smoothed(at.y, at.w, at.p - kStep, tau).value) /
          (2 * kStep);
      EXPECT_LE((rows.d_p - by_p).norm(), allowed) << "tau " << tau << ", p " << at.p;
    }
  }
}

// The radius is too large by at most mu tau, at p = 0, and what is projected misses a ball by at most tau /
// 2, at its surface.
TEST(SmoothedFriction, MissesTheLawByNoMoreThanTheSmoothing) {
  for (const double tau : {0.1, 1e-3, 1e-6, 1e-12}) {
    for (const State& at : states()) {
      const FrictionVector<3> miss =
          smoothed(at.y, at.w, at.p, tau).value - smoothed(at.y, at.w, at.p, 0).value;
      // Where the ball is a point and d is not in it the law's own row is y; inside it is rho w, so that both
      // are y - proj(d).
      EXPECT_LE(miss.norm(), (kMu + 0.5) * tau * (1 + 1e-9) + 1e-15) << "tau " << tau << ", p " << at.p;
    }
  }
}

// y = q (y - rho w) with 0 < q < 1: friction is opposite to slip, at whatever smoothing.
TEST(SmoothedFriction, OpposesSlip) {
  constexpr double kTau = 0.05;
  for (const State& at : states()) {
    // Its fixed point in y at given w and p by Picard's iteration, which contracts.
    FrictionVector<3> y = FrictionVector<3>::Zero();
    for (int k = 0; k < 20000; ++k) y -= smoothed(y, at.w, at.p, kTau).value;
    const FrictionVector<3> w = at.w;
    EXPECT_NEAR(y.dot(w), -y.norm() * w.norm(), 1e-9) << "p " << at.p;
  }
}

}  // namespace
}  // namespace touchstone
