#pragma once

#include "baselines/approximation.h"
#include "baselines/options.h"

namespace touchstone::engines {

/// Reads the option `edges` of every planar method: N >= 3 replaces moving discs by regular N-gons, 0 keeps
/// them.
inline Scene<2> with_edges_option(const Scene<2>& scene, OptionReader& read) {
  constexpr int kMostEdges = 1000000;
  const int edges = read.integer("edges", 0, 0, kMostEdges);
  return edges == 0 ? scene : with_polygons(scene, edges);
}

}  // namespace touchstone::engines
