#include "experiments/solver_comparison/profile.h"

#include <gtest/gtest.h>

#include "tests/unit/solver_comparison/efforts.h"

namespace touchstone::solver_comparison {
namespace {

using harness::Row;
using harness::Table;

using test::solved;
using test::unsolved;

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

}  // namespace
}  // namespace touchstone::solver_comparison
