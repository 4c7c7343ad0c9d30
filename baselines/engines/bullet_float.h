#pragma once

#include <string>

#include "baselines/engines/bullet_world.h"

/// Bullet's single-precision build beside the double one in the same process: their libraries have the same
/// symbol names with other layouts, so this one is loaded into a linker namespace of its own, where nothing
/// that it defines meets the program's.
namespace touchstone::engines {

/// A world of the single-precision build. Worlds may be used by several threads at once, one by one thread at
/// a time, and a process forked meanwhile may use them on.
/// @throws Unsupported as make_bullet_world does, IoError if the module cannot be loaded
std::unique_ptr<Engine<3>> make_bullet_float_world(const Scene<3>& scene, const BulletSettings& settings,
                                                   Motion motion);

/// As bullet_version. @throws IoError also if the module cannot be loaded
std::string bullet_float_version();

}  // namespace touchstone::engines
