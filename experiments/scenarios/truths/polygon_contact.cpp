#include "experiments/scenarios/truths/polygon_contact.h"

#include <algorithm>
#include <numbers>

namespace touchstone::truth::polygon {
namespace {

/// Relative size below which two velocities, or a velocity and zero, are one: rounding of a few operations.
constexpr double coincidence = 1e-13;

bool same(const ContactProblem& p, const ContactSolution& a, const ContactSolution& b, double scale) {
  return std::abs(p.u_n(a.n, a.t) - p.u_n(b.n, b.t)) <= scale &&
         std::abs(p.u_t(a.n, a.t) - p.u_t(b.n, b.t)) <= scale;
}

double speed_scale(const PolygonParameters& body, const PlanarMotion& m) {
  return std::abs(m.vx) + std::abs(m.vy) + body.circumradius * std::abs(m.omega);
}

bool same_velocity(const PolygonParameters& body, const PlanarMotion& a, const PlanarMotion& b,
                   double scale) {
  return std::abs(a.vx - b.vx) + std::abs(a.vy - b.vy) + body.circumradius * std::abs(a.omega - b.omega) <=
         scale;
}

/// The edge comes to lie on the ground: omega = 0, v_y = 0. The normal impulses follow from the balances
///   n_right + n_left = -m v_y,   a (n_right - n_left) + h T = -I omega,
/// a half the edge, h its distance from the centre; only the sum T of the tangential impulses matters.
void append_flat_outcomes(const PolygonParameters& body, const PlanarMotion& before,
                          std::vector<ImpactOutcome>& outcomes) {
  const double half_angle = std::numbers::pi / body.edges;
  const double a = body.circumradius * std::sin(half_angle);
  const double h = body.circumradius * std::cos(half_angle);
  const double sum = -body.mass * before.vy;
  const double rounding = coincidence * body.mass * speed_scale(body, before);
  const auto try_tangential = [&](double total, double vx_after) {
    const double difference = (-body.inertia * before.omega - h * total) / a;
    if (std::abs(difference) > sum + rounding) return;
    ImpactOutcome outcome{.after = before, .kind = PolygonEventKind::flat_impact};
    outcome.after.vx = vx_after;
    outcome.after.vy = outcome.after.omega = 0.0;
    outcomes.push_back(outcome);
  };
  const double stopping = -body.mass * before.vx;
  const double strongest = std::copysign(body.friction * sum, stopping);
  if (std::abs(stopping) <= std::abs(strongest)) {
    try_tangential(stopping, 0.0);
  } else {
    try_tangential(strongest, before.vx + strongest / body.mass);
  }
}

}  // namespace

ContactSolution holding(const ContactProblem& p) {
  const double determinant = p.w_nn * p.w_tt - p.w_nt * p.w_nt;
  return {ContactMode::sticks, (p.w_nt * p.b_t - p.w_tt * p.b_n) / determinant,
          (p.w_nt * p.b_n - p.w_nn * p.b_t) / determinant};
}

std::vector<ContactSolution> solutions(const ContactProblem& p, double mu) {
  std::vector<ContactSolution> found;
  const double scale = coincidence * (std::abs(p.b_n) + std::abs(p.b_t));
  const auto add = [&](const ContactSolution& s) {
    const auto known = [&](const ContactSolution& other) { return same(p, s, other, scale); };
    if (std::none_of(found.begin(), found.end(), known)) found.push_back(s);
  };
  const ContactSolution hold = holding(p);
  if (hold.n >= 0.0 && std::abs(hold.t) <= mu * hold.n) add(hold);
  for (const double sense : {1.0, -1.0}) {
    const double stiffness = p.w_nn - mu * sense * p.w_nt;
    if (stiffness == 0.0) continue;
    const double slip_n = -p.b_n / stiffness;
    const double slip_t = -mu * sense * slip_n;
    if (slip_n >= 0.0 && sense * p.u_t(slip_n, slip_t) >= 0.0) {
      add({sense > 0.0 ? ContactMode::slips_forward : ContactMode::slips_backward, slip_n, slip_t});
    }
  }
  if (p.b_n >= 0.0) add({ContactMode::separates, 0.0, 0.0});
  return found;
}

ContactProblem Vertex::response(double b_n, double b_t) const {
  const double r2 = body_.circumradius * body_.circumradius / body_.inertia;
  return {1.0 / body_.mass + r2 * sin_ * sin_, r2 * sin_ * cos_, 1.0 / body_.mass + r2 * cos_ * cos_, b_n,
          b_t};
}

ContactProblem Vertex::impact(const PlanarMotion& before) const {
  return response(normal_speed(before), slip_speed(before));
}

ContactProblem Vertex::acceleration(double omega) const {
  const double centripetal = body_.circumradius * omega * omega;  // toward the centre, at the vertex
  return response(centripetal * cos_ - body_.gravity, -centripetal * sin_);
}

PlanarMotion Vertex::struck(PlanarMotion motion, double n, double t) const {
  motion.vx += t / body_.mass;
  motion.vy += n / body_.mass;
  motion.omega += spin_up(n, t);
  return motion;
}

std::vector<ImpactOutcome> impact_outcomes(const PolygonParameters& body, const PlanarMotion& before,
                                           const std::vector<double>& alphas) {
  std::vector<ImpactOutcome> all;
  const double scale = coincidence * speed_scale(body, before);
  for (std::size_t i = 0; i < alphas.size(); ++i) {
    const Vertex vertex(body, alphas[i]);
    for (const ContactSolution& s : solutions(vertex.impact(before), body.friction)) {
      const PlanarMotion after = vertex.struck(before, s.n, s.t);
      const auto penetrates = [&](double alpha) { return Vertex(body, alpha).normal_speed(after) < -scale; };
      if (std::any_of(alphas.begin(), alphas.end(), penetrates)) continue;
      const bool sticks = s.mode == ContactMode::sticks;
      all.push_back(
          {after, sticks ? PolygonEventKind::sticking_impact : PolygonEventKind::slipping_impact, i});
    }
  }
  if (alphas.size() == 2) append_flat_outcomes(body, before, all);
  std::vector<ImpactOutcome> distinct;
  for (const ImpactOutcome& outcome : all) {
    const auto known = [&](const ImpactOutcome& o) {
      return same_velocity(body, o.after, outcome.after, 10 * scale);
    };
    if (std::none_of(distinct.begin(), distinct.end(), known)) distinct.push_back(outcome);
  }
  return distinct;
}

}  // namespace touchstone::truth::polygon
