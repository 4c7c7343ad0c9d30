#pragma once

#include <string>

#include "baselines/engines/bullet_world.h"

namespace touchstone::engines {

/// The world of Bullet's single-precision build, in a server process that ends with it, and with the thread
/// that made it. A server that dies throws from the call under way.
/// @throws Unsupported as make_bullet_world does, std::system_error if the server cannot be started
std::unique_ptr<Engine<3>> make_bullet_float_process(const Scene<3>& scene, const BulletSettings& settings,
                                                     Motion motion);

/// Of the single-precision library, as the server tells; "unknown" if it cannot be asked. Asks once.
std::string bullet_float_version();

}  // namespace touchstone::engines
