#pragma once

#include <cmath>
#include <vector>

#include "experiments/scenarios/truths/rigid_polygon.h"

/// The contact laws of the rigid polygon: a vertex or an edge on the ground, in forces and in impulses.
namespace touchstone::truth::polygon {

/// One contact with Coulomb friction in the plane. The response is linear:
///   u_n = w_nn n + w_nt t + b_n,   u_t = w_nt n + w_tt t + b_t,
/// in impulses and velocities [N s, m/s] for an impact, in forces
/// and accelerations [N, m/s^2] for contact without slip.
struct ContactProblem {
  double w_nn = 1.0, w_nt = 0.0, w_tt = 1.0;  ///< Delassus operator, positive definite [1/kg]
  double b_n = 0.0, b_t = 0.0;

  [[nodiscard]] double u_n(double n, double t) const { return w_nn * n + w_nt * t + b_n; }
  [[nodiscard]] double u_t(double n, double t) const { return w_nt * n + w_tt * t + b_t; }
};

enum class ContactMode { separates, sticks, slips_forward, slips_backward };

struct ContactSolution {
  ContactMode mode = ContactMode::separates;
  double n = 0.0, t = 0.0;
};

/// The force or impulse that holds the contact: u_n = u_t = 0, whatever its sign.
ContactSolution holding(const ContactProblem& problem);

/// Every solution of 0 <= n _|_ u_n >= 0, |t| <= mu n, t = -mu n sign(u_t) if u_t != 0, up to coincidence
/// at the limits between two modes. One if w_nn > mu |w_nt|; otherwise there may be none, two or three.
std::vector<ContactSolution> solutions(const ContactProblem& problem, double mu);

/// A vertex at angle `alpha` from straight below the centre: r = R (sin alpha, -cos alpha).
class Vertex {
 public:
  Vertex(const PolygonParameters& body, double alpha)
      : body_(body), sin_(std::sin(alpha)), cos_(std::cos(alpha)) {}

  [[nodiscard]] double normal_speed(const PlanarMotion& m) const {
    return m.vy + body_.circumradius * sin_ * m.omega;
  }
  [[nodiscard]] double slip_speed(const PlanarMotion& m) const {
    return m.vx + body_.circumradius * cos_ * m.omega;
  }

  /// Impulses and velocities after an impact.
  [[nodiscard]] ContactProblem impact(const PlanarMotion& before) const;
  /// Forces and accelerations at angular velocity omega; gravity included.
  [[nodiscard]] ContactProblem acceleration(double omega) const;

  /// Velocity after an impulse (n, t) at this vertex.
  [[nodiscard]] PlanarMotion struck(PlanarMotion motion, double n, double t) const;
  /// Angular acceleration by a force (n, t) at this vertex [rad/s^2].
  [[nodiscard]] double spin_up(double n, double t) const {
    return body_.circumradius * (n * sin_ + t * cos_) / body_.inertia;
  }

 private:
  [[nodiscard]] ContactProblem response(double b_n, double b_t) const;

  const PolygonParameters& body_;
  double sin_, cos_;
};

/// Which of the vertices in contact are in contact after an impact, and how.
struct ImpactOutcome {
  PlanarMotion after;
  PolygonEventKind kind = PolygonEventKind::sticking_impact;
  std::size_t vertex = 0;  ///< index of the vertex that takes the impulse, unless both do
};

/// Every solution of Moreau's impact law with e = 0, one for each different velocity after the impact.
/// @param alphas  angles of the one or two vertices on the ground; two are the ends (-pi/N, pi/N) of an edge
std::vector<ImpactOutcome> impact_outcomes(const PolygonParameters& body, const PlanarMotion& before,
                                           const std::vector<double>& alphas);

}  // namespace touchstone::truth::polygon
