// Steps allocate nothing. A program of its own, because it
// replaces malloc: Eigen's storage does not come from operator new, which ends in malloc as well.
#include <algorithm>
#include <cstddef>
#include <set>
#include <string>

#include "tests/support/allocation_counter.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

class StewartTrinkleAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer owns malloc";
  }
};

/// How many of 500 steps allocate, after a warm-up of as many.
int allocating_steps(const Scene<2>& scene, const Options& options) {
  const auto method = make_stewart_trinkle<2>(scene, options);
  int allocating = 0;
  for (int k = 0; k < 1000; ++k) {
    const long before = allocations;
    const StepReport report = method->step(0.01);
    if (k >= 500 && allocations != before) ++allocating;
    EXPECT_EQ(report.status, StepStatus::solved);
  }
  return allocating;
}

TEST_F(StewartTrinkleAllocation, IsCounted) {
  const long before = allocations;
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(100);
  EXPECT_EQ(allocations, before + 1) << vector.sum();
}

TEST_F(StewartTrinkleAllocation, NoneInASteadyStep) {
  for (const char* edges : {"0", "100"}) {
    for (const char* candidates : {"reachable", "all", "nearest:2", "epsilon:0.01"}) {
      EXPECT_EQ(allocating_steps(rolling_disc(), {{"edges", edges}, {"candidates", candidates}}), 0)
          << edges << " edges, " << candidates;
    }
  }
}

// With ten edges the number of vertices that a step solves for changes now and then, and the size of Lemke's
// problem with it; with a thousand a step needs now and then more of them at once than any before it.
TEST_F(StewartTrinkleAllocation, NoneForAWorkingSetOfANewSize) {
  for (const char* edges : {"10", "1000"}) {
    for (const char* candidates : {"reachable", "all"}) {
      EXPECT_EQ(allocating_steps(rolling_disc(), {{"edges", edges}, {"candidates", candidates}}), 0)
          << edges << " edges, " << candidates;
    }
  }
}

// Boxes that are thrown tumbling onto the ground land after the warm-up, on corners, edges and faces.
TEST_F(StewartTrinkleAllocation, NoneInStepsThatMeetTheirFirstContacts) {
  for (int i = 0; i < 2; ++i) {
    Body<3> box = body<3>("box" + std::to_string(i), {Box<3>{{0.5, 0.4, 0.3}}}, {0, 0, 3.0 + i});
    box.velocity << 1, 0.5, 0, 2, -3, 1 + i;
    const auto method = make_stewart_trinkle<3>(scene<3>(0.5, {ground<3>(), box}), {});
    EXPECT_EQ(method->step(0.01).status, StepStatus::solved);
    std::set<long> sizes;  // of the problems, in contacts
    for (int k = 0; k < 400; ++k) {
      const long before = allocations;
      const StepReport report = method->step(0.01);
      ASSERT_EQ(allocations, before) << "step " << k;
      ASSERT_EQ(report.status, StepStatus::solved);
      sizes.insert(std::count_if(method->contacts().begin(), method->contacts().end(),
                                 [](const auto& contact) { return contact.normal_impulse > 0; }));
    }
    EXPECT_GE(sizes.size(), 3U) << "none, one and more contacts";
  }
}

TEST_F(StewartTrinkleAllocation, NoneWithSeveralBodies) {
  const Scene<2> several = scene<2>(0.3, {disc("a", {0, 1}, {1, 0, 0}), disc("b", {2.1, 1}, {-1, 0, 0}),
                                          disc("c", {9, 1}, {-1, 0, 1}), ground<2>()});
  EXPECT_EQ(allocating_steps(several, {}), 0);
}

}  // namespace
}  // namespace touchstone::testing
