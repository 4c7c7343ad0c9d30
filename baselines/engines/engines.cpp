#include "baselines/engines/engines.h"

#include <array>

namespace touchstone::engines {

std::span<const Rows> all_rows() {
  static const auto rows = std::to_array<Rows>({
      box2d_rows(),
      bullet_rows(),
      ode_rows(),
#ifdef TOUCHSTONE_HAS_CHIPMUNK
      chipmunk_rows(),
#endif
#ifdef TOUCHSTONE_HAS_DART
      dart_rows(),
#endif
#ifdef TOUCHSTONE_HAS_MUJOCO
      mujoco_rows(),
#endif
#ifdef TOUCHSTONE_HAS_SICONOS
      siconos_rows(),
#endif
#ifdef TOUCHSTONE_HAS_SIMBODY
      simbody_rows(),
#endif
  });
  return rows;
}

}  // namespace touchstone::engines
