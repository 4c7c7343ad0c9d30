// What contacts() tells of a step.
#include <vector>

#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

constexpr double kStep = 0.01;

TEST(StewartTrinkleContacts, CarryTheWeightOfADiscAtRest) {
  const auto method =
      make_stewart_trinkle<2>(scene<2>(0.4, {ground<2>(), disc("disc", {3, 1}, {0, 0, 0})}), {});
  advance(*method, kStep, 3);
  ASSERT_EQ(method->contacts().size(), 1U);
  const ContactImpulse<2>& contact = method->contacts()[0];
  EXPECT_EQ(contact.body_a, 1);
  EXPECT_EQ(contact.body_b, 0);
  EXPECT_NEAR((contact.point_a - Vector<2>(3, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((contact.point_b - Vector<2>(3, 0)).norm(), 0, 1e-14);
  EXPECT_EQ(contact.normal, Vector<2>(0, 1));
  EXPECT_EQ(contact.tangents, TangentBasis<2>(1, 0));
  EXPECT_NEAR(contact.normal_impulse, kGravity * kStep, 1e-14);
  EXPECT_NEAR(contact.friction_impulse[0], 0, 1e-14);
}

TEST(StewartTrinkleContacts, OfAPolygonAreItsVerticesAtTheEndOfTheStep) {
  const auto method = make_stewart_trinkle<2>(rolling_disc(), {{"edges", "50"}, {"candidates", "all"}});
  const auto& polygon = std::get<RegularPolygon>(method->scene().bodies[0].shape.geometry);
  for (int step = 0; step < 100; ++step) {
    advance(*method, kStep, 1);
    EXPECT_LE(method->contacts().size(),
              6U);  // `all` are candidates; what is far above the ground is left out
    double supported = 0.0;
    for (const auto& contact : method->contacts()) {
      const Vector<2> body_point = method->state()[0].pose.to_body(contact.point_a);
      double nearest = 1e300;
      for (int k = 0; k < 50; ++k) nearest = std::min(nearest, (polygon.vertex(k) - body_point).norm());
      EXPECT_LE(nearest, 1e-12);
      EXPECT_EQ(contact.point_b.y(), 0.0);
      EXPECT_EQ(contact.point_b.x(), contact.point_a.x());
      supported += contact.normal_impulse;
    }
    EXPECT_GE(supported, 0.0);
  }
}

// Falling at 2 m/s from a gap of 0.05 m: within reach of the next step from 0.02 m on, touching a step later.
TEST(StewartTrinkleContacts, AnnounceWhatTheNextStepWouldReach) {
  Scene<2> falling = scene<2>(0.4, {disc("disc", {0, 1.05}, {0, -2, 0}), ground<2>()});
  falling.gravity.setZero();
  const auto method = make_stewart_trinkle<2>(falling, {});
  advance(*method, kStep, 1);
  EXPECT_TRUE(method->contacts().empty());
  advance(*method, kStep, 2);
  ASSERT_EQ(method->contacts().size(), 1U);
  EXPECT_GT(method->contacts()[0].normal_impulse, 0.0);

  falling.bodies[0].pose.position.y() = 1.035;
  const auto nearer = make_stewart_trinkle<2>(falling, {});
  advance(*nearer, kStep, 1);
  ASSERT_EQ(nearer->contacts().size(), 1U);
  EXPECT_EQ(nearer->contacts()[0].normal_impulse, 0.0);
  EXPECT_NEAR(nearer->contacts()[0].point_a.y(), 0.015, 1e-14);
}

TEST(StewartTrinkleContacts, AreNoneInFlight) {
  const auto method =
      make_stewart_trinkle<2>(scene<2>(0.4, {disc("disc", {0, 9}, {0, 0, 0}), ground<2>()}), {});
  advance(*method, kStep, 5);
  EXPECT_TRUE(method->contacts().empty());
}

TEST(StewartTrinkleContacts, FrictionOpposesSlipAtItsBound) {
  const auto method =
      make_stewart_trinkle<2>(scene<2>(0.2, {disc("disc", {0, 1}, {5, 0, 0}), ground<2>()}), {});
  advance(*method, kStep, 3);
  ASSERT_EQ(method->contacts().size(), 1U);
  EXPECT_NEAR(method->contacts()[0].friction_impulse[0], -0.2 * method->contacts()[0].normal_impulse, 1e-14);
}

}  // namespace
}  // namespace touchstone::testing
