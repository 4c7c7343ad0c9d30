// The gate as a program: exit codes and what it prints, on results that hold, that are spoiled and that are
// broken.

#include <gtest/gtest.h>

#include "tests/unit/harness/process.h"

namespace touchstone::gate {
namespace {

using test::Finished;
using test::Scratch;
using test::spit;

const char* const kGates = R"([[claim]]
name = "the energy is kept"
file = "roll/summary.csv"
filter = { method = "ncp" }
column = "drift"
aggregate = "max"
at_most = 1e-12
reason = "the disc rolls for ever"

[[claim]]
name = "the loss falls with the edges"
file = "roll/summary.csv"
filter = { method = "lcp" }
column = "loss"
aggregate = "largest_rise"
along = "edges"
at_most = 0
reason = "Fig. 1"
)";

const char* const kResults =
    "method,edges,drift,loss\n"
    "lcp,10,0.5,0.9\n"
    "lcp,20,0.5,0.4\n"
    "ncp,,1e-15,0\n"
    "ncp,,2e-15,0\n";

class Gate : public testing::Test {
 protected:
  Gate() {
    spit(scratch_ / "gates.toml", kGates);
    spit(results(), kResults);
  }
  [[nodiscard]] std::filesystem::path results() const { return scratch_ / "results/roll/summary.csv"; }
  [[nodiscard]] std::string gates() const { return scratch_ / "gates.toml"; }
  [[nodiscard]] Finished run() const {
    return test::run({GATE_PROGRAM, "--gates", gates(), "--results", scratch_ / "results"});
  }
  /// The results with the first `old` replaced.
  void spoil(const std::string& old, const std::string& other) const {
    std::string text = kResults;
    spit(results(), text.replace(text.find(old), old.size(), other));
  }

 private:
  Scratch scratch_;
};

TEST_F(Gate, PassesResultsThatHoldAndShowsEachMargin) {
  const Finished finished = run();
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(finished.out,
            "claim                          bound     value    margin  holds\n"
            "the energy is kept             <= 1e-12  2e-15  9.98e-13  yes\n"
            "the loss falls with the edges  <= 0       -0.5       0.5  yes\n"
            "\n2 claims: 2 hold, 0 fail\n");
}

TEST_F(Gate, FailsOnASpoiledTable) {
  spoil("2e-15", "2e-12");
  const Finished finished = run();
  EXPECT_EQ(finished.code, 1);
  EXPECT_NE(finished.out.find("FAILS: the energy is kept (roll/summary.csv)\n"
                              "  drift: 2e-12 is beyond the bound\n"
                              "  why it is claimed: the disc rolls for ever\n"),
            std::string::npos)
      << finished.out;
  EXPECT_NE(finished.out.find("2 claims: 1 hold, 1 fail"), std::string::npos);
}

TEST_F(Gate, FailsOnEverySortOfSpoiledCell) {
  for (const char* cell : {"", "nan", "inf", "1e-15x", "ok"}) {
    spoil("1e-15", cell);
    EXPECT_EQ(run().code, 1) << "'" << cell << "'";
  }
}

TEST_F(Gate, FailsWhenNoRowIsLeft) {
  spit(results(), "method,edges,drift,loss\nlcp,10,0.5,0.9\nlcp,20,0.5,0.4\n");
  const Finished finished = run();
  EXPECT_EQ(finished.code, 1);
  EXPECT_NE(finished.out.find("no row passes the filter"), std::string::npos) << finished.out;
}

TEST_F(Gate, BrokenFilesAreExitCodeTwoWithFileAndLine) {
  spoil("1e-15,0", "1e-15");
  Finished finished = run();
  EXPECT_EQ(finished.code, 2);
  EXPECT_NE(finished.err.find("summary.csv:4: got 3 cells"), std::string::npos) << finished.err;
  spit(gates(), "[[claim]\n");
  finished = run();
  EXPECT_EQ(finished.code, 2);
  EXPECT_NE(finished.err.find("gates.toml:1"), std::string::npos) << finished.err;
  EXPECT_EQ(finished.out, "");
}

TEST_F(Gate, AMissingColumnIsExitCodeTwo) {
  spoil("drift", "drifts");
  const Finished finished = run();
  EXPECT_EQ(finished.code, 2);
  EXPECT_NE(finished.err.find("got 'drift', allowed: one of method, edges, drifts, loss"), std::string::npos)
      << finished.err;
}

TEST_F(Gate, FilesThatCannotBeReadAreExitCodeThree) {
  std::filesystem::remove(results());
  Finished finished = run();
  EXPECT_EQ(finished.code, 3);
  EXPECT_NE(finished.err.find("summary.csv: No such file"), std::string::npos) << finished.err;
  std::filesystem::remove(gates());
  EXPECT_EQ(run().code, 3);
}

TEST(GateUsage, BadUsageIsExitCodeTwoAndHelpIsNone) {
  EXPECT_EQ(test::run({GATE_PROGRAM, "--nothing"}).code, 2);
  const Finished help = test::run({GATE_PROGRAM, "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("Exit codes"), std::string::npos);
}

}  // namespace
}  // namespace touchstone::gate
