#include "baselines/engines/bullet_float_module.h"

#include <locale.h>

#include <cstring>
#include <exception>

#include "core/model/errors.h"

/// Bullet's single-precision build as a module, which the program loads into a linker namespace of its own.
namespace touchstone::engines {

namespace {

struct World {
  std::unique_ptr<Engine<3>> engine;
  std::vector<ContactImpulse<3>> contacts;
};

Engine<3>& engine(const void* world) { return *static_cast<const World*>(world)->engine; }

void tell(BulletFloatFailure& failure, BulletFloatFailure::Kind kind, const char* what) {
  failure.kind = kind;
  std::strncpy(failure.what, what, sizeof failure.what - 1);
}

/// What `call` returns, or a default with `failure` set.
template <typename Call>
auto guarded(BulletFloatFailure& failure, const Call& call) noexcept -> decltype(call()) {
  // The C library of this namespace has not seen the calling thread start; this gives the thread its tables
  // of characters there (isdigit and the like crash without).
  uselocale(LC_GLOBAL_LOCALE);
  try {
    return call();
  } catch (const Unsupported& refusal) {
    tell(failure, BulletFloatFailure::Kind::unsupported, refusal.what());
  } catch (const std::exception& error) {
    tell(failure, BulletFloatFailure::Kind::failed, error.what());
  } catch (...) {
    tell(failure, BulletFloatFailure::Kind::failed, "an exception of unknown type");
  }
  return {};
}

const char* version(BulletFloatFailure& failure) {
  return guarded(failure, [] {
    static const std::string text = bullet_version();
    return text.c_str();
  });
}

void* load(const Scene<3>& scene, const BulletSettings& settings, Motion motion,
           BulletFloatFailure& failure) {
  return guarded(failure, [&]() -> World* {
    return std::make_unique<World>(World{make_bullet_world(scene, settings, motion), {}}).release();
  });
}

void unload(void* world) { delete static_cast<World*>(world); }

StepReport advance(void* world, double h, BulletFloatFailure& failure) {
  return guarded(failure, [&] { return engine(world).advance(h); });
}

void body(const void* world, int index, BodyState<3>& state) { state = engine(world).body(index); }

void mass_properties(const void* world, int index, MassProperties<3>& properties) {
  properties = engine(world).mass_properties(index);
}

std::span<const ContactImpulse<3>> contacts(void* world, BulletFloatFailure& failure) {
  return guarded(failure, [&]() -> std::span<const ContactImpulse<3>> {
    auto& found = static_cast<World*>(world)->contacts;
    found.clear();
    engine(world).read_contacts(found);
    return found;
  });
}

constexpr BulletFloatModule kModule{&version, &load, &unload, &advance, &body, &mass_properties, &contacts};

}  // namespace

}  // namespace touchstone::engines

extern "C" __attribute__((visibility("default"))) const touchstone::engines::BulletFloatModule*
touchstone_bullet_float_module() noexcept {
  return &touchstone::engines::kModule;
}
