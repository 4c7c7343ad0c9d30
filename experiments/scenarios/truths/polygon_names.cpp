#include <cmath>

#include "experiments/scenarios/truths/require.h"
#include "experiments/scenarios/truths/rigid_polygon.h"

namespace touchstone::truth {

void PolygonParameters::validate() const {
  require(edges >= 3, "edges", edges, ">= 3");
  require(mass > 0.0 && std::isfinite(mass), "mass", mass, "> 0");
  require(inertia > 0.0 && std::isfinite(inertia), "inertia", inertia, "> 0");
  require(circumradius > 0.0 && std::isfinite(circumradius), "circumradius", circumradius, "> 0");
  require(friction >= 0.0 && std::isfinite(friction), "friction", friction, ">= 0");
  require(gravity > 0.0 && std::isfinite(gravity), "gravity", gravity, "> 0");
}

const char* to_string(PolygonStatus status) {
  switch (status) {
    case PolygonStatus::completed:
      return "completed";
    case PolygonStatus::no_contact_force:
      return "no_contact_force";
    case PolygonStatus::ambiguous_contact:
      return "ambiguous_contact";
    case PolygonStatus::no_impact_solution:
      return "no_impact_solution";
    case PolygonStatus::ambiguous_impact:
      return "ambiguous_impact";
    case PolygonStatus::too_many_events:
      return "too_many_events";
    case PolygonStatus::integration_failed:
      return "integration_failed";
  }
  return "unknown";
}

const char* to_string(PolygonPhase phase) {
  switch (phase) {
    case PolygonPhase::sticking:
      return "sticking";
    case PolygonPhase::sliding:
      return "sliding";
    case PolygonPhase::flight:
      return "flight";
    case PolygonPhase::flat:
      return "flat";
    case PolygonPhase::rest:
      return "rest";
  }
  return "unknown";
}

const char* to_string(PolygonEventKind kind) {
  switch (kind) {
    case PolygonEventKind::sticking_impact:
      return "sticking_impact";
    case PolygonEventKind::slipping_impact:
      return "slipping_impact";
    case PolygonEventKind::flat_impact:
      return "flat_impact";
    case PolygonEventKind::slip_begins:
      return "slip_begins";
    case PolygonEventKind::slip_ends:
      return "slip_ends";
    case PolygonEventKind::lift_off:
      return "lift_off";
    case PolygonEventKind::settles:
      return "settles";
    case PolygonEventKind::stops:
      return "stops";
  }
  return "unknown";
}

}  // namespace touchstone::truth
