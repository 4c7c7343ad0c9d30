#pragma once

#include <vector>

#include "core/model/scene.h"
#include "experiments/scenarios/truths/ellipsoid_rolling.h"

/// A rattleback: an ellipsoid whose principal axes of inertia are turned a little against its own. Shape and
/// mass as in Kane and Levinson, "Realistic mathematical modeling of the rattleback", Int. J. Non-Linear
/// Mechanics 17 (1982); the product of inertia is 2.5 times theirs, so that it turns back sooner.
namespace touchstone {

struct Rattleback {
  double mass = 1.0;                        ///< [kg]
  Vector<3> semi_axes{0.2, 0.03, 0.02};     ///< [m]
  double drop = 0.01;                       ///< of the centre of mass below the ellipsoid's centre [m]
  Vector<3> moments{2e-4, 1.6e-3, 1.7e-3};  ///< about the centre of mass, xx, yy, zz [kg m^2]
  double product = -5e-5;                   ///< xy [kg m^2]
  double mu = 2.0;                          ///< does not slip
  double gravity = 9.81;                    ///< [m/s^2]
  double spin = -5.0;                       ///< about the vertical [rad/s]; < 0, clockwise: it turns back
  double nudge = 0.5;                       ///< about its long axis [rad/s]

  /// The same body, rolling without slip, for the truth.
  [[nodiscard]] truth::RollingEllipsoid rolling() const;
};

/// Level on the table and rolling at the start. Bodies "back" and "table", the half-space z <= 0.
Scene<3> rattleback_scene(const Rattleback& parameters = {});

/// Changes of sense of a spin over time, and when the first was. A sense counts as soon as the spin has
/// reached a tenth of its first value in it, so that rocking about zero is no reversal.
struct Reversals {
  int count = 0;
  double first = -1.0;  ///< where the spin went through zero, by linear interpolation [s]; < 0: never
};
Reversals count_reversals(const std::vector<double>& times, const std::vector<double>& spins);

}  // namespace touchstone
