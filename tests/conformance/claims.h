#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "baselines/registry.h"
#include "core/model/errors.h"

namespace touchstone::conformance {

/// Loads `scene`, which needs what `claim` names: a method that does not claim it must refuse the scene, and
/// one that claims it must take it.
/// @throws Unsupported  as the method did
template <int Dim>
std::unique_ptr<Method<Dim>> make_claimed(const MethodEntry<Dim>& entry, const Scene<Dim>& scene,
                                          bool Capabilities::*claim) {
  Scene<Dim> plain = scene;
  plain.contact_law = {.mu = scene.contact_law.mu};
  plain.pair_laws.clear();
  plain.joints.clear();
  const bool claimed = entry.make(plain, {})->capabilities().*claim;
  std::unique_ptr<Method<Dim>> method;
  try {
    method = entry.make(scene, {});
  } catch (const Unsupported& refusal) {
    EXPECT_FALSE(claimed) << "claimed, but refused: " << refusal.what();
    throw;
  }
  EXPECT_TRUE(claimed) << "not claimed, but taken";
  return method;
}

}  // namespace touchstone::conformance
