#include "experiments/scenarios/disc_rolling_truths.h"

#include <algorithm>

#include "experiments/scenarios/truths/disc_closed_forms.h"

namespace touchstone {

namespace {

truth::RollingDisc closed_form(const DiscRolling& disc) {
  return {disc.mass, disc.inertia, disc.radius, disc.gravity, disc.angular_velocity};
}

}  // namespace

double rest_potential(const DiscRolling& disc) { return disc.mass * disc.gravity * disc.radius; }

EnergyCurve edge_limited(const DiscRolling& disc, int edges) {
  return [disc, edges](double t) {
    return Energy{truth::edge_limited_kinetic_energy(closed_form(disc), edges, t), rest_potential(disc)};
  };
}

EnergyCurve step_limited(const DiscRolling& disc, double h) {
  return [disc, h](double t) {
    return Energy{truth::step_limited_kinetic_energy(closed_form(disc), h, t), rest_potential(disc)};
  };
}

ExactPolygon::ExactPolygon(const DiscRolling& disc, int edges, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  const truth::PolygonParameters polygon = {edges,       disc.mass, disc.inertia,
                                            disc.radius, disc.mu,   disc.gravity};
  const double omega = disc.angular_velocity;
  result_ = truth::roll_polygon(polygon, -disc.radius * omega, 0.0, omega, times);
  for (const truth::PolygonSample& sample : result_.samples) {
    by_time_[sample.t] = {sample.kinetic, sample.potential};
  }
}

std::optional<Energy> ExactPolygon::at(double t) const {
  const auto it = by_time_.find(t);
  return it == by_time_.end() ? std::nullopt : std::optional(it->second);
}

}  // namespace touchstone
