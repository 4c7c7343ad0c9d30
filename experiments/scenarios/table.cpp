#include "experiments/scenarios/table.h"

#include <array>

namespace touchstone {

namespace {

constexpr std::array kScenarios = {
    ScenarioEntry{"disc_rolling", "Does a disc that rolls on a plane keep its energy, or what takes it?"},
};

}  // namespace

std::span<const ScenarioEntry> scenarios() { return kScenarios; }

}  // namespace touchstone
