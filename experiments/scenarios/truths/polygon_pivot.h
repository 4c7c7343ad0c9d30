#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "experiments/scenarios/truths/dense_step.h"
#include "experiments/scenarios/truths/polygon_contact.h"
#include "experiments/scenarios/truths/polygon_flight.h"

namespace touchstone::truth::polygon {

/// What is integrated while a vertex is on the ground: x [m]; the turn since the
/// vertex came down [rad], kept apart from the angle so that rocks far smaller
/// than the angle are resolved; its slip speed [m/s]; omega [rad/s].
using PivotState = OdeVector<4>;
enum PivotIndex { pivot_x, pivot_turn, pivot_slip, pivot_omega };

/// First t > 0 with distance + speed t + acceleration
/// t^2 / 2 = 0, for distance >= 0; infinity if there is none.
inline double time_to_zero(double distance, double speed, double acceleration) {
  const double discriminant = speed * speed - 2.0 * acceleration * distance;
  if (discriminant < 0.0) return std::numeric_limits<double>::infinity();
  const double root = std::sqrt(discriminant);
  // Without cancellation; where the earlier root is the start itself, this is the later one.
  double t = 0.0;
  if (speed > 0.0) {
    t = -(speed + root) / acceleration;
  } else if (distance > 0.0) {
    t = 2.0 * distance / (root - speed);
  }
  return t > 0.0 ? t : std::numeric_limits<double>::infinity();
}

/// The polygon while one vertex is on the ground, sticking or sliding in a given sense: y = R cos(alpha).
class Pivot {
 public:
  Pivot(const PolygonParameters& body, const Touching& down) : body_(&body), down_(down) {}

  [[nodiscard]] long long vertex() const { return down_.vertex; }
  [[nodiscard]] double alpha(const PivotState& s) const { return down_.alpha + s[pivot_turn]; }

  [[nodiscard]] PlanarMotion motion(const PivotState& s) const {
    const double c = body_->circumradius * std::cos(alpha(s));
    PlanarMotion m;
    m.x = s[pivot_x];
    m.y = c;
    m.theta = alpha(s) - 2.0 * half_angle() * static_cast<double>(down_.vertex);
    m.vx = s[pivot_slip] - c * s[pivot_omega];
    m.vy = -body_->circumradius * std::sin(alpha(s)) * s[pivot_omega];
    m.omega = s[pivot_omega];
    return m;
  }

  [[nodiscard]] ContactProblem problem(const PivotState& s) const {
    return Vertex(*body_, alpha(s)).acceleration(s[pivot_omega]);
  }

  [[nodiscard]] PivotState sticking_rate(const PivotState& s) const {
    const ContactSolution hold = holding(problem(s));
    return rate(s, hold.n, hold.t, 0.0);
  }

  /// Falls through zero: the neighbour ahead is down, the
  /// one behind is down, friction at its limit in +x, in -x.
  [[nodiscard]] std::array<double, 5> sticking_margins(const PivotState& s) const {
    const ContactSolution hold = holding(problem(s));
    const double limit = body_->friction * hold.n;
    return {room_above(s), room_below(s), limit - hold.t, limit + hold.t, 1.0};
  }

  /// @param sense  sign of the slip, 1 or -1
  [[nodiscard]] PivotState sliding_rate(const PivotState& s, double sense) const {
    const ContactProblem p = problem(s);
    const double n = -p.b_n / stiffness(p, sense);
    const double t = -body_->friction * sense * n;
    return rate(s, n, t, p.u_t(n, t));
  }

  /// Falls through zero: neighbours as above, slip ends, the
  /// normal force ends, the normal force grows beyond all bounds.
  [[nodiscard]] std::array<double, 5> sliding_margins(const PivotState& s, double sense) const {
    const ContactProblem p = problem(s);
    return {room_above(s), room_below(s), sense * s[pivot_slip], -p.b_n, stiffness(p, sense) * body_->mass};
  }

  /// Normal acceleration for a unit normal force while
  /// sliding [1/kg]; Painleve's paradox where it is not > 0.
  [[nodiscard]] double stiffness(const ContactProblem& p, double sense) const {
    return p.w_nn - body_->friction * sense * p.w_nt;
  }

  /// First step of a phase: no longer than until its end, or half of a rock that
  /// returns to where it starts, as estimated from constant accelerations.
  /// Otherwise a step could jump over a rock or a slip that is far shorter.
  /// @param rate_of  PivotState -> its rate
  /// @param sense    sign of the slip; 0 while sticking
  template <class Rate>
  [[nodiscard]] double first_step(const Rate& rate_of, const PivotState& s, double sense) const {
    const double time_scale = std::sqrt(body_->circumradius / body_->gravity);
    const PivotState first = rate_of(s);
    double step = 0.2 * time_scale;
    const auto limit_by = [&](double distance, double speed, double acceleration) {
      const double part = distance > 0.0 ? 1.1 : 0.5;
      step = std::min(step, part * time_to_zero(distance, speed, acceleration));
    };
    limit_by(room_below(s), s[pivot_omega], first[pivot_omega]);
    limit_by(room_above(s), -s[pivot_omega], -first[pivot_omega]);
    if (sense != 0.0) {
      const double delta = 1e-6 * time_scale;
      const PivotState later = s + delta * first;
      const double curvature = (rate_of(later)[pivot_slip] - first[pivot_slip]) / delta;
      limit_by(sense * s[pivot_slip], sense * first[pivot_slip], sense * curvature);
    }
    return step;
  }

 private:
  [[nodiscard]] double half_angle() const { return std::numbers::pi / body_->edges; }
  /// The turn that is left until the next vertex comes down, at alpha = +pi/N or -pi/N.
  [[nodiscard]] double room_above(const PivotState& s) const {
    return half_angle() - down_.alpha - s[pivot_turn];
  }
  [[nodiscard]] double room_below(const PivotState& s) const {
    return half_angle() + down_.alpha + s[pivot_turn];
  }

  [[nodiscard]] PivotState rate(const PivotState& s, double n, double t, double slip_rate) const {
    return {motion(s).vx, s[pivot_omega], slip_rate, Vertex(*body_, alpha(s)).spin_up(n, t)};
  }

  const PolygonParameters* body_;
  Touching down_;
};

}  // namespace touchstone::truth::polygon
