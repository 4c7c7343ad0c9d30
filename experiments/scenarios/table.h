#pragma once

#include <span>
#include <string_view>

/// The one sorted table of scenarios. To add a scenario: one file that builds it and states its truth, and
/// one row in table.cpp.
namespace touchstone {

struct ScenarioEntry {
  std::string_view key;       ///< "disc_rolling": what the `scenario` column holds
  std::string_view question;  ///< what it asks of a method, one line
};

/// Every scenario, sorted by key.
std::span<const ScenarioEntry> scenarios();

}  // namespace touchstone
