// Steps allocate nothing once the sizes of their problems were seen. A program of its own, because it
// replaces malloc: Eigen's storage does not come from operator new, which ends in malloc as well.
#include <cstddef>
#include <string>

#include "tests/unit/baselines/scenes.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TOUCHSTONE_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define TOUCHSTONE_SANITIZED
#endif

namespace {
long allocations = 0;
}  // namespace

#ifndef TOUCHSTONE_SANITIZED
extern "C" {
void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier): glibc's own
void* __libc_memalign(std::size_t alignment, std::size_t n);  // NOLINT(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace touchstone::testing {
namespace {

class StewartTrinkleAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef TOUCHSTONE_SANITIZED
    GTEST_SKIP() << "the sanitizer owns malloc";
#endif
  }
};

/// Allocations of `count` steps after a warm-up of as many.
long allocations_of(const Scene<2>& scene, const Options& options, int count) {
  const auto method = make_stewart_trinkle<2>(scene, options);
  StepReport report;
  for (int k = 0; k < count; ++k) report = method->step(0.01);
  const long before = allocations;
  for (int k = 0; k < count; ++k) report = method->step(0.01);
  EXPECT_EQ(report.status, StepStatus::solved);
  return allocations - before;
}

TEST_F(StewartTrinkleAllocation, IsCounted) {
  const long before = allocations;
  const Eigen::VectorXd vector = Eigen::VectorXd::Ones(100);
  EXPECT_EQ(allocations, before + 1) << vector.sum();
}

TEST_F(StewartTrinkleAllocation, NoneInASteadyStep) {
  for (const char* edges : {"0", "10", "100", "1000"}) {
    for (const char* candidates : {"reachable", "all", "nearest:2", "epsilon:0.01"}) {
      EXPECT_EQ(allocations_of(rolling_disc(), {{"edges", edges}, {"candidates", candidates}}, 200), 0)
          << edges << " edges, " << candidates;
    }
  }
}

TEST_F(StewartTrinkleAllocation, NoneWithSeveralBodies) {
  const Scene<2> several = scene<2>(0.3, {disc("a", {0, 1}, {1, 0, 0}), disc("b", {2.1, 1}, {-1, 0, 0}),
                                          disc("c", {9, 1}, {-1, 0, 1}), ground<2>()});
  EXPECT_EQ(allocations_of(several, {}, 100), 0);
}

}  // namespace
}  // namespace touchstone::testing
