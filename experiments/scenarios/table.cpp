#include "experiments/scenarios/table.h"

#include <array>

namespace touchstone {

namespace {

constexpr std::array kScenarios = {
    ScenarioEntry{"backspin",
                  "Does a ball that is thrown with backspin slide, turn back and roll as it should?"},
    ScenarioEntry{"block_rest", "Does a block on an incline within the friction angle stay where it is?"},
    ScenarioEntry{"block_slide", "Does a sliding block stop where it should, whatever its direction?"},
    ScenarioEntry{"bounce", "Does a ball bounce with its coefficient of restitution?"},
    ScenarioEntry{"disc_rolling", "Does a disc that rolls on a plane keep its energy, or what takes it?"},
    ScenarioEntry{"drop", "Does a ball that falls without restitution come to rest where it lands?"},
    ScenarioEntry{"free_fall", "Does a thrown, spinning body follow its parabola?"},
    ScenarioEntry{"incline_rolling", "Does a ball roll down an incline without slip?"},
    ScenarioEntry{"incline_sliding", "Does a ball slide and turn on an incline too steep to roll?"},
    ScenarioEntry{"slide_to_roll",
                  "Does a ball that is thrown flat slide until it rolls, and at which speed?"},
    ScenarioEntry{"spin_and_slide", "Do slip and spin share the friction ellipsoid, and end together?"},
};

}  // namespace

std::span<const ScenarioEntry> scenarios() { return kScenarios; }

}  // namespace touchstone
