#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "experiments/harness/judge.h"
#include "experiments/scenarios/disc_rolling.h"
#include "experiments/scenarios/truths/rigid_polygon.h"

/// What explains the energy of a disc that is rolled as a polygon: energies over time that no method
/// supplied.
namespace touchstone {

/// Energy at time t [s]; none where the truth does not reach.
using EnergyCurve = std::function<std::optional<Energy>(double t)>;

/// Potential energy with the centre at the height R, where the disc has it always and a polygon with a vertex
/// down [J].
double rest_potential(const DiscRolling& disc);

/// What the edges alone take: edge_limited_kinetic_energy() of the truths, at the height R.
EnergyCurve edge_limited(const DiscRolling& disc, int edges);

/// What the linearised gap alone takes: step_limited_kinetic_energy() of the truths, at the height R.
EnergyCurve step_limited(const DiscRolling& disc, double h);

/// The exact rigid polygon with the disc's mass and inertia, one vertex down at t = 0, at the given times.
class ExactPolygon {
 public:
  /// @param times  [s], in any order
  ExactPolygon(const DiscRolling& disc, int edges, std::vector<double> times);

  /// None at a time that was not asked for, or beyond the end of what could be followed.
  [[nodiscard]] std::optional<Energy> at(double t) const;
  [[nodiscard]] const truth::PolygonResult& result() const { return result_; }

 private:
  truth::PolygonResult result_;
  std::map<double, Energy> by_time_;
};

}  // namespace touchstone
