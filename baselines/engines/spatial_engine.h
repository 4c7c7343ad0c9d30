#pragma once

#include "baselines/engines/engine_method.h"
#include "baselines/engines/extruded.h"
#include "baselines/engines/laws.h"
#include "baselines/engines/planar_options.h"

namespace touchstone::engines {

/// A spatial engine's variant: one key, one loader, and two rows of the table.
struct SpatialEngine {
  const char* key;
  Capabilities capabilities;
  double precision;  ///< kDoublePrecision or kSinglePrecision
  /// Reads its options, calls read.finish(), then loads `scene`. @throws as MethodEntry::make
  std::unique_ptr<Engine<3>> (*load)(const Scene<3>& scene, OptionReader& read, Motion motion);
};

/// MethodEntry<3>::make of `engine`.
template <const SpatialEngine& engine>
std::unique_ptr<Method<3>> make_spatial(const Scene<3>& scene, const Options& options) {
  refuse_unsupported(engine.key, scene, engine.capabilities);
  OptionReader read(engine.key, options);
  auto world = engine.load(scene, read, Motion::spatial);
  return std::make_unique<EngineMethod<3>>(scene, read.effective(), engine.capabilities, engine.precision,
                                           std::move(world));
}

/// MethodEntry<2>::make of `engine`: the same engine and options, and what extrusion asks for.
template <const SpatialEngine& engine>
std::unique_ptr<Method<2>> make_planar(const Scene<2>& given, const Options& options) {
  refuse_unsupported(engine.key, given, engine.capabilities);
  OptionReader read(engine.key, options);
  Scene<2> scene = with_edges_option(given, read);
  const bool sphere = read.choice("disc_as", "sphere", {"sphere", "cylinder"}) == "sphere";
  const Scene<3> solid = extruded(scene, sphere ? DiscAs::sphere : DiscAs::cylinder);
  auto world = engine.load(solid, read, Motion::planar);
  auto spatial = std::make_unique<EngineMethod<3>>(solid, read.effective(), engine.capabilities,
                                                   engine.precision, std::move(world));
  return std::make_unique<ExtrudedMethod>(std::move(scene), read.effective(), std::move(spatial));
}

}  // namespace touchstone::engines
