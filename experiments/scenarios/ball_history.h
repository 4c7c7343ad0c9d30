#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "experiments/harness/run_case.h"
#include "experiments/scenarios/truths/sphere_on_spheres.h"

/// What a ball on two balls does, step by step: velocities, forces, contact modes, and how well each contact
/// keeps its law. The same from a method's run and from the event-driven truth.
namespace touchstone {

using truth::BallContactMode;

/// One contact over one step (of a truth: at one time); forces are mean ones, impulse over h. While it is
/// apart all are zero.
struct BallContactInstant {
  BallContactMode mode = BallContactMode::apart;
  double normal = 0.0;          ///< [N]
  double tangential = 0.0;      ///< [N]
  double torsion = 0.0;         ///< on the ball, about the normal from the support [N m]
  double friction_norm = 0.0;   ///< |E^-1 p_f| [N]
  double friction_limit = 0.0;  ///< mu lambda_n [N]
  double slip = 0.0;            ///< [m/s]
  double spin = 0.0;            ///< about the normal [rad/s]
  double sigma = 0.0;           ///< |E v_f| [m/s]
};

struct BallInstant {
  double t = 0.0;  ///< [s]
  Twist<3> velocity = Twist<3>::Zero();
  /// None at the start of a method's run, when no contact has acted yet.
  std::optional<std::array<BallContactInstant, 2>> contacts;
};
using BallHistory = std::vector<BallInstant>;

/// A contact slides if its friction is on the ellipsoid within 1e-6 of it, or if sigma is above 1e-3 m/s,
/// which is for methods whose friction is bounded by something else. It is apart if it carries no impulse.
/// @param run  with kept steps, of a scene with bodies "ball", "support 1" and "support 2"
BallHistory ball_history(const harness::CaseRun<3>& run, const Scene<3>& scene, double h);
BallHistory ball_history(const truth::SphereOnSpheres& scene, const truth::SphereOnSpheresResult& result);

std::string_view to_string(BallContactMode mode);  ///< rolling, sliding, apart

/// The changes of contact mode. A change is dated to the end of the first step in the new mode.
struct BallEvents {
  /// "1 slides, 2 rolls; 2 slides; 1 separates": the modes of the first step, then every change in its order.
  std::string story;
  std::array<std::optional<double>, 2> slides;  ///< since when a contact that had rolled never does again [s]
  std::array<std::optional<double>, 2> separates;  ///< since when it never touches again [s]
};
BallEvents ball_events(const BallHistory& history);
BallEvents ball_events(const truth::SphereOnSpheresResult& result);

/// The largest violations of the contact laws in a method's run.
struct BallLaws {
  /// sigma of contacts whose friction is inside the ellipsoid by more than 1e-6 of it [m/s]: they must not
  /// slip.
  double rolling_slip = 0.0;
  /// | |E^-1 p_f| - mu p_n | of contacts with sigma above 1e-6 m/s [N s]: it must be on the ellipsoid.
  double sliding_friction_gap = 0.0;
  /// Where a contact separates: by how much any of the six velocities changes more or less than in both of
  /// the steps beside it, over the largest change there; none if none separates. 0 where accelerations pass
  /// from one value to the next, of the order of h where they bend, and not small where a velocity jumps.
  std::optional<double> separation_jump;
};
BallLaws ball_laws(const BallHistory& history, double h);

}  // namespace touchstone
