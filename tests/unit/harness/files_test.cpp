#include "experiments/harness/files.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::harness {
namespace {

using test::listing;
using test::Scratch;
using test::slurp;
using test::spit;

TEST(Files, ReplacesTheOldBytesAndLeavesNothingElse) {
  const Scratch scratch;
  spit(scratch / "a.csv", "old");
  write_files({{scratch / "a.csv", "new"}, {scratch / "b.csv", ""}});
  EXPECT_EQ(slurp(scratch / "a.csv"), "new");
  EXPECT_EQ(read_file(scratch / "a.csv"), "new");
  EXPECT_EQ(listing(scratch.path()), "a.csv b.csv");
}

TEST(Files, OneThatFailsLeavesAllAsTheyWere) {
  const Scratch scratch;
  spit(scratch / "a.csv", "old");
  EXPECT_THROW(write_files({{scratch / "a.csv", "new"}, {scratch / "none" / "b.csv", "x"}}), IoError);
  EXPECT_EQ(slurp(scratch / "a.csv"), "old");
  EXPECT_EQ(listing(scratch.path()), "a.csv");
}

TEST(Files, AFullDiscIsAnIoErrorThatNamesPathAndReason) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full here";
  try {
    FileDescriptor("/dev/full", 1 /* O_WRONLY */).write("x");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "cannot write /dev/full: No space left on device");
  }
}

TEST(Files, MakesFoldersAndFindsOutWhetherTheyCanBeWritten) {
  const Scratch scratch;
  prepare_folder(scratch / "a/b");
  EXPECT_EQ(listing(scratch / "a"), "b");
  EXPECT_EQ(listing(scratch / "a/b"), "");
  spit(scratch / "file", "x");
  EXPECT_THROW(prepare_folder(scratch / "file"), IoError);
  EXPECT_THROW(prepare_folder(scratch / "file/sub"), IoError);
  EXPECT_THROW(prepare_folder("/proc/none"), IoError);
}

TEST(Interrupt, IsHeldBackWhileBlockedAndSeenAfterwards) {
  const InterruptScope scope;
  {
    const InterruptBlock block;
    ::raise(SIGTERM);
    EXPECT_FALSE(interrupt_requested());
  }
  EXPECT_TRUE(interrupt_requested());
  EXPECT_THROW(throw_if_interrupted(), Interrupted);
}

TEST(Interrupt, EachScopeStartsAnew) {
  {
    const InterruptScope scope;
    ::raise(SIGINT);
    EXPECT_TRUE(interrupt_requested());
  }
  const InterruptScope scope;
  EXPECT_FALSE(interrupt_requested());
}

TEST(InterruptDeathTest, TheSecondSignalEndsTheProgram) {
  EXPECT_EXIT(
      {
        const InterruptScope scope;
        ::raise(SIGINT);
        ::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, AHangUpThatWasIgnoredStaysIgnored) {
  ::signal(SIGHUP, SIG_IGN);
  {
    const InterruptScope scope;
    ::raise(SIGHUP);
    EXPECT_FALSE(interrupt_requested());
  }
  ::signal(SIGHUP, SIG_DFL);
}

}  // namespace
}  // namespace touchstone::harness
