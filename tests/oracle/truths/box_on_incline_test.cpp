// The release of a block on an incline against thresholds in closed form, the unilateral problem of its two
// corners solved by enumeration, and energy.

#include "experiments/scenarios/truths/box_on_incline.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <stdexcept>

namespace touchstone::truth {
namespace {

using Start = BlockOnIncline::Start;

template <class Check>
void for_many_blocks(const Check& check) {
  // No two of tan, mu and b/h are equal, so that nothing here is a tie.
  for (const double aspect : {0.31, 0.62, 1.03, 2.04}) {
    for (double tangent = 0.015; tangent < 2.5; tangent += 0.0496) {
      for (double mu = 0.008; mu < 2.5; mu += 0.0711) {
        check(
            BlockOnIncline{.base = 0.7 * aspect, .height = 0.7, .friction = mu, .theta = std::atan(tangent)});
      }
    }
  }
}

TEST(BoxOnIncline, OneModeIsConsistentAndItIsThatOfTheClosedThresholds) {
  int counts[4] = {};
  for_many_blocks([&](const BlockOnIncline& block) {
    const BlockRelease r = release(block);
    ASSERT_EQ(r.consistent_modes, 1);
    ASSERT_EQ(r.mode, block.start()) << "tan " << std::tan(block.theta) << " mu " << block.friction << " b/h "
                                     << block.base / block.height;
    ++counts[static_cast<int>(r.mode)];
  });
  for (const int count : counts) EXPECT_GT(count, 100) << "every mode is met";
}

TEST(BoxOnIncline, SlidesAtTheClosedFormAndTipsAboutItsEdgeAsAPendulumDoes) {
  for_many_blocks([](const BlockOnIncline& block) {
    const BlockRelease r = release(block);
    if (r.mode == Start::slides) {
      ASSERT_NEAR(r.edge_along, block.sliding_acceleration(), 1e-12);
      ASSERT_NEAR(r.pressure_at, block.friction * block.height / 2, 1e-12);
    }
    if (r.mode == Start::tips) {
      const double b = block.base;
      const double h = block.height;
      const double lever = h * std::sin(block.theta) - b * std::cos(block.theta);
      ASSERT_NEAR(r.angular, 1.5 * block.gravity * lever / (b * b + h * h), 1e-11);
    }
  });
}

/// Signorini's and Coulomb's laws at both corners, with accelerations, tried in every combination of
/// {open, stick, slip down, slip up} for each: another formulation with four force components.
struct Corners {
  double angular = 0;
  double lower_along = 0;
  int solutions = 0;
};

Corners enumerate_corners(const BlockOnIncline& block) {
  const double b = block.base;
  const double h = block.height;
  const double inertia = (b * b + h * h) / 12;
  Corners found;
  for (int mode = 0; mode < 16; ++mode) {
    const int modes[2] = {mode % 4, mode / 4};
    // Unknown: a_s, a_n, alpha, then tangential and normal force of the upper and of the lower corner.
    Eigen::Matrix<double, 7, 7> m = Eigen::Matrix<double, 7, 7>::Zero();
    Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
    m(0, 0) = 1, m(1, 1) = 1, m(2, 2) = inertia;
    right[0] = block.gravity * std::sin(block.theta);
    right[1] = -block.gravity * std::cos(block.theta);
    Eigen::Matrix<double, 2, 7> along = Eigen::Matrix<double, 2, 7>::Zero();
    Eigen::Matrix<double, 2, 7> off = Eigen::Matrix<double, 2, 7>::Zero();
    for (int c = 0; c < 2; ++c) {
      const double x = c == 0 ? -b / 2 : b / 2;
      const int t = 3 + 2 * c;
      const int n = t + 1;
      m(0, t) = -1, m(1, n) = -1;
      m(2, t) = h / 2, m(2, n) = x;  // clockwise moment of (f_s, f_n) at (x, -h/2): -(h/2) f_s - x f_n
      along(c, 0) = 1, along(c, 2) = -h / 2;
      off(c, 1) = 1, off(c, 2) = -x;
      const int row = t;
      if (modes[c] == 0) {
        m(row, t) = 1, m(row + 1, n) = 1;
        continue;
      }
      m.row(row + 1) = off.row(c);
      if (modes[c] == 1) {
        m.row(row) = along.row(c);
      } else {
        m(row, t) = 1, m(row, n) = modes[c] == 2 ? block.friction : -block.friction;
      }
    }
    const Eigen::FullPivLU<Eigen::Matrix<double, 7, 7>> lu(m);
    if (!lu.isInvertible()) continue;  // both corners stick: how they share friction is not determined
    const Eigen::Matrix<double, 7, 1> z = lu.solve(right);
    bool good = true;
    constexpr double kRounding = 1e-11;
    for (int c = 0; c < 2; ++c) {
      const double force_t = z[3 + 2 * c];
      const double force_n = z[4 + 2 * c];
      const double slip = along.row(c).dot(z);
      if (modes[c] == 0) good = good && off.row(c).dot(z) >= -kRounding;
      if (modes[c] != 0) good = good && force_n >= -kRounding;
      if (modes[c] == 1) good = good && std::abs(force_t) <= block.friction * force_n + kRounding;
      if (modes[c] == 2) good = good && slip >= -kRounding;
      if (modes[c] == 3) good = good && slip <= kRounding;
    }
    if (!good) continue;
    if (found.solutions > 0) {
      EXPECT_NEAR(found.angular, z[2], 1e-9);
      EXPECT_NEAR(found.lower_along, along.row(1).dot(z), 1e-9);
    }
    ++found.solutions;
    found.angular = z[2];
    found.lower_along = along.row(1).dot(z);
  }
  return found;
}

TEST(BoxOnIncline, AgreesWithCoulombsLawAtBothCorners) {
  int compared = 0;
  for_many_blocks([&](const BlockOnIncline& block) {
    const BlockRelease r = release(block);
    const Corners corners = enumerate_corners(block);
    if (r.mode == Start::rests) {
      // At rest both corners may stick, which the enumeration leaves out; what it finds must be rest too.
      if (corners.solutions > 0) {
        ASSERT_NEAR(corners.lower_along, 0, 1e-10);
      }
      return;
    }
    ASSERT_GE(corners.solutions, 1);
    ASSERT_NEAR(corners.angular, r.angular, 1e-10);
    ASSERT_NEAR(corners.lower_along, r.edge_along, 1e-10);
    ++compared;
  });
  EXPECT_GT(compared, 2000);
}

TEST(BoxOnIncline, FrictionsPowerAndGravitysAreTheRateOfTheEnergy) {
  // From rest the energies grow as t^2/2 times these: T'' = a.a + J alpha^2 = g.a + f.a_edge.
  for_many_blocks([](const BlockOnIncline& block) {
    const BlockRelease r = release(block);
    const double inertia = (block.base * block.base + block.height * block.height) / 12;
    const double kinetic =
        r.center_along * r.center_along + r.center_off * r.center_off + inertia * r.angular * r.angular;
    const double gravity =
        block.gravity * (std::sin(block.theta) * r.center_along - std::cos(block.theta) * r.center_off);
    ASSERT_NEAR(kinetic, gravity - r.friction * r.edge_along, 1e-11);
  });
}

TEST(BoxOnIncline, RefusesWhatMakesNoSense) {
  EXPECT_THROW(release({.base = 0}), std::invalid_argument);
  EXPECT_THROW(release({.height = -1}), std::invalid_argument);
  EXPECT_THROW(release({.friction = -0.1}), std::invalid_argument);
  EXPECT_THROW(release({.theta = 1.6}), std::invalid_argument);
  EXPECT_THROW(release({.gravity = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::truth
