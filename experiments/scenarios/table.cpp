#include "experiments/scenarios/table.h"

#include <array>

namespace touchstone {

namespace {

constexpr std::array kScenarios = {
    ScenarioEntry{"box_on_incline", "At which slope and friction does a box stay, slide or tip over?"},
    ScenarioEntry{"disc_rolling", "Does a disc that rolls on a plane keep its energy, or what takes it?"},
    ScenarioEntry{"euler_disc",
                  "Does a coin that rolls about its centre keep to the closed form of that motion?"},
    ScenarioEntry{"rattleback", "Does a rattleback turn back in one sense, and not in the other?"},
    ScenarioEntry{"tippe_top", "Does a tippe top turn over, and keep Jellett's constant?"},
};

}  // namespace

std::span<const ScenarioEntry> scenarios() { return kScenarios; }

}  // namespace touchstone
