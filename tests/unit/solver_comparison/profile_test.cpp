#include "experiments/solver_comparison/profile.h"

#include <gtest/gtest.h>

namespace touchstone::solver_comparison {
namespace {

using harness::Row;
using harness::Table;

Effort solved(const std::string& problem, const std::string& method, double iterations, double seconds) {
  return {"step", "balls", problem, method, true, iterations, seconds};
}

Effort unsolved(const std::string& problem, const std::string& method) {
  return {.family = "step", .scenario = "balls", .problem = problem, .method = method};
}

/// Three problems: two that both solve, one that only `a` does.
std::vector<Effort> efforts() {
  return {solved("1", "a", 2, 1.0), solved("1", "siconos_b", 4, 6.0), solved("1", "siconos_c", 8, 3.0),
          solved("2", "a", 6, 2.0), solved("2", "siconos_b", 3, 1.0), unsolved("2", "siconos_c"),
          solved("3", "a", 5, 0.5), unsolved("3", "siconos_b"),       unsolved("3", "siconos_c")};
}

TEST(Profile, IsThatOfDolanAndMore) {
  const Table table = performance_profile(efforts(), &Effort::iterations, 1.0);
  EXPECT_EQ(table.header, (Row{"family", "method", "ratio", "share"}));
  const std::string third = harness::number_cell(1.0 / 3), two_thirds = harness::number_cell(2.0 / 3);
  EXPECT_EQ(table.rows, (std::vector<Row>{{"step", "a", "1", two_thirds},
                                          {"step", "a", "2", "1"},
                                          {"step", "siconos_b", "1", third},
                                          {"step", "siconos_b", "2", two_thirds},
                                          {"step", "siconos_c", "1", "0"},
                                          {"step", "siconos_c", "4", third}}));
}

TEST(Profile, ACostOfNothingCountsAsTheLeast) {
  const Table table =
      performance_profile({solved("1", "a", 0, 0), solved("1", "b", 3, 0)}, &Effort::iterations, 1.0);
  EXPECT_EQ(table.rows,
            (std::vector<Row>{{"step", "a", "1", "1"}, {"step", "b", "1", "0"}, {"step", "b", "3", "1"}}));
}

TEST(Profile, AMethodThatSolvesNothingHasARow) {
  const Table table =
      performance_profile({solved("1", "a", 2, 1), unsolved("1", "b")}, &Effort::iterations, 1.0);
  EXPECT_EQ(table.rows.back(), (Row{"step", "b", "1", "0"}));
}

TEST(Speed, ComparesWithTheFastestOfSiconosProblemByProblem) {
  const Table table = speed_ratios(efforts());
  ASSERT_EQ(table.rows.size(), 2u);  // all of the family, and its only scene
  EXPECT_EQ(table.rows[0][1], "");
  EXPECT_EQ(table.rows[1][1], "balls");
  const Row& row = table.rows[0];
  const auto cell = [&](const char* column) { return row[table.column(column, "t")]; };
  EXPECT_EQ(cell("method"), "a");
  EXPECT_EQ(cell("solved"), "3");
  EXPECT_EQ(cell("compared"), "2") << "nobody of Siconos solved the third";
  EXPECT_EQ(cell("smallest_ratio"), "0.5");  // problem 2: 1 s over 2 s
  EXPECT_EQ(cell("largest_ratio"), "3");     // problem 1: 3 s over 1 s
}

TEST(Speed, IsEmptyWhereNothingIsCompared) {
  const Table table = speed_ratios({solved("1", "a", 2, 1), unsolved("1", "siconos_b")});
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0][table.column("compared", "t")], "0");
  EXPECT_EQ(table.rows[0][table.column("median_ratio", "t")], "");
  EXPECT_TRUE(speed_ratios({}).rows.empty());
}

}  // namespace
}  // namespace touchstone::solver_comparison
