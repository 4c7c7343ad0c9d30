#include "experiments/solver_comparison/profile.h"

#include <gtest/gtest.h>

#include "tests/unit/solver_comparison/efforts.h"

namespace touchstone::solver_comparison {
namespace {

using harness::Row;
using harness::Table;

using test::solved;
using test::unsolved;

TEST(Profile, IsThatOfDolanAndMore) {
  const Table table = performance_profile(test::three_problems(), &Effort::iterations, 1.0);
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

}  // namespace
}  // namespace touchstone::solver_comparison
