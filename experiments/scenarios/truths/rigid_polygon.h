#pragma once

#include <optional>
#include <string>
#include <vector>

namespace touchstone::truth {

/// A rigid regular polygon in a vertical plane above the ground y = 0. SI units.
struct PolygonParameters {
  int edges = 16;             ///< N >= 3
  double mass = 1.0;          ///< > 0 [kg]
  double inertia = 0.5;       ///< > 0, about the centre [kg m^2]
  double circumradius = 1.0;  ///< R > 0, centre to vertex [m]
  double friction = 0.4;      ///< Coulomb's mu >= 0, at the vertices
  double gravity = 9.81;      ///< > 0, along -y [m/s^2]

  /// @throws std::invalid_argument naming the field, its value and the bound
  void validate() const;
};

/// World frame, x to the right, y up; angles and omega counter-clockwise. The point of the body at
/// r from the centre has velocity v + omega x r, so rolling without slip with omega > 0 goes to -x.
struct PlanarMotion {
  double x = 0.0, y = 0.0;    ///< centre [m]
  double theta = 0.0;         ///< [rad], not wrapped; at 0 vertex 0 is straight below the centre
  double vx = 0.0, vy = 0.0;  ///< [m/s]
  double omega = 0.0;         ///< [rad/s]
};

enum class PolygonPhase {
  sticking,  ///< one vertex down at rest: an inverted pendulum
  sliding,   ///< one vertex down, slipping
  flight,
  flat,  ///< an edge lies on the ground and slides
  rest   ///< an edge lies on the ground, for ever
};

struct PolygonSample {
  double t = 0.0;  ///< [s]
  PlanarMotion motion;
  PolygonPhase phase = PolygonPhase::sticking;
  double kinetic = 0.0;    ///< [J]
  double potential = 0.0;  ///< m g y [J]
  [[nodiscard]] double total() const { return kinetic + potential; }
};

enum class PolygonEventKind {
  sticking_impact,  ///< the new vertex takes the whole impulse and sticks, the old one lifts: the textbook
                    ///< case
  slipping_impact,  ///< as before, but the new vertex slips after the impact
  flat_impact,      ///< both vertices of an edge take an impulse and the edge comes to lie on the ground
  slip_begins,
  slip_ends,
  lift_off,
  settles,  ///< infinitely many ever smaller rocks have come to their end
  stops     ///< the edge has stopped sliding
};

struct PolygonEvent {
  double t = 0.0;
  PolygonEventKind kind = PolygonEventKind::sticking_impact;
};

enum class PolygonStatus {
  completed,
  no_contact_force,    ///< no force is consistent with rigid contact and Coulomb's law (Painleve)
  ambiguous_contact,   ///< several are
  no_impact_solution,  ///< Moreau's impact law has no solution
  ambiguous_impact,    ///< it has several, with different velocities
  too_many_events,     ///< more than PolygonOptions::max_events
  integration_failed
};

struct PolygonOptions {
  int max_events = 2'000'000;  ///< > 0
};

struct PolygonResult {
  PolygonStatus status = PolygonStatus::completed;
  std::string reason;  ///< in words, empty if completed
  double end = 0.0;    ///< how far the truth reaches [s]
  std::vector<PolygonSample>
      samples;  ///< at the requested times up to `end`; at an event, the state before it
  std::vector<PolygonEvent> events;
  int impacts = 0;
  /// The first event that is not a sticking impact: up to it
  /// the body is a pendulum about one vertex after the other.
  std::optional<PolygonEvent> first_departure;
};

/// The exact motion (to 1e-12 of the energy) of the rigid polygon that starts
/// with vertex 0 straight down on the ground, centre at (0, R), with the given
/// velocity; an impact at t = 0 if that vertex moves into the ground.
///
/// Event-driven: every phase is a smooth ODE or a closed form, its end is located to rounding, and
/// the normal force and the friction cone are watched throughout. Impacts are plastic (e = 0) after
/// Moreau: at every vertex in contact the impulse and the velocity AFTER the impact satisfy
/// 0 <= p_n _|_ u_n >= 0 and Coulomb's law. All combinations of sticking, slipping and separating are
/// tried, and the impact is accepted only if all that fit agree in velocity.
///
/// While the new vertex sticks and the old one lifts, angular momentum about the new vertex is conserved:
///   omega+ / omega- = (I + m R^2 cos(2 pi / N)) / (I + m R^2).
///
/// Rocking on an edge has infinitely many impacts in finite time. It is cut when
/// omega R has fallen below 1e-10 sqrt(g R), where the energy left is 1e-20 of m g R.
///
/// @param times  [s], increasing, >= 0
/// @throws std::invalid_argument on parameters, times or options out of range
PolygonResult roll_polygon(const PolygonParameters& parameters, double vx, double vy, double omega,
                           const std::vector<double>& times, const PolygonOptions& options = {});

const char* to_string(PolygonStatus status);
const char* to_string(PolygonPhase phase);
const char* to_string(PolygonEventKind kind);

}  // namespace touchstone::truth
