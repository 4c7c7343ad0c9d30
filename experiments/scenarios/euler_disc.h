#pragma once

#include "core/model/scene.h"
#include "experiments/scenarios/truths/gyroscopes.h"

/// A coin that rolls on its rim on a table while its centre stays at rest ("Euler's disc").
namespace touchstone {

struct EulerDiscScene {
  truth::EulerDisc disc = truth::EulerDisc::uniform(1.0, 0.5, 0.02);
  double inclination = 0.3490658503988659;  ///< alpha at the start, in (0, pi/2) [rad]; 20 degrees
  double mu = 1.0;
  double torsion = 0.0;  ///< e_r [m]; 0: nothing but the step takes energy
};

/// In steady motion at the start: the contact at (-a cos(alpha) + d sin(alpha), 0, 0), the centre above the
/// origin. Bodies "coin", its axis along its z, and "table", the half-space z <= 0.
Scene<3> euler_disc_scene(const EulerDiscScene& parameters = {});

struct EulerDiscMotion {
  double inclination = 0.0;   ///< alpha of the coin's plane to the table [rad]
  double precession = 0.0;    ///< rate at which its axis goes round the vertical [rad/s]
  double contact_spin = 0.0;  ///< omega_z, against which torsion works [rad/s]
  double center_speed = 0.0;  ///< horizontal [m/s]; 0 in the steady motion
};
EulerDiscMotion euler_disc_motion(const BodyState<3>& coin);

}  // namespace touchstone
