// box_on_incline, euler_disc, rattleback and tippe_top as programs: their rows, their bytes, bad input.

#include <gtest/gtest.h>

#include "experiments/harness/csv.h"
#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using test::Finished;
using test::Scratch;
using test::slurp;
using Words = std::vector<std::string>;

struct Program {
  const char* name;
  const char* path;
  Words words;              ///< a run of a second or two
  std::size_t rows;         ///< of its summary
  const char* extra_table;  ///< besides the summary, or nothing
};

std::ostream& operator<<(std::ostream& out, const Program& program) { return out << program.name; }

const Program kPrograms[] = {
    {"box_on_incline", BOX_ON_INCLINE, {"--quick", "--methods", "implicit_ncp,stewart_trinkle"}, 90, nullptr},
    {"euler_disc", EULER_DISC, {"--quick"}, 4, "history.csv"},
    {"rattleback", RATTLEBACK, {"--quick"}, 4, "history.csv"},
    {"tippe_top", TIPPE_TOP, {"--quick"}, 4, "history.csv"},
};

Finished run(const Program& program, const std::filesystem::path& out, const Words& more) {
  Words words = {program.path, "--out", out.string()};
  words.insert(words.end(), more.begin(), more.end());
  return test::run(words);
}

double number(const Table& table, const Row& row, const std::string& column) {
  double value = 0;
  EXPECT_TRUE(parse_number(row[table.column(column, "summary")], value)) << column;
  return value;
}

class MotionExperiment : public testing::TestWithParam<Program> {};

TEST_P(MotionExperiment, GivesTheSameBytesFromOneAndTwoThreads) {
  const Program& program = GetParam();
  const Scratch scratch;
  for (const char* jobs : {"1", "2"}) {
    Words words = program.words;
    words.insert(words.end(), {"--jobs", jobs});
    const Finished finished = run(program, scratch / jobs, words);
    ASSERT_EQ(finished.code, 0) << finished.err;
  }
  std::vector<std::string> tables = {"summary.csv", "summary.meta.json"};
  if (program.extra_table != nullptr) tables.push_back(program.extra_table);
  for (const std::string& table : tables) {
    EXPECT_FALSE(slurp(scratch / "1" / table).empty());
    EXPECT_EQ(slurp(scratch / "1" / table), slurp(scratch / "2" / table)) << table;
  }
}

TEST_P(MotionExperiment, SolvesEveryStepToTheJudgesSatisfaction) {
  const Program& program = GetParam();
  const Scratch scratch;
  Words words = program.words;
  words.insert(words.end(), {"--jobs", "2"});
  ASSERT_EQ(run(program, scratch / "out", words).code, 0);
  const Table summary = read_csv(scratch / "out/summary.csv");
  ASSERT_EQ(summary.rows.size(), program.rows);
  for (const Row& row : summary.rows) {
    if (row[summary.column("method", "summary")] != "implicit_ncp") continue;
    EXPECT_EQ(row[summary.column("status", "summary")], "ok");
    EXPECT_EQ(number(summary, row, "unsolved_steps"), 0);
    EXPECT_LE(number(summary, row, "largest_residual"), 1e-10);
    EXPECT_GT(number(summary, row, "steps"), 1);
    // The ledger's sum is the change of energy.
    EXPECT_NEAR(number(summary, row, "energy_change_J"),
                number(summary, row, "energy_drift_J") - number(summary, row, "friction_loss_J") -
                    number(summary, row, "impact_loss_J"),
                1e-12);
  }
}

TEST_P(MotionExperiment, RefusesBadInputWithExitCodeTwo) {
  const Program& program = GetParam();
  const Scratch scratch;
  for (const Words& words : {Words{"--step-sizes", "0"}, Words{"--step-sizes", "0.0007"},
                             Words{"--methods", "magic"}, Words{"--until", "nan"}}) {
    const Finished finished = run(program, scratch / "out", words);
    EXPECT_EQ(finished.code, 2) << words[0] << ' ' << words[1];
    EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  }
  EXPECT_EQ(test::listing(scratch.path()), "") << "nothing is written";
}

INSTANTIATE_TEST_SUITE_P(Programs, MotionExperiment, testing::ValuesIn(kPrograms),
                         [](const auto& program) { return std::string(program.param.name); });

TEST(BoxOnInclineProgram, IsRightInEveryCellAndSaysWhatAMethodCannotRepresent) {
  const Scratch scratch;
  const Finished finished =
      run(kPrograms[0], scratch / "out",
          {"--quick", "--jobs", "2", "--methods", "implicit_ncp,stewart_trinkle:pyramid=4"});
  ASSERT_EQ(finished.code, 0) << finished.err;
  const Table summary = read_csv(scratch / "out/summary.csv");
  int planar = 0;
  for (const Row& row : summary.rows) {
    EXPECT_EQ(number(summary, row, "release_right"), 1);
    EXPECT_EQ(number(summary, row, "end_right"), 1);
    planar += row[summary.column("space", "summary")] == "plane" ? 1 : 0;
  }
  EXPECT_EQ(planar, 30) << "the implicit NCP, in the plane too";
}

}  // namespace
}  // namespace touchstone::harness
