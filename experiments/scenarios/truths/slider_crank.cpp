#include "experiments/scenarios/truths/slider_crank.h"

#include <cmath>

#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {
namespace {

using Eigen::Vector2d;
using State = OdeVector<2>;  // theta, theta'

/// A quantity along the mechanism's one path: its value and its first two derivatives by theta.
template <class T>
struct Path {
  T value, first, second;
};

struct Configuration {
  Path<double> phi;
  Path<Vector2d> crank_center, rod_center, slider;
};

Configuration configuration(const SliderCrank& m, double theta) {
  const double l1 = m.crank_length, l2 = m.rod_length;
  const Vector2d out(std::cos(theta), std::sin(theta));
  const Vector2d along(-out.y(), out.x());
  Configuration c;
  // l2 sin(phi) = -l1 sin(theta), differentiated twice.
  const double sin_phi = -l1 / l2 * out.y();
  const double cos_phi = std::sqrt(1.0 - sin_phi * sin_phi);
  const double first = -l1 * out.x() / (l2 * cos_phi);
  const double second = (l1 / l2 * out.y() + sin_phi * first * first) / cos_phi;
  c.phi = {std::asin(sin_phi), first, second};
  c.crank_center = {0.5 * l1 * out, 0.5 * l1 * along, -0.5 * l1 * out};
  const Vector2d rod(cos_phi, sin_phi);
  const Vector2d across(-sin_phi, cos_phi);
  const Vector2d rod_first = first * across;
  const Vector2d rod_second = second * across - first * first * rod;
  c.rod_center = {l1 * out + 0.5 * l2 * rod, l1 * along + 0.5 * l2 * rod_first,
                  -l1 * out + 0.5 * l2 * rod_second};
  c.slider = {l1 * out + l2 * rod, l1 * along + l2 * rod_first, -l1 * out + l2 * rod_second};
  return c;
}

/// J and J'/2.
struct GeneralisedInertia {
  double value = 0.0, half_slope = 0.0;
};

GeneralisedInertia inertia(const SliderCrank& m, const Configuration& c) {
  GeneralisedInertia j{m.crank_inertia, 0.0};
  const auto add_translation = [&](double mass, const Path<Vector2d>& p) {
    j.value += mass * p.first.squaredNorm();
    j.half_slope += mass * p.first.dot(p.second);
  };
  add_translation(m.crank_mass, c.crank_center);
  add_translation(m.rod_mass, c.rod_center);
  add_translation(m.slider_mass, c.slider);
  j.value += m.rod_inertia * c.phi.first * c.phi.first;
  j.half_slope += m.rod_inertia * c.phi.first * c.phi.second;
  return j;
}

State rate(const SliderCrank& m, const State& s) {
  const Configuration c = configuration(m, s[0]);
  const GeneralisedInertia j = inertia(m, c);
  const double slope =
      m.gravity * (m.crank_mass * c.crank_center.first.y() + m.rod_mass * c.rod_center.first.y());
  return {s[1], -(j.half_slope * s[1] * s[1] + slope) / j.value};
}

SliderCrankState report(const SliderCrank& m, double t, const State& s) {
  const Configuration c = configuration(m, s[0]);
  SliderCrankState r;
  r.t = t, r.theta = s[0], r.theta_rate = s[1];
  r.phi = c.phi.value, r.phi_rate = c.phi.first * s[1];
  r.crank_center = c.crank_center.value, r.rod_center = c.rod_center.value, r.slider = c.slider.value;
  r.slider_velocity = c.slider.first.x() * s[1];
  r.energy = 0.5 * inertia(m, c).value * s[1] * s[1] +
             m.gravity * (m.crank_mass * r.crank_center.y() + m.rod_mass * r.rod_center.y());
  return r;
}

}  // namespace

void SliderCrank::validate() const {
  require(crank_length > 0.0, "crank_length", crank_length, "> 0");
  require(rod_length > crank_length, "rod_length", rod_length, "> crank_length");
  require(crank_mass > 0.0, "crank_mass", crank_mass, "> 0");
  require(rod_mass > 0.0, "rod_mass", rod_mass, "> 0");
  require(slider_mass > 0.0, "slider_mass", slider_mass, "> 0");
  require(crank_inertia >= 0.0, "crank_inertia", crank_inertia, ">= 0");
  require(rod_inertia >= 0.0, "rod_inertia", rod_inertia, ">= 0");
}

std::vector<SliderCrankState> run_slider_crank(const SliderCrank& mechanism,
                                               const std::vector<double>& times) {
  mechanism.validate();
  require_increasing(times);
  std::vector<SliderCrankState> states;
  State s(mechanism.theta, mechanism.theta_rate);
  double now = 0.0;
  const auto field = [&](double, const State& y) { return rate(mechanism, y); };
  for (const double t : times) {
    if (t > now) s = integrate<2>(field, now, s, t);
    now = t;
    states.push_back(report(mechanism, t, s));
  }
  return states;
}

}  // namespace touchstone::truth
