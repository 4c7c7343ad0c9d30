#include "experiments/solver_comparison/speed.h"

#include <gtest/gtest.h>

#include "tests/unit/solver_comparison/efforts.h"

namespace touchstone::solver_comparison {
namespace {

using harness::Row;
using harness::Table;

using test::solved;
using test::unsolved;

std::string cell(const Table& table, std::size_t row, const char* column) {
  return table.rows[row][table.column(column, "t")];
}

TEST(Speed, ComparesWithTheFastestOfSiconosProblemByProblem) {
  const Table table = speed_ratios(test::three_problems());
  ASSERT_EQ(table.rows.size(), 4u);  // all of the family or its only scene, from all starts or the only one
  EXPECT_EQ(cell(table, 0, "scenario") + cell(table, 0, "start"), "");
  EXPECT_EQ(cell(table, 3, "scenario") + cell(table, 3, "start"), "ballswarm");
  for (std::size_t row = 0; row < 4; ++row) {
    EXPECT_EQ(cell(table, row, "method"), "a");
    EXPECT_EQ(cell(table, row, "solved"), "3");
    EXPECT_EQ(cell(table, row, "compared"), "2") << "nobody of Siconos solved the third";
    EXPECT_EQ(cell(table, row, "smallest_ratio"), "0.5");  // problem 2: 1 s over 2 s
    EXPECT_EQ(cell(table, row, "largest_ratio"), "3");     // problem 1: 3 s over 1 s
  }
}

TEST(Speed, ASingleSolverHasToSolveAllThatOursSolves) {
  const Table none = speed_ratios(test::three_problems());
  EXPECT_EQ(cell(none, 0, "single_best"), "") << "b leaves the third problem, and c two";
  std::vector<Effort> all = {
      solved("1", "a", 1, 1.0), solved("1", "siconos_b", 1, 6.0), solved("1", "siconos_c", 1, 2.0),
      solved("2", "a", 1, 2.0), solved("2", "siconos_b", 1, 8.0), unsolved("2", "siconos_c"),
      unsolved("3", "a"),       unsolved("3", "siconos_b")};
  const Table one = speed_ratios(all);
  EXPECT_EQ(cell(one, 0, "single_best"), "siconos_b") << "what ours does not solve is not asked of theirs";
  EXPECT_EQ(cell(one, 0, "single_ratio"), "6");  // of 6 and 4 the upper median
  EXPECT_EQ(cell(one, 0, "smallest_ratio"), "2") << "problem by problem c counts where it solves";
}

TEST(Speed, IsEmptyWhereNothingIsCompared) {
  const Table table = speed_ratios({solved("1", "a", 1, 1), unsolved("1", "siconos_b")});
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(cell(table, 0, "compared"), "0");
  EXPECT_EQ(cell(table, 0, "median_ratio"), "");
  EXPECT_EQ(cell(table, 0, "single_best"), "");
  EXPECT_TRUE(speed_ratios({}).rows.empty());
}

Effort trajectory(const std::string& scenario, const std::string& method, const std::string& start,
                  double seconds, bool solves = true) {
  return {.family = "trajectory",
          .scenario = scenario,
          .start = start,
          .problem = "",
          .method = method,
          .solved = solves,
          .seconds = seconds,
          .mean_seconds = 2 * seconds,
          .steps = 10};
}

TEST(TrajectorySpeed, OneSolverOfSiconosForEverySceneAndTheSameOrTheLastStart) {
  // b is the fastest on the disc and does not solve the balls: over all scenes c it is.
  const Table table = trajectory_ratios(
      {trajectory("disc", "a", "last", 1.0), trajectory("disc", "a", "extrapolated", 0.5),
       trajectory("disc", "siconos_b", "last", 2.0), trajectory("disc", "siconos_c", "last", 3.0),
       trajectory("disc", "siconos_c", "extrapolated", 1.0), trajectory("balls", "a", "last", 1.0),
       trajectory("balls", "siconos_b", "last", 1.0, false), trajectory("balls", "siconos_c", "last", 7.0)});
  std::vector<Row> seen;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    seen.push_back({cell(table, row, "scenario"), cell(table, row, "start"),
                    cell(table, row, "siconos_start"), cell(table, row, "siconos_best"),
                    cell(table, row, "median_ratio")});
  }
  EXPECT_EQ(seen, (std::vector<Row>{{"", "extrapolated", "extrapolated", "siconos_c", "2"},
                                    {"", "extrapolated", "last", "siconos_b", "4"},
                                    {"", "last", "last", "siconos_c", "7"},
                                    {"balls", "last", "last", "siconos_c", "7"},
                                    {"disc", "extrapolated", "extrapolated", "siconos_c", "2"},
                                    {"disc", "extrapolated", "last", "siconos_b", "4"},
                                    {"disc", "last", "last", "siconos_b", "2"}}));
}

TEST(TrajectorySpeed, IsEmptyWhereNoneOfSiconosSolvesEveryStep) {
  const Table table = trajectory_ratios(
      {trajectory("disc", "a", "last", 1.0), trajectory("disc", "siconos_b", "last", 1, false)});
  ASSERT_EQ(table.rows.size(), 2u);
  for (std::size_t row = 0; row < 2; ++row) EXPECT_EQ(cell(table, row, "siconos_best"), "");
  EXPECT_EQ(describe_trajectories(table), "");
}

}  // namespace
}  // namespace touchstone::solver_comparison
