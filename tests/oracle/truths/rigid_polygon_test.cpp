// Is the event-driven polygon right? Oracles: the impact ratio and angular
// momentum, the energy integral by quadrature, the friction conditions checked
// from the samples alone, and an independent penalty simulation.
#include "experiments/scenarios/truths/rigid_polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/scenarios/truths/gauss_legendre.h"
#include "experiments/scenarios/truths/polygon_contact.h"
#include "experiments/scenarios/truths/polygon_flight.h"

namespace touchstone::truth {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> grid(double end, int intervals) {
  std::vector<double> times;
  for (int i = 0; i <= intervals; ++i) times.push_back(end * i / intervals);
  return times;
}

PolygonResult paper_polygon(int edges, const std::vector<double>& times) {
  return roll_polygon({.edges = edges}, -3.0, 0.0, 3.0, times);
}

/// Lowest vertex above the ground [m].
double clearance(const PolygonParameters& body, const PlanarMotion& m) {
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < body.edges; ++k) {
    lowest = std::min(lowest, m.y - body.circumradius * std::cos(m.theta + 2.0 * pi * k / body.edges));
  }
  return lowest;
}

/// Rolling about a vertex at pi/N, the next one about to come down.
PlanarMotion before_impact(const PolygonParameters& body, double omega) {
  const double half = pi / body.edges;
  return {.y = body.circumradius * std::cos(half),
          .theta = half,
          .vx = -body.circumradius * std::cos(half) * omega,
          .vy = -body.circumradius * std::sin(half) * omega,
          .omega = omega};
}

double sticking_ratio(const PolygonParameters& body) {
  const double about_vertex = body.mass * body.circumradius * body.circumradius;
  return (body.inertia + about_vertex * std::cos(2.0 * pi / body.edges)) / (body.inertia + about_vertex);
}

TEST(PolygonImpact, SolidPolygonKeepsTheKnownEnergyPerRevolution) {
  const std::vector<std::pair<int, double>> kept{{16, 0.1862},  {32, 0.4374},  {64, 0.6625},
                                                 {128, 0.8141}, {256, 0.9023}, {1000, 0.9740}};
  for (const auto& [edges, fraction] : kept) {
    PolygonParameters body{.edges = edges, .friction = 10.0};
    body.inertia = (2.0 + std::cos(2.0 * pi / edges)) / 6.0;  // uniform, m = R = 1
    const double half = pi / edges;
    const auto outcomes = polygon::impact_outcomes(body, before_impact(body, 2.0), {-half, half});
    ASSERT_EQ(outcomes.size(), 1u);
    const double ratio = outcomes[0].after.omega / 2.0;
    const double c = std::cos(2.0 * pi / edges);
    EXPECT_NEAR(ratio, (2.0 + 7.0 * c) / (8.0 + c), 1e-14);
    EXPECT_NEAR(std::pow(ratio, 2 * edges), fraction, 5e-5);
  }
}

TEST(PolygonImpact, StickingKeepsAngularMomentumAboutTheNewVertexAndLiftsTheOld) {
  for (const int edges : {6, 12, 100, 1000}) {
    const PolygonParameters body{.edges = edges};
    const double half = pi / edges;
    const PlanarMotion before = before_impact(body, 3.0);
    const auto outcomes = polygon::impact_outcomes(body, before, {-half, half});
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_EQ(outcomes[0].kind, PolygonEventKind::sticking_impact);
    const auto momentum =
        [&](const PlanarMotion& m) {  // about the new vertex, centre at R (sin, cos) from it
          return body.inertia * m.omega + std::sin(half) * m.vy - std::cos(half) * m.vx;
        };
    EXPECT_NEAR(momentum(outcomes[0].after), momentum(before), 1e-14);
    EXPECT_NEAR(outcomes[0].after.omega, sticking_ratio(body) * 3.0, 1e-14);
    EXPECT_GT(polygon::Vertex(body, half).normal_speed(outcomes[0].after), 0.0);
  }
}

TEST(PolygonImpact, SticksIffTheImpulseIsInTheCone) {
  for (const int edges : {5, 8, 20, 60}) {
    PolygonParameters body{.edges = edges};
    const double r = sticking_ratio(body);
    const double half = pi / edges;
    const double needed = (1.0 - r) / (1.0 + r) / std::tan(half);
    for (const double factor : {0.999, 1.001}) {
      body.friction = factor * needed;
      const auto outcomes = polygon::impact_outcomes(body, before_impact(body, 2.0), {-half, half});
      ASSERT_EQ(outcomes.size(), 1u);
      const double slip = polygon::Vertex(body, -half).slip_speed(outcomes[0].after);
      if (factor > 1.0) {
        EXPECT_NEAR(slip, 0.0, 1e-14);
      } else {
        EXPECT_LT(slip, -1e-5);  // slips on in the direction of travel
      }
    }
  }
}

TEST(PolygonImpact, FrictionlessImpactKeepsTangentialMomentum) {
  const PolygonParameters body{.edges = 10, .friction = 0.0};
  const PlanarMotion before = before_impact(body, 2.0);
  const auto outcomes = polygon::impact_outcomes(body, before, {-pi / 10, pi / 10});
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_DOUBLE_EQ(outcomes[0].after.vx, before.vx);
  EXPECT_NEAR(polygon::Vertex(body, -pi / 10).normal_speed(outcomes[0].after), 0.0, 1e-15);
}

TEST(PolygonContact, PainleveProblemsHaveNoneOrSeveralSolutions) {
  // w_nn < mu w_nt: sliding forward with the ground's help.
  const polygon::ContactProblem paradox{.w_nn = 1.0, .w_nt = 2.0, .w_tt = 5.0, .b_n = 1.0, .b_t = 10.0};
  EXPECT_GT(polygon::solutions(paradox, 1.0).size(), 1u);
  const polygon::ContactProblem regular{.w_nn = 1.0, .w_nt = 0.3, .w_tt = 1.0, .b_n = -1.0, .b_t = 2.0};
  EXPECT_EQ(polygon::solutions(regular, 0.4).size(), 1u);
}

TEST(PolygonFlight, FirstTouchDownIsTheFirst) {
  const PolygonParameters body{.edges = 5};
  const PlanarMotion start{.y = 1.7, .theta = 0.3, .vx = 1.0, .vy = 1.5, .omega = 7.0};
  const auto down = polygon::touch_down(body, start, 10.0);
  ASSERT_TRUE(down.has_value());
  EXPECT_NEAR(clearance(body, polygon::flown(body, start, down->elapsed)), 0.0, 1e-14);
  for (int i = 0; i < 20000; ++i) {
    EXPECT_GT(clearance(body, polygon::flown(body, start, down->elapsed * i / 20000.0)), 0.0);
  }
  EXPECT_FALSE(polygon::touch_down(body, start, 0.9 * down->elapsed).has_value());
}

TEST(RigidPolygon, StickingImpactTimesAgreeWithTheEnergyIntegral) {
  // omega^2 = omega_0^2 + 2 k (cos alpha_0 - cos alpha),
  // k = m g R / (I + m R^2); time by quadrature of 1 / omega.
  const PolygonParameters body{.edges = 100};
  const double k = body.gravity / 1.5;
  const double half = pi / body.edges;
  double from = 0.0;
  double omega2 = 9.0;
  double t = 0.0;
  const PolygonResult result = paper_polygon(100, {1.5});
  ASSERT_GT(result.events.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) {
    const auto slowness = [&](double alpha) {
      return 1.0 / std::sqrt(omega2 + 2.0 * k * (std::cos(from) - std::cos(alpha)));
    };
    t += quadrature(slowness, from, half, 1);
    EXPECT_NEAR(result.events[i].t, t, 1e-13) << i;
    omega2 = std::pow(sticking_ratio(body), 2) * (omega2 + 2.0 * k * (std::cos(from) - std::cos(half)));
    from = -half;
  }
}

TEST(RigidPolygon, EnergyIsConstantBetweenStickingImpacts) {
  const PolygonResult result = paper_polygon(40, grid(10.0, 4000));
  ASSERT_EQ(result.status, PolygonStatus::completed);
  ASSERT_FALSE(result.first_departure.has_value());
  const double lost_share = 1.0 - std::pow(sticking_ratio({.edges = 40}), 2);
  std::size_t event = 0;
  int losses = 0;
  for (std::size_t i = 1; i < result.samples.size(); ++i) {
    const PolygonSample& before = result.samples[i - 1];
    const PolygonSample& after = result.samples[i];
    int impacts = 0;
    for (; event < result.events.size() && result.events[event].t < after.t; ++event) ++impacts;
    ASSERT_LE(impacts, 1);
    // At an impact the height is R cos(pi/N), so that the kinetic energy there is known from the total.
    const double at_impact = before.total() - 9.81 * std::cos(pi / 40);
    EXPECT_NEAR(after.total(), before.total() - impacts * lost_share * at_impact, 1e-13) << after.t;
    losses += impacts;
  }
  EXPECT_EQ(losses, result.impacts);
}

TEST(RigidPolygon, PaperPolygonDepartsFromStickingBelow29Edges) {
  // On the first vertex, from 0 to pi/N, the force leaves the cone at 0.11
  // rad: the pendulum decides, not the impacts, which stick from N = 6 on.
  for (const int edges : {6, 10, 20, 28}) {
    const PolygonResult result = paper_polygon(edges, {10.0});
    ASSERT_EQ(result.status, PolygonStatus::completed) << result.reason;
    ASSERT_TRUE(result.first_departure.has_value());
    EXPECT_EQ(result.first_departure->kind, PolygonEventKind::slip_begins);
    EXPECT_NEAR(result.first_departure->t, 0.0365877906, 1e-10);
  }
  for (const int edges : {29, 30, 50, 100, 1000}) {
    EXPECT_FALSE(paper_polygon(edges, {10.0}).first_departure.has_value()) << edges;
  }
}

TEST(RigidPolygon, SlipBeginsWhereTheForceLeavesTheCone) {
  const PolygonResult result = paper_polygon(10, grid(0.1, 10));
  ASSERT_TRUE(result.first_departure.has_value());
  const double t_slip = result.first_departure->t;
  // The angle at that time from the energy integral, the force from Newton's law.
  double alpha = 3.0 * t_slip;
  const auto slowness = [](double a) {
    return 1.0 / std::sqrt(9.0 + 2.0 * 9.81 / 1.5 * (1.0 - std::cos(a)));
  };
  for (int i = 0; i < 20; ++i) alpha -= (quadrature(slowness, 0.0, alpha, 1) - t_slip) / slowness(alpha);
  const double omega2 = 1.0 / std::pow(slowness(alpha), 2);
  const double rate = 9.81 / 1.5 * std::sin(alpha);
  const double normal = 9.81 - omega2 * std::cos(alpha) - rate * std::sin(alpha);
  const double friction = omega2 * std::sin(alpha) - rate * std::cos(alpha);
  EXPECT_NEAR(std::abs(friction) / normal, 0.4, 1e-12);
}

TEST(RigidPolygon, NeverPenetratesNorGainsEnergyInAnyRegime) {
  bool seen[8] = {};
  for (const int edges : {3, 4, 7, 12}) {
    for (const double mu : {0.0, 0.2, 0.7}) {
      for (const double omega : {-4.0, 3.0, 9.0}) {
        for (const double vy : {-1.0, 0.0, 2.0}) {
          const PolygonParameters body{.edges = edges, .friction = mu};
          const PolygonResult result = roll_polygon(body, -3.0, vy, omega, grid(8.0, 400));
          ASSERT_EQ(result.status, PolygonStatus::completed) << result.reason;
          ASSERT_EQ(result.samples.size(), 401u);
          for (std::size_t i = 1; i < result.samples.size(); ++i) {
            const PolygonSample& s = result.samples[i];
            EXPECT_LE(s.total(), result.samples[i - 1].total() + 1e-12);
            const double gap = clearance(body, s.motion);
            EXPECT_GE(gap, -1e-12);
            EXPECT_TRUE(s.phase == PolygonPhase::flight || gap <= 1e-12) << gap;
          }
          for (const PolygonEvent& e : result.events) seen[static_cast<int>(e.kind)] = true;
        }
      }
    }
  }
  for (int kind = 0; kind < 8; ++kind)
    EXPECT_TRUE(seen[kind]) << to_string(static_cast<PolygonEventKind>(kind));
}

TEST(RigidPolygon, FlightIsBallistic) {
  const PolygonResult result = roll_polygon({.edges = 6}, 1.0, 2.0, 0.5, {0.1, 0.2});
  const PlanarMotion& m = result.samples.back().motion;
  EXPECT_EQ(result.samples.back().phase, PolygonPhase::flight);
  EXPECT_NEAR(m.y, 1.0 + 2.0 * 0.2 - 0.5 * 9.81 * 0.04, 1e-15);
  EXPECT_NEAR(m.x, 0.2, 1e-15);
  EXPECT_NEAR(m.theta, 0.1, 1e-15);
}

TEST(RigidPolygon, RockingComesToRestOnAnEdge) {
  const PolygonResult result = paper_polygon(8, grid(30.0, 30));
  ASSERT_EQ(result.status, PolygonStatus::completed);
  const PolygonSample& end = result.samples.back();
  EXPECT_EQ(end.phase, PolygonPhase::rest);
  EXPECT_EQ(end.kinetic, 0.0);
  EXPECT_NEAR(end.motion.y, std::cos(pi / 8), 1e-14);
  EXPECT_NEAR(std::abs(std::remainder(end.motion.theta, pi / 4)), pi / 8, 1e-12);
  // In the limit of small rocks the speed falls by r each and
  // a rock lasts 2 omega (I + m R^2) / (m g R sin(pi/N)).
  std::vector<double> gaps;
  for (std::size_t i = 1; i < result.events.size(); ++i) {
    if (result.events[i].kind == PolygonEventKind::sticking_impact) {
      gaps.push_back(result.events[i].t - result.events[i - 1].t);
    }
  }
  ASSERT_GT(gaps.size(), 30u);
  const double r = sticking_ratio({.edges = 8});
  EXPECT_NEAR(gaps[gaps.size() - 8] / gaps[gaps.size() - 9], r, 1e-5);
}

TEST(RigidPolygon, FlatEdgeSlidesAndStops) {
  // The triangle starts on a vertex, falls over, and lies flat while it still slides.
  const PolygonParameters body{.edges = 3, .friction = 0.1};
  const PolygonResult result = roll_polygon(body, 4.0, 0.0, 0.0, grid(8.0, 800));
  ASSERT_EQ(result.status, PolygonStatus::completed);
  int compared = 0;
  for (std::size_t i = 1; i < result.samples.size(); ++i) {
    const PolygonSample& a = result.samples[i - 1];
    const PolygonSample& b = result.samples[i];
    if (a.phase != PolygonPhase::flat || b.phase != PolygonPhase::flat) continue;
    EXPECT_NEAR(std::abs(a.motion.vx) - std::abs(b.motion.vx), 0.1 * 9.81 * (b.t - a.t), 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 50);
  EXPECT_EQ(result.samples.back().phase, PolygonPhase::rest);
}

/// Damped springs at the vertices and friction regularised over a small slip speed,
/// explicit Euler: as far from the event-driven code as can be, and right to about 1 %.
PlanarMotion penalty_polygon(const PolygonParameters& body, PlanarMotion m, double end) {
  const double stiffness = 1e7;
  const double damping = 1.2e4;  // so far above critical that nothing bounces
  const double h = 2e-6;
  for (double t = 0.0; t < end; t += h) {
    double force_x = 0.0, force_y = -body.mass * body.gravity, torque = 0.0;
    for (int k = 0; k < body.edges; ++k) {
      const double alpha = m.theta + 2.0 * pi * k / body.edges;
      const double rx = std::sin(alpha), ry = -std::cos(alpha);
      if (m.y + ry >= 0.0) continue;
      const double normal = std::max(0.0, -stiffness * (m.y + ry) - damping * (m.vy + m.omega * rx));
      const double friction = -body.friction * normal * std::clamp((m.vx - m.omega * ry) / 1e-3, -1.0, 1.0);
      force_x += friction, force_y += normal, torque += rx * normal - ry * friction;
    }
    m.vx += h * force_x / body.mass, m.vy += h * force_y / body.mass, m.omega += h * torque / body.inertia;
    m.x += h * m.vx, m.y += h * m.vy, m.theta += h * m.omega;
  }
  return m;
}

TEST(RigidPolygon, AgreesWithAPenaltySimulation) {
  // Slipping and sticking, several impacts.
  for (const int edges : {7, 10}) {
    const PolygonParameters body{.edges = edges};
    const PolygonResult exact = paper_polygon(edges, {1.0});
    const PlanarMotion crude = penalty_polygon(body, {.y = 1.0, .vx = -3.0, .omega = 3.0}, 1.0);
    const PlanarMotion& m = exact.samples.back().motion;
    EXPECT_NEAR(crude.x, m.x, 0.02) << edges;
    EXPECT_NEAR(crude.theta, m.theta, 0.02) << edges;
    EXPECT_NEAR(crude.omega, m.omega, 0.03) << edges;
    EXPECT_GT(exact.impacts, 1);
  }
}

TEST(RigidPolygon, ReportsAJam) {
  const PolygonParameters body{.edges = 4, .inertia = 0.05, .friction = 1.0};
  const PolygonResult result = roll_polygon(body, -10.0, 0.0, 1.0, grid(1.0, 100));
  EXPECT_EQ(result.status, PolygonStatus::no_contact_force);
  EXPECT_NE(result.reason.find("Painleve"), std::string::npos);
  EXPECT_LT(result.end, 0.3);
  EXPECT_LT(result.samples.size(), 101u);
}

TEST(RigidPolygon, RefusesBadInput) {
  EXPECT_THROW(roll_polygon({.edges = 2}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({.mass = 0.0}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({.inertia = -1.0}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({.circumradius = 0.0}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({.friction = -0.1}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({.gravity = 0.0}, 0, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({}, 0, 0, 0, {2.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({}, NAN, 0, 0, {1.0}), std::invalid_argument);
  EXPECT_THROW(roll_polygon({}, 0, 0, 0, {1.0}, {.max_events = 0}), std::invalid_argument);
  EXPECT_EQ(roll_polygon({}, -3, 0, 3, {9.0}, {.max_events = 3}).status, PolygonStatus::too_many_events);
}

}  // namespace
}  // namespace touchstone::truth
