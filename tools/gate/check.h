#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/harness/csv.h"
#include "tools/gate/claims.h"

namespace touchstone::gate {

/// What became of a claim.
struct Verdict {
  bool holds = false;
  std::string bound;   ///< as shown: "<= 1e-12"
  std::string value;   ///< the one that is nearest to the bound or farthest beyond it; empty if there is none
  std::string margin;  ///< from that value to the bound, < 0 beyond it; empty for texts
  std::string problem;  ///< why it fails: no row, a cell without a number, or the value; empty if it holds
};

/// Tests the claim on a table. A claim about no row fails, and so does one about a cell that holds no finite
/// number.
/// @param file  for messages
/// @throws InputError if the table has no such column
Verdict check(const Claim& claim, const harness::Table& table, const std::string& file);

/// Tests every claim on the files below `results`, reading each file once.
/// @throws IoError, InputError as read_csv
std::vector<Verdict> check_all(const std::vector<Claim>& claims, const std::filesystem::path& results);

}  // namespace touchstone::gate
