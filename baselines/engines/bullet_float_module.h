#pragma once

#include <span>

#include "baselines/engines/bullet_world.h"

/// What the module with Bullet's single-precision build offers to the program. The two sides are of one build
/// but have a C++ library each, so nothing that one side allocates is kept or freed by the other, and no
/// exception goes across: arguments are read where they lie, results are plain values or lie in the module.
namespace touchstone::engines {

/// Why a call did not do what it was asked.
struct BulletFloatFailure {
  enum class Kind { none, unsupported, failed };
  Kind kind = Kind::none;
  char what[512] = {};  ///< of the exception, cut off where it is longer
};

struct BulletFloatModule {
  /// @returns bullet_version(), to the end of the process; or null with `failure` set
  const char* (*version)(BulletFloatFailure& failure);
  /// @returns the world, for the functions below, or null with `failure` set
  void* (*load)(const Scene<3>& scene, const BulletSettings& settings, Motion motion,
                BulletFloatFailure& failure);
  void (*unload)(void* world);
  StepReport (*advance)(void* world, double h, BulletFloatFailure& failure);
  void (*body)(const void* world, int index, BodyState<3>& state);
  void (*mass_properties)(const void* world, int index, MassProperties<3>& properties);
  /// Those of the last step; they stay until the world is asked again.
  std::span<const ContactImpulse<3>> (*contacts)(void* world, BulletFloatFailure& failure);
};

}  // namespace touchstone::engines

/// The one symbol that the module exports.
extern "C" const touchstone::engines::BulletFloatModule* touchstone_bullet_float_module() noexcept;
