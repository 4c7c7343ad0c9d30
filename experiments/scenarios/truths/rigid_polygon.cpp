#include "experiments/scenarios/truths/rigid_polygon.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/polygon_pivot.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {
namespace {

using polygon::ContactMode;
using polygon::ContactProblem;
using polygon::Pivot;
using polygon::PivotState;
using polygon::Touching;
using polygon::Vertex;

constexpr double pi = std::numbers::pi;

double sign(double value) { return value > 0.0 ? 1.0 : (value < 0.0 ? -1.0 : 0.0); }

class Simulation {
 public:
  Simulation(const PolygonParameters& body, const std::vector<double>& times, const PolygonOptions& options)
      : body_(body), times_(times), options_(options), half_angle_(pi / body.edges), pivot_(body_, {}) {}

  PolygonResult run(double vx, double vy, double omega) {
    motion_ = {0.0, body_.circumradius, 0.0, vx, vy, omega};
    horizon_ = times_.empty() ? 0.0 : times_.back();
    land({{0, 0.0}});
    while (running_ && (next_sample_ < times_.size())) {
      if (static_cast<int>(result_.events.size()) >= options_.max_events) {
        stop(PolygonStatus::too_many_events, "more events than max_events");
        break;
      }
      advance();
    }
    result_.end = running_ ? horizon_ : t_;
    return std::move(result_);
  }

 private:
  void advance() {
    switch (phase_) {
      case PolygonPhase::sticking:
        return pivot();
      case PolygonPhase::sliding:
        return slide();
      case PolygonPhase::flight:
        return fly();
      case PolygonPhase::flat:
        return slide_flat();
      case PolygonPhase::rest:
        return stay();
    }
  }

  // --- bookkeeping ---

  void stop(PolygonStatus status, const std::string& reason) {
    result_.status = status;
    result_.reason = reason + " at t = " + std::to_string(t_) + " s";
    running_ = false;
  }

  void note(PolygonEventKind kind) {
    result_.events.push_back({t_, kind});
    const bool impact = kind <= PolygonEventKind::flat_impact;
    if (impact) ++result_.impacts;
    if (kind != PolygonEventKind::sticking_impact && !result_.first_departure) {
      result_.first_departure = result_.events.back();
    }
  }

  /// Records the requested times up to `end`, from the motion as a function of time.
  template <class Motion>
  void sample_until(double end, const Motion& motion) {
    for (; next_sample_ < times_.size() && times_[next_sample_] <= end; ++next_sample_) {
      const double t = times_[next_sample_];
      const PlanarMotion m = motion(t);
      const double kinetic =
          0.5 * body_.mass * (m.vx * m.vx + m.vy * m.vy) + 0.5 * body_.inertia * m.omega * m.omega;
      result_.samples.push_back({t, m, phase_, kinetic, body_.mass * body_.gravity * m.y});
    }
  }

  // --- a vertex on the ground ---

  template <class Rate, class Margins>
  [[nodiscard]] OdeResult<4> integrate_pivot(const Rate& rate, const Margins& margins, bool slip_may_end) {
    const PivotState start(motion_.x, turn_, slip_, motion_.omega);
    const double start_time = t_;  // phases run on their own clock, which resolves short ones better
    const auto field = [&](double, const PivotState& s) { return rate(s); };
    const auto events = [&](double, const PivotState& s) { return margins(s); };
    const auto observer = [&](const DenseStep<4>& step, double end) {
      sample_until(start_time + end, [&](double t) { return pivot_.motion(step(t - start_time)); });
    };
    const double sense = phase_ == PolygonPhase::sliding ? slip_sense_ : 0.0;
    // A phase takes a few steps; only a normal force that grows without bound takes thousands.
    const OdeOptions options{.first_step = pivot_.first_step(rate, start, sense), .max_steps = 5000};
    const double duration = std::max(horizon_ - start_time, std::numeric_limits<double>::min());
    const auto at = integrate<4, 5>(field, 0.0, start, duration, events,
                                    {false, false, slip_may_end, true, true}, observer, options);
    t_ = start_time + at.t;
    motion_ = pivot_.motion(at.y);
    turn_ = at.y[polygon::pivot_turn];
    slip_ = at.y[polygon::pivot_slip];
    if (at.status == OdeStatus::reached_end) next_sample_ = times_.size();
    return at;
  }

  void pivot() {
    const auto rate = [this](const PivotState& s) { return pivot_.sticking_rate(s); };
    const auto margins = [this](const PivotState& s) { return pivot_.sticking_margins(s); };
    const auto at = integrate_pivot(rate, margins, true);
    if (at.status == OdeStatus::reached_end) return;
    if (at.status != OdeStatus::event) return give_up();
    if (at.event < 2) return next_vertex_down(at.event == 0, pivot_.vertex());
    // Friction at its limit: the vertex goes where the tangential force pulled against.
    slip_ = 0.0;
    slip_sense_ = at.event == 2 ? -1.0 : 1.0;
    phase_ = PolygonPhase::sliding;
    note(PolygonEventKind::slip_begins);
  }

  void slide() {
    const double sense = slip_sense_;
    const auto rate = [this, sense](const PivotState& s) { return pivot_.sliding_rate(s, sense); };
    const auto margins = [this, sense](const PivotState& s) { return pivot_.sliding_margins(s, sense); };
    const auto at = integrate_pivot(rate, margins, slip_ != 0.0);
    if (at.status == OdeStatus::reached_end) return;
    if (at.status != OdeStatus::event) {
      // The normal force is inversely proportional to the
      // stiffness: near zero, that is what stopped the integrator.
      const double stiffness = pivot_.stiffness(pivot_.problem(at.y), sense);
      return stiffness * body_.mass < 1e-2 ? jam() : give_up();
    }
    if (at.event == 4) return jam();
    if (at.event < 2) return next_vertex_down(at.event == 0, pivot_.vertex());
    if (at.event == 3) return take_off();
    note(PolygonEventKind::slip_ends);
    slip_ = 0.0;
    continue_contact();
  }

  void give_up() { stop(PolygonStatus::integration_failed, "the integrator gave up"); }

  void jam() {
    stop(PolygonStatus::no_contact_force, "the normal force at the sliding vertex has no bound (Painleve)");
  }

  void begin_contact(const Touching& touching) {
    pivot_ = Pivot(body_, touching);
    turn_ = 0.0;
    continue_contact();
  }

  /// The vertex is on the ground without normal velocity: sticks, slides on, or lifts off?
  void continue_contact() {
    const ContactProblem p = pivot_.problem({motion_.x, turn_, slip_, motion_.omega});
    if (slip_ != 0.0) {
      phase_ = PolygonPhase::sliding;
      slip_sense_ = std::copysign(1.0, slip_);
      if (pivot_.stiffness(p, slip_sense_) <= 0.0) return jam();
      return p.b_n > 0.0 ? take_off() : void();
    }
    const auto found = polygon::solutions(p, body_.friction);
    if (found.empty()) return stop(PolygonStatus::no_contact_force, "no contact force is consistent");
    if (found.size() > 1)
      return stop(PolygonStatus::ambiguous_contact, "several contact forces are consistent");
    const ContactMode mode = found.front().mode;
    if (mode == ContactMode::separates) return take_off();
    phase_ = mode == ContactMode::sticks ? PolygonPhase::sticking : PolygonPhase::sliding;
    if (mode == ContactMode::sticks) return;
    slip_sense_ = mode == ContactMode::slips_forward ? 1.0 : -1.0;
    note(PolygonEventKind::slip_begins);
  }

  // --- impacts ---

  /// The turn about the pivot is complete: the neighbour
  /// ahead strikes the ground while the pivot is still on it.
  void next_vertex_down(bool forward, long long vertex) {
    const long long neighbour = vertex + (forward ? -1 : 1);
    const double alpha = forward ? half_angle_ : -half_angle_;
    motion_.y = body_.circumradius * std::cos(alpha);
    motion_.theta = alpha - 2.0 * half_angle_ * static_cast<double>(vertex);
    motion_.vy = -body_.circumradius * std::sin(alpha) * motion_.omega;
    land({{neighbour, -alpha}, {vertex, alpha}});
  }

  /// One or two (neighbouring) vertices are on the ground: strike, if one of them moves into it, and go on.
  void land(const std::vector<Touching>& touching) {
    std::vector<double> alphas;
    double lowest = 0.0;
    for (const Touching& each : touching) {
      alphas.push_back(each.alpha);
      lowest = std::min(lowest, Vertex(body_, each.alpha).normal_speed(motion_));
    }
    std::size_t hit = 0;
    if (lowest < 0.0) {
      const auto outcomes = polygon::impact_outcomes(body_, motion_, alphas);
      if (outcomes.empty()) return stop(PolygonStatus::no_impact_solution, "the impact law has no solution");
      if (outcomes.size() > 1)
        return stop(PolygonStatus::ambiguous_impact, "the impact law has several solutions");
      motion_ = outcomes.front().after;
      note(outcomes.front().kind);
      hit = outcomes.front().vertex;
      if (outcomes.front().kind == PolygonEventKind::flat_impact) return lie_down(touching);
      slip_ = outcomes.front().kind == PolygonEventKind::sticking_impact
                  ? 0.0
                  : Vertex(body_, alphas[hit]).slip_speed(motion_);
    } else {
      const Vertex vertex(body_, alphas[hit]);
      if (vertex.normal_speed(motion_) > 0.0) return take_off();
      slip_ = vertex.slip_speed(motion_);
    }
    const double small = 1e-10 * std::sqrt(body_.gravity * body_.circumradius);
    const bool edge_down = touching.size() == 2;
    if (edge_down && std::abs(motion_.omega) * body_.circumradius <= small) {
      note(PolygonEventKind::settles);
      motion_.vx = std::abs(slip_) <= small ? 0.0 : slip_;  // what is left when omega is gone
      return lie_down(touching);
    }
    begin_contact(touching[hit]);
  }

  // --- an edge on the ground ---

  void lie_down(const std::vector<Touching>& ends) {
    motion_.vy = motion_.omega = 0.0;
    if (motion_.vx == 0.0) {
      phase_ = PolygonPhase::rest;
      return;
    }
    // Friction mu m g acts a height h below the centre, the normal forces at most half an edge ahead of it.
    if (body_.friction <= std::tan(half_angle_)) {
      phase_ = PolygonPhase::flat;
      return;
    }
    const auto leading = std::max_element(
        ends.begin(), ends.end(),
        [&](const Touching& a, const Touching& b) { return a.alpha * motion_.vx < b.alpha * motion_.vx; });
    slip_ = motion_.vx;
    begin_contact(*leading);
  }

  void slide_flat() {
    const double deceleration = body_.friction * body_.gravity;
    const double speed = std::abs(motion_.vx);
    const double duration =
        deceleration > 0.0 ? speed / deceleration : std::numeric_limits<double>::infinity();
    const PlanarMotion start = motion_;
    const double start_time = t_;
    const auto at = [&](double t) {
      const double elapsed = std::min(t - start_time, duration);
      PlanarMotion m = start;
      m.x += sign(start.vx) * (speed - 0.5 * deceleration * elapsed) * elapsed;
      m.vx = sign(start.vx) * (speed - deceleration * elapsed);
      return m;
    };
    sample_until(start_time + duration, at);
    if (next_sample_ == times_.size()) return;
    t_ = start_time + duration;
    motion_ = at(t_);
    motion_.vx = 0.0;
    note(PolygonEventKind::stops);
    phase_ = PolygonPhase::rest;
  }

  void stay() {
    sample_until(std::numeric_limits<double>::infinity(), [this](double) { return motion_; });
  }

  // --- flight ---

  void take_off() {
    note(PolygonEventKind::lift_off);
    phase_ = PolygonPhase::flight;
  }

  void fly() {
    const PlanarMotion start = motion_;
    const double start_time = t_;
    const auto at = [&](double t) { return polygon::flown(body_, start, t - start_time); };
    const auto down = polygon::touch_down(body_, start, horizon_ - start_time);
    const double end = down ? start_time + down->elapsed : horizon_;
    sample_until(end, at);
    if (!down) {
      next_sample_ = times_.size();
      return;
    }
    t_ = end;
    motion_ = polygon::flown(body_, start, down->elapsed);
    motion_.y = body_.circumradius * std::cos(down->touching.front().alpha);
    land(down->touching);
  }

  PolygonParameters body_;
  const std::vector<double>& times_;
  PolygonOptions options_;
  double half_angle_;  ///< pi / N

  PolygonResult result_;
  bool running_ = true;
  double t_ = 0.0;
  double horizon_ = 0.0;
  std::size_t next_sample_ = 0;
  PolygonPhase phase_ = PolygonPhase::sticking;
  PlanarMotion motion_;      ///< at t_
  Pivot pivot_;              ///< the vertex on the ground
  double turn_ = 0.0;        ///< since it came down [rad]
  double slip_ = 0.0;        ///< its slip speed [m/s]
  double slip_sense_ = 0.0;  ///< sign of the slip while sliding; also where slip is still zero
};

}  // namespace

PolygonResult roll_polygon(const PolygonParameters& parameters, double vx, double vy, double omega,
                           const std::vector<double>& times, const PolygonOptions& options) {
  parameters.validate();
  require(options.max_events >= 1, "max_events", options.max_events, ">= 1");
  require(std::isfinite(vx) && std::isfinite(vy) && std::isfinite(omega),
          "the initial velocity must be finite");
  require_increasing(times);
  return Simulation(parameters, times, options).run(vx, vy, omega);
}

}  // namespace touchstone::truth
