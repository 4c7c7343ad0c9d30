#pragma once

namespace touchstone::engines {

/// Which motion a spatial engine is to allow: `planar` keeps bodies in z = 0, turning about z alone, by the
/// engine's own means (a planar joint, locked axes).
enum class Motion { spatial, planar };

}  // namespace touchstone::engines
