// Contact modes, events and violated laws of made-up histories.

#include "experiments/scenarios/ball_history.h"

#include <gtest/gtest.h>

namespace touchstone {
namespace {

using enum BallContactMode;

BallContactInstant contact(BallContactMode mode) {
  BallContactInstant c;
  c.mode = mode;
  if (mode == apart) return c;
  c.normal = 10.0;
  c.friction_limit = 2.0;
  c.friction_norm = mode == sliding ? 2.0 : 1.0;
  c.sigma = mode == sliding ? 0.5 : 0.0;
  return c;
}

/// One step of 0.1 s for each pair of modes, after the start; velocities grow by 0.1 a step.
BallHistory history(const std::vector<std::array<BallContactMode, 2>>& steps) {
  BallHistory history(1);
  for (const auto& modes : steps) {
    BallInstant instant;
    instant.t = 0.1 * static_cast<double>(history.size());
    instant.velocity = Twist<3>::Constant(instant.t);
    instant.contacts = {contact(modes[0]), contact(modes[1])};
    history.push_back(instant);
  }
  return history;
}

TEST(BallEvents, AreDatedToTheFirstStepInTheNewMode) {
  const BallEvents events =
      ball_events(history({{sliding, sticking}, {sliding, sliding}, {apart, sliding}, {apart, apart}}));
  EXPECT_EQ(events.story, "1 slides, 2 rolls; 2 slides; 1 separates; 2 separates");
  EXPECT_FALSE(events.slides[0]) << "it never rolled";
  EXPECT_DOUBLE_EQ(*events.slides[1], 0.2);
  EXPECT_DOUBLE_EQ(*events.separates[0], 0.3);
  EXPECT_DOUBLE_EQ(*events.separates[1], 0.4);
}

TEST(BallEvents, CountFromTheLastTimeOfSeveral) {
  const BallEvents events = ball_events(
      history({{sticking, apart}, {apart, apart}, {sticking, apart}, {sliding, apart}, {apart, apart}}));
  EXPECT_EQ(events.story, "1 rolls, 2 separates; 1 separates; 1 rolls; 1 slides; 1 separates");
  EXPECT_DOUBLE_EQ(*events.slides[0], 0.4);
  EXPECT_DOUBLE_EQ(*events.separates[0], 0.5);
  EXPECT_FALSE(events.separates[1]) << "it never touched";
}

TEST(BallEvents, AreNoneThatHaveNotHappenedByTheEnd) {
  const BallEvents events = ball_events(history({{sliding, sticking}, {sliding, sticking}}));
  EXPECT_EQ(events.story, "1 slides, 2 rolls");
  EXPECT_FALSE(events.slides[1]);
  EXPECT_FALSE(events.separates[0]);
  EXPECT_EQ(ball_events(BallHistory(1)).story, "") << "no step, no story";
}

TEST(BallEvents, ALongStoryIsCutShort) {
  std::vector<std::array<BallContactMode, 2>> steps;
  for (int k = 0; k < 12; ++k) steps.push_back({k % 2 == 0 ? sliding : apart, apart});
  const std::string story = ball_events(history(steps)).story;
  EXPECT_TRUE(story.ends_with("; and 3 more changes")) << story;
}

TEST(BallLaws, HoldInAHistoryThatKeepsThem) {
  const BallLaws laws = ball_laws(history({{sliding, sticking},
                                           {sliding, sticking},
                                           {sliding, sticking},
                                           {apart, sticking},
                                           {apart, sticking}}),
                                  0.1);
  EXPECT_EQ(laws.rolling_slip, 0.0);
  EXPECT_EQ(laws.sliding_friction_gap, 0.0);
  EXPECT_NEAR(*laws.separation_jump, 0.0, 1e-12);
}

TEST(BallLaws, TellSlipInsideTheEllipsoidAndFrictionThatIsNotOnIt) {
  BallHistory slipping = history({{sticking, apart}});
  (*slipping[1].contacts)[0].sigma = 3e-4;
  EXPECT_EQ(ball_laws(slipping, 0.1).rolling_slip, 3e-4);
  BallHistory weak = history({{sliding, apart}});
  (*weak[1].contacts)[0].friction_norm = 1.5;
  EXPECT_DOUBLE_EQ(ball_laws(weak, 0.1).sliding_friction_gap, 0.1 * 0.5);
  EXPECT_FALSE(ball_laws(weak, 0.1).separation_jump) << "nothing separates";
}

TEST(BallLaws, TellAJumpInAnyVelocityAndOnlyWhereAContactSeparates) {
  const std::vector<std::array<BallContactMode, 2>> steps = {
      {sliding, apart}, {sliding, apart}, {sliding, apart}, {apart, apart}, {apart, apart}, {apart, apart}};
  for (int component = 0; component < 6; ++component) {
    BallHistory jumping = history(steps);
    for (std::size_t k = 4; k < jumping.size(); ++k) jumping[k].velocity[component] += 0.2;
    EXPECT_NEAR(*ball_laws(jumping, 0.1).separation_jump, 2.0, 1e-12) << component;
  }
  BallHistory elsewhere = history(steps);
  for (std::size_t k = 6; k < elsewhere.size(); ++k) elsewhere[k].velocity[2] += 0.2;
  EXPECT_NEAR(*ball_laws(elsewhere, 0.1).separation_jump, 0.0, 1e-12);
}

}  // namespace
}  // namespace touchstone
