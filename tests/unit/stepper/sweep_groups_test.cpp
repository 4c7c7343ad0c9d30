// SweepGroups and the lanes that its groups are swept over in.
#include "core/stepper/sweep_groups.h"

#include <gtest/gtest.h>

#include <random>

#include "core/stepper/lanes.h"

namespace touchstone {
namespace {

using Bodies = std::array<std::size_t, 2>;

bool share_a_moving_body(const Bodies& a, const Bodies& b) {
  return (a[0] > 0 && (a[0] == b[0] || a[0] == b[1])) || (a[1] > 0 && (a[1] == b[0] || a[1] == b[1]));
}

TEST(SweepGroups, ContactsOfACommonBodyComeInGroupsOneAfterTheOther) {
  constexpr std::size_t kBodies = 40;
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> body(0, kBodies - 1);
  SweepGroups<4> groups;
  for (int trial = 0; trial < 20; ++trial) {
    groups.begin(kBodies);
    std::vector<Bodies> contacts;
    std::vector<std::size_t> places;
    for (int i = 0; i < 200; ++i) {
      contacts.push_back({body(random), body(random)});
      places.push_back(groups.place(contacts.back()));
      ASSERT_LT(places.back(), 4 * groups.groups());
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_NE(places[j], places[i]);
        if (share_a_moving_body(contacts[j], contacts[i])) {
          ASSERT_LT(places[j] / 4, places[i] / 4);
        }
      }
    }
  }
}

TEST(SweepGroups, FillPlacesThatWereLeft) {
  SweepGroups<4> groups;
  groups.begin(20);
  for (std::size_t b = 1; b < 6; ++b) groups.place({b, b + 1});  // each in a group of its own
  EXPECT_EQ(groups.groups(), 5U);
  for (std::size_t b = 7; b < 10; ++b) EXPECT_EQ(groups.place({0, b}) / 4, 0U);
  for (std::size_t b = 10; b < 13; ++b) EXPECT_EQ(groups.place({b, 0}) / 4, 1U);
  EXPECT_EQ(groups.place({12, 13}) / 4, 2U);
  EXPECT_EQ(groups.groups(), 5U);
}

TEST(SweepGroups, TakeNoMoreThanTheContactsOfABodyAndPlacesNeed) {
  SweepGroups<4> groups;
  groups.begin(401);
  for (std::size_t b = 1; b <= 400; ++b) groups.place({0, b});
  EXPECT_EQ(groups.groups(), 100U);
  groups.begin(401);
  for (std::size_t b = 2; b <= 400; ++b) groups.place({1, b});
  EXPECT_EQ(groups.groups(), 399U);
}

TEST(Lanes, AreTransposed) {
  std::array<Lanes, kLanes> rows;
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t j = 0; j < kLanes; ++j) rows[i][j] = static_cast<float>(10 * i + j);
  }
  transpose(rows);
  for (std::size_t i = 0; i < kLanes; ++i) {
    for (std::size_t j = 0; j < kLanes; ++j) EXPECT_EQ(rows[i][j], static_cast<float>(10 * j + i));
  }
}

/// An estimate that is made better, as processors have one each, may be another number in the last place.
TEST(Lanes, RootsAreThoseOfTheStandard) {
  for (float x = 1e-30F; x < 1e30F; x *= 1.37F) {
    const Lanes found = roots(Lanes{x, 2 * x, 3 * x, 5 * x});
    EXPECT_EQ(found[0], std::sqrt(x));
    EXPECT_EQ(found[1], std::sqrt(2 * x));
    EXPECT_EQ(found[2], std::sqrt(3 * x));
    EXPECT_EQ(found[3], std::sqrt(5 * x));
  }
}

}  // namespace
}  // namespace touchstone
