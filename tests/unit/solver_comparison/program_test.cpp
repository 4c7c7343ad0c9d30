// The program solver_comparison on a few problems: its rows, its bytes, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/harness/csv.h"
#include "experiments/solver_comparison/answer.h"
#include "tests/unit/harness/process.h"

namespace touchstone::solver_comparison {
namespace {

using harness::read_csv;
using harness::Row;
using harness::Table;
using test::Finished;
using test::Scratch;
using test::slurp;
using Words = std::vector<std::string>;

Finished run_program(const std::filesystem::path& out, Words words) {
  words.insert(words.begin(), {SOLVER_COMPARISON, "--out", out.string()});
  return test::run(words);
}

std::string cell(const Table& table, const Row& row, const char* column) {
  return row[table.column(column, "summary.csv")];
}

TEST(SolverComparison, OursSolveWhatHasASolutionAndSayWhatHasNone) {
  const Scratch scratch;
  const Finished run = run_program(
      scratch / "out", {"--families", "literature,random_lcp", "--sizes", "5", "--methods", "solver_chain"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Table table = read_csv(scratch / "out/summary.csv");
  ASSERT_EQ(table.rows.size(), 57u + 18u);
  int without = 0;
  for (const Row& row : table.rows) {
    const bool solvable = cell(table, row, "solvable") == "yes";
    EXPECT_EQ(cell(table, row, "outcome"), solvable ? "solved" : "no_solution_reported");
    EXPECT_EQ(cell(table, row, "false_convergence"), "0");
    EXPECT_EQ(cell(table, row, "claim") == "solved", solvable);
    without += solvable ? 0 : 1;
  }
  EXPECT_EQ(without, 6);
}

/// Siconos's answers to problems whose solutions are known: a wrong layout of its structures would not give
/// them.
TEST(SolverComparison, SiconosSolvesItsPart) {
  if (siconos_version().empty()) GTEST_SKIP() << "the program was built without Siconos";
  const Scratch scratch;
  const Finished run = run_program(scratch / "out", {"--families", "random_lcp", "--sizes", "5", "--methods",
                                                     "siconos_mcp_fb,siconos_ncp_fb,siconos_lemke"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Table table = read_csv(scratch / "out/summary.csv");
  ASSERT_EQ(table.rows.size(), 54u);
  for (const Row& row : table.rows) {
    const bool solvable = cell(table, row, "solvable") == "yes";
    EXPECT_EQ(cell(table, row, "outcome"), solvable ? "solved" : "no_solution_reported")
        << cell(table, row, "method") << " on " << cell(table, row, "scenario");
  }
}

TEST(SolverComparison, StepsAreSolvedByBoth) {
  const Scratch scratch;
  const Finished run =
      run_program(scratch / "out", {"--families", "step,frozen_step", "--scenes", "sphere_spin", "--methods",
                                    "elimination,path_newton,siconos_mcp_fb,siconos_fc3d_nsgs"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Table table = read_csv(scratch / "out/summary.csv");
  for (const Row& row : table.rows) {
    if (cell(table, row, "status") == "skipped") continue;
    EXPECT_EQ(cell(table, row, "outcome"), "solved") << cell(table, row, "method");
  }
  EXPECT_EQ(std::ranges::count_if(
                table.rows, [&](const Row& row) { return cell(table, row, "method") == "elimination"; }),
            6);
  EXPECT_EQ(read_csv(scratch / "out/speed_timing.csv").header[6], "median_ratio");
  EXPECT_NE(run.out.find("elimination"), std::string::npos);
}

TEST(SolverComparison, EveryStepOfATrajectoryIsSolvedByTheStepperAndBySiconos) {
  const Scratch scratch;
  const Finished run = run_program(
      scratch / "out", {"--families", "trajectory", "--scenes", "sphere_spin,ten_bodies", "--methods",
                        "elimination,implicit_stepper,semismooth_newton,siconos_mcp_fb"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Table table = read_csv(scratch / "out/summary.csv");
  ASSERT_EQ(table.rows.size(), 5u)
      << "the stepper has its own start alone, a pile is none of one problem a step";
  const bool with_siconos = !siconos_version().empty();
  for (const Row& row : table.rows) {
    if (cell(table, row, "status") == "skipped") continue;
    EXPECT_EQ(cell(table, row, "problems"), "149");
    EXPECT_EQ(cell(table, row, "solved_problems"), "149") << cell(table, row, "method");
  }
  const Table ratios = read_csv(scratch / "out/trajectory_timing.csv");
  ASSERT_EQ(ratios.rows.size(),
            10u);  // two kinds of ours, two pairs of starts, and elimination's third; all scenes
  for (const Row& row : ratios.rows) {
    EXPECT_EQ(cell(ratios, row, "median_ratio").empty(), !with_siconos)
        << cell(ratios, row, "method") << " from the start " << cell(ratios, row, "start");
  }
  EXPECT_EQ(run.out.find("all scenes") != std::string::npos, with_siconos);
}

TEST(SolverComparison, TablesDoNotDependOnTheNumberOfJobs) {
  const Scratch scratch;
  for (const char* jobs : {"1", "2"}) {
    const Finished run = run_program(scratch / jobs, {"--quick", "--families", "literature,frozen_step",
                                                      "--scenes", "sphere_on_spheres", "--jobs", jobs});
    ASSERT_LE(run.code, 1) << run.err;  // 1: a case failed, as path search does
  }
  for (const char* file : {"summary.csv", "summary.meta.json", "profile.csv"})
    EXPECT_EQ(slurp(scratch / "1" / file), slurp(scratch / "2" / file)) << file;
}

TEST(SolverComparison, RefusesWhatItDoesNotKnow) {
  const Scratch scratch;
  for (const auto& [words, part] :
       std::vector<std::pair<Words, std::string>>{{{"--methods", "gurobi"}, "gurobi"},
                                                  {{"--methods", "lemke:tolerance=1"}, "lemke"},
                                                  {{"--families", "knapsack"}, "knapsack"},
                                                  {{"--scenes", "moon"}, "moon"},
                                                  {{"--sizes", "2"}, "2"}}) {
    const Finished run = run_program(scratch / "out", words);
    EXPECT_EQ(run.code, 2) << part;
    EXPECT_NE(run.err.find(part), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace touchstone::solver_comparison
