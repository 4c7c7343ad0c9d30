#pragma once

#include <string>
#include <vector>

#include "tools/gate/check.h"

namespace touchstone::gate {

/// An aligned table claim | bound | value | margin | holds, then what is wrong with each claim that fails and
/// why its bound is what it is, then a line that sums up.
std::string format_report(const std::vector<Claim>& claims, const std::vector<Verdict>& verdicts);

}  // namespace touchstone::gate
