#include "baselines/engines/engines.h"

#include <array>

namespace touchstone::engines {

// CMake writes engines.inc: a line TOUCHSTONE_ENGINE(name) for each engine that is found.
#define TOUCHSTONE_ENGINE(name) Rows name##_rows();
#include "engines.inc"
#undef TOUCHSTONE_ENGINE

std::span<const Rows> all_rows() {
#define TOUCHSTONE_ENGINE(name) name##_rows(),
  static const auto rows = std::to_array<Rows>({
#include "engines.inc"
  });
#undef TOUCHSTONE_ENGINE
  return rows;
}

}  // namespace touchstone::engines
