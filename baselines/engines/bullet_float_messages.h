#pragma once

#include "baselines/engines/bullet_world.h"
#include "baselines/engines/wire.h"

/// The conversation with the server: one load, then steps, each a number h [s], each answered.
namespace touchstone::engines {

struct BulletFloatLoad {
  Scene<3> scene;
  BulletSettings settings{};
  Motion motion = Motion::spatial;
};

struct BulletFloatLoaded {
  std::string refusal;  ///< why the scene cannot be represented; empty if it was loaded
  std::vector<MassProperties<3>> mass_properties;
  std::vector<BodyState<3>> state;
};

struct BulletFloatStepped {
  std::vector<BodyState<3>> state;
  std::vector<ContactImpulse<3>> contacts;
};

template <typename Wire>
void transfer(Wire& wire, BulletFloatLoad& load) {
  transfer(wire, load.scene);
  wire.raw(load.settings);
  wire.raw(load.motion);
}

template <typename Wire>
void transfer(Wire& wire, BulletFloatLoaded& loaded) {
  transfer(wire, loaded.refusal);
  transfer(wire, loaded.mass_properties);
  transfer(wire, loaded.state);
}

template <typename Wire>
void transfer(Wire& wire, BulletFloatStepped& stepped) {
  transfer(wire, stepped.state);
  transfer(wire, stepped.contacts);
}

}  // namespace touchstone::engines
