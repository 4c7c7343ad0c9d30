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
    ScenarioEntry{"box_on_incline", "At which slope and friction does a box stay, slide or tip over?"},
    ScenarioEntry{"disc_rolling", "Does a disc that rolls on a plane keep its energy, or what takes it?"},
    ScenarioEntry{"drop", "Does a ball that falls without restitution come to rest where it lands?"},
    ScenarioEntry{"ellipsoid_on_ellipsoid",
                  "Does an ellipsoid roll on another one, to which its distance has no closed form?"},
    ScenarioEntry{"ellipsoid_over_its_end",
                  "How near is a step of h where the ellipsoid rolls over the end of its longest axis?"},
    ScenarioEntry{"ellipsoid_rolling",
                  "How near to the rolling motion of a triaxial ellipsoid on a plane is a step of h?"},
    ScenarioEntry{"ellipsoid_spinning",
                  "How near is a step of h where the ellipsoid turns fast above its contact?"},
    ScenarioEntry{"euler_disc",
                  "Does a coin that rolls about its centre keep to the closed form of that motion?"},
    ScenarioEntry{"free_fall", "Does a thrown, spinning body follow its parabola?"},
    ScenarioEntry{"incline_rolling", "Does a ball roll down an incline without slip?"},
    ScenarioEntry{"incline_sliding", "Does a ball slide and turn on an incline too steep to roll?"},
    ScenarioEntry{"rattleback", "Does a rattleback turn back in one sense, and not in the other?"},
    ScenarioEntry{"slide_to_roll",
                  "Does a ball that is thrown flat slide until it rolls, and at which speed?"},
    ScenarioEntry{"sphere_on_spheres",
                  "Does a ball on two balls roll, slide and separate when it should, and without a jump?"},
    ScenarioEntry{"sphere_spin", "Does torsional friction stop a spinning sphere as it should?"},
    ScenarioEntry{"spheres_in_box", "Does a step with many contacts get solved, whatever their number?"},
    ScenarioEntry{"spin_and_slide", "Do slip and spin share the friction ellipsoid, and end together?"},
    ScenarioEntry{"tippe_top", "Does a tippe top turn over, and keep Jellett's constant?"},
};

}  // namespace

std::span<const ScenarioEntry> scenarios() { return kScenarios; }

}  // namespace touchstone
