#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "experiments/harness/csv.h"

namespace touchstone::test {

/// The number in `column` of the only row with these cells.
inline double number(const harness::Table& table,
                     const std::vector<std::pair<std::string, std::string>>& where,
                     const std::string& column) {
  double value = std::nan("");
  int found = 0;
  for (const harness::Row& row : table.rows) {
    const bool meant = std::all_of(where.begin(), where.end(), [&](const auto& want) {
      return row[table.column(want.first, "t")] == want.second;
    });
    if (!meant) continue;
    ++found;
    EXPECT_TRUE(harness::parse_number(row[table.column(column, "t")], value)) << column;
  }
  EXPECT_EQ(found, 1);
  return value;
}

}  // namespace touchstone::test
