// A contact as either of its bodies sees it.

#include "experiments/harness/contact_view.h"

#include <gtest/gtest.h>

namespace touchstone::harness {
namespace {

/// A unit ball that stands on the plane z = 0, and slips and spins there.
struct Standing {
  Scene<3> scene;
  std::vector<BodyState<3>> state;
  ContactImpulse<3> contact;

  Standing() {
    scene.contact_law = {.mu = 0.5, .e_t = 2.0, .e_o = 1.0, .e_r = 0.25};
    Body<3> ball;
    ball.name = "ball";
    ball.pose.position = {0, 0, 1};
    ball.velocity << 3, -1, 0, 0, 0, 2;
    ball.shape.geometry = Sphere<3>{1.0};
    Body<3> ground;
    ground.name = "ground";
    ground.fixed = true;
    ground.shape.geometry = HalfSpace<3>{};
    scene.bodies = {ball, ground};
    state = initial_state(scene);
    contact.body_a = 0;
    contact.body_b = 1;
    contact.normal = {0, 0, 1};
    contact.tangents.col(0) = Vector<3>(1, 0, 0);
    contact.tangents.col(1) = Vector<3>(0, 1, 0);
    contact.normal_impulse = 4.0;
    contact.friction_impulse = {-0.6, 0.4, -0.05};
  }
};

TEST(ContactView, OfBodyAIsTheContactItself) {
  const Standing s;
  const auto seen = strongest_contact(s.scene, s.state, std::span(&s.contact, 1), 0, 1);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->normal, Vector<3>(0, 0, 1));
  EXPECT_EQ(seen->normal_impulse, 4.0);
  EXPECT_EQ(seen->tangential_impulse, Vector<3>(-0.6, 0.4, 0));
  EXPECT_EQ(seen->torsional_impulse, -0.05);
  EXPECT_DOUBLE_EQ(seen->friction_norm, std::sqrt(0.3 * 0.3 + 0.4 * 0.4 + 0.2 * 0.2));
  EXPECT_EQ(seen->friction_limit, 2.0);
  EXPECT_DOUBLE_EQ(seen->slip, std::sqrt(10.0));
  EXPECT_EQ(seen->spin, 2.0);
  EXPECT_DOUBLE_EQ(seen->sigma, std::sqrt(6.0 * 6.0 + 1.0 + 0.5 * 0.5));
}

TEST(ContactView, IsTheSameForABodyThatIsB) {
  // The same contact told the other way round: impulses act on body a, which is now the ground.
  const Standing s;
  ContactImpulse<3> turned = s.contact;
  std::swap(turned.body_a, turned.body_b);
  turned.normal *= -1.0;
  turned.tangents *= -1.0;
  const auto a = strongest_contact(s.scene, s.state, std::span(&s.contact, 1), 0, 1);
  const auto b = strongest_contact(s.scene, s.state, std::span(&turned, 1), 0, 1);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(b->normal, a->normal);
  EXPECT_EQ(b->tangential_impulse, a->tangential_impulse);
  EXPECT_EQ(b->torsional_impulse, a->torsional_impulse);
  EXPECT_EQ(b->spin, a->spin);
  EXPECT_EQ(b->sigma, a->sigma);
}

TEST(ContactView, IsOfTheStrongestOfThePairThatCarriesAny) {
  const Standing s;
  std::vector<ContactImpulse<3>> contacts(3, s.contact);
  contacts[0].normal_impulse = 1.0;
  contacts[2].normal_impulse = 0.0;
  EXPECT_EQ(strongest_contact(s.scene, s.state, contacts, 0, 1)->normal_impulse, 4.0);
  contacts.erase(contacts.begin(), contacts.begin() + 2);
  EXPECT_FALSE(strongest_contact(s.scene, s.state, contacts, 0, 1));
  contacts[0].normal_impulse = 1.0;
  contacts[0].body_b = 0;
  EXPECT_FALSE(strongest_contact(s.scene, s.state, contacts, 0, 1)) << "of another pair";
}

TEST(ContactView, LeavesOutWhatHasNoSemiAxis) {
  Standing s;
  s.scene.contact_law.e_r = 0.0;
  s.contact.friction_impulse[2] = 7.0;  // must not matter
  const auto seen = strongest_contact(s.scene, s.state, std::span(&s.contact, 1), 0, 1);
  EXPECT_DOUBLE_EQ(seen->friction_norm, 0.5);
  EXPECT_DOUBLE_EQ(seen->sigma, std::sqrt(37.0));
}

}  // namespace
}  // namespace touchstone::harness
