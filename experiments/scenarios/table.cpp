#include "experiments/scenarios/table.h"

#include <array>

namespace touchstone {

namespace {

constexpr std::array kScenarios = {
    ScenarioEntry{"disc_rolling", "Does a disc that rolls on a plane keep its energy, or what takes it?"},
    ScenarioEntry{"ellipsoid_on_ellipsoid",
                  "Does an ellipsoid roll on another one, to which its distance has no closed form?"},
    ScenarioEntry{"ellipsoid_rolling",
                  "How near to the rolling motion of a triaxial ellipsoid on a plane is a step of h?"},
    ScenarioEntry{"ellipsoid_spinning",
                  "How near is a step of h where the ellipsoid turns fast above its contact?"},
    ScenarioEntry{"sphere_on_spheres",
                  "Does a ball on two balls roll, slide and separate when it should, and without a jump?"},
    ScenarioEntry{"sphere_spin", "Does torsional friction stop a spinning sphere as it should?"},
};

}  // namespace

std::span<const ScenarioEntry> scenarios() { return kScenarios; }

}  // namespace touchstone
