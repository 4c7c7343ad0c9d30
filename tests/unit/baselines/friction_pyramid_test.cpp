#include "baselines/formulations/friction_pyramid.h"

#include <gtest/gtest.h>

#include <numbers>

namespace touchstone {
namespace {

constexpr double kPi = std::numbers::pi;

/// Largest friction / (mu p_n) along the unit vector at `angle` in the contact plane: where the ray leaves
/// the polygon, on the edge between the two neighbouring corners of which it is a combination with weights >=
/// 0.
double radius(const FrictionPyramid<3>& pyramid, int sides, double angle) {
  const Vector<2> along(std::cos(angle), std::sin(angle));
  for (int j = 0; j < sides; ++j) {
    Matrix<2> corners;
    corners << pyramid.directions.col(j).head<2>(), pyramid.directions.col((j + 1) % sides).head<2>();
    const Vector<2> weights = corners.inverse() * along;
    if (weights.minCoeff() >= -1e-12) return 1 / weights.sum();
  }
  return 0;
}

TEST(FrictionPyramid, IsExactInThePlane) {
  ContactLaw<2> law;
  law.mu = 0.3;
  law.e_t = 2.0;
  const auto pyramid = friction_pyramid(law, {});
  ASSERT_EQ(pyramid.size(), 2);
  EXPECT_EQ(pyramid.directions(0, 0), 2.0);
  EXPECT_EQ(pyramid.directions(0, 1), -2.0);
  EXPECT_DOUBLE_EQ(pyramid.largest_friction(), 0.6);
}

TEST(FrictionPyramid, HasNoDirectionsWithoutFriction) {
  EXPECT_EQ(friction_pyramid(ContactLaw<2>{}, {}).size(), 0);
  EXPECT_EQ(friction_pyramid(ContactLaw<3>{}, {}).size(), 0);
  EXPECT_EQ(friction_pyramid(ContactLaw<3>{}, {}).largest_friction(), 0.0);
}

TEST(FrictionPyramid, IsInOrAroundTheCircle) {
  ContactLaw<3> law;
  law.mu = 1.0;
  for (const int sides : {4, 8, 12}) {
    const auto inscribed = friction_pyramid(law, {sides, false});
    const auto circumscribed = friction_pyramid(law, {sides, true});
    EXPECT_NEAR(radius(inscribed, sides, 0.0), 1.0, 1e-12);
    EXPECT_NEAR(radius(inscribed, sides, kPi / sides), std::cos(kPi / sides), 1e-12);
    EXPECT_NEAR(radius(circumscribed, sides, 0.0), 1 / std::cos(kPi / sides), 1e-12);
    EXPECT_NEAR(radius(circumscribed, sides, kPi / sides), 1.0, 1e-12);
  }
}

TEST(FrictionPyramid, FollowsTheEllipsoidsSemiAxes) {
  ContactLaw<3> law;
  law.mu = 0.5;
  law.e_t = 2.0;
  law.e_o = 0.5;
  law.e_r = 0.25;
  const auto pyramid = friction_pyramid(law, {8, false});
  ASSERT_EQ(pyramid.size(), 10);
  for (int j = 0; j < 10; ++j) {
    const Vector<3> scaled = pyramid.directions.col(j).cwiseQuotient(law.semi_axes());
    EXPECT_NEAR(scaled.norm(), 1.0, 1e-12) << "direction " << j << " is not on the ellipsoid";
  }
  EXPECT_DOUBLE_EQ(pyramid.largest_friction(), 1.0);
}

TEST(FrictionPyramid, HasWithEveryDirectionItsOpposite) {
  ContactLaw<3> law;
  law.mu = 0.5;
  law.e_r = 0.3;
  const auto pyramid = friction_pyramid(law, {10, true});
  for (int j = 0; j < pyramid.size(); ++j) {
    double best = 1e300;
    for (int k = 0; k < pyramid.size(); ++k) {
      best = std::min(best, (pyramid.directions.col(j) + pyramid.directions.col(k)).norm());
    }
    EXPECT_EQ(best, 0.0) << "direction " << j;
  }
}

}  // namespace
}  // namespace touchstone
