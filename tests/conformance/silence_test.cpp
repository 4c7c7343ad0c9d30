#include "baselines/engines/silence.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <iostream>
#include <thread>

/// Libraries are kept quiet; what we say ourselves is heard.
namespace touchstone::engines {
namespace {

TEST(SilencedStderr, DropsWhatItsThreadPrintsAndNothingElse) {
  testing::internal::CaptureStderr();
  std::fprintf(stderr, "before ");
  {
    const SilencedStderr silence;
    std::fprintf(stderr, "chatter %d ", 1);
    std::thread([] { std::fprintf(stderr, "another thread "); }).join();
    std::cerr << "cerr ";
    {
      const SilencedStderr inner;
      std::fputs("chatter 2 ", stderr);
    }
    std::fputs("chatter 3 ", stderr);
  }
  std::fprintf(stderr, "after %s", "it");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "before another thread cerr after it");
}

TEST(SilencedStdout, DropsWhatIsPrinted) {
  testing::internal::CaptureStdout();
  std::printf("before ");
  {
    const SilencedStdout silence;
    std::printf("chatter ");
    std::cout << "chatter ";
  }
  std::printf("after");
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "before after");
}

}  // namespace
}  // namespace touchstone::engines
