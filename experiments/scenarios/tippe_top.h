#pragma once

#include "core/model/scene.h"

/// A tippe top: a ball whose centre of mass is below its centre. Spun about the vertical, friction turns it
/// upside down.
namespace touchstone {

struct TippeTop {
  double mass = 0.02;          ///< [kg]
  double radius = 0.02;        ///< R of the ball [m]
  double offset = 0.003;       ///< l, from the centre of mass to the ball's centre along the axis [m]
  double axial = 3.2e-6;       ///< about the axis and ...
  double transverse = 3.2e-6;  ///< ... across it, about the centre of mass [kg m^2]
  double mu = 0.2;             ///< and no torsion, or Jellett's constant is none
  double gravity = 9.81;       ///< [m/s^2]
  double tilt = 0.1;           ///< of the axis from the vertical at the start [rad]
  double spin = 200.0;         ///< [rad/s]
  /// Spun about its own tilted axis, and rolling, instead of about the vertical: it does not invert then.
  bool about_axis = false;

  /// -L.r of a state [kg m^2/s]; constant in any motion on the table.
  [[nodiscard]] double jellett(const BodyState<3>& top) const;
  /// Of the axis from the vertical, in [0, pi] [rad].
  [[nodiscard]] double inclination(const BodyState<3>& top) const;
  /// Speed of the contact point over the table [m/s].
  [[nodiscard]] double slip(const BodyState<3>& top) const;
};

/// Bodies "top", its axis along its z with the heavy end at -z, and "table", the half-space z <= 0.
Scene<3> tippe_top_scene(const TippeTop& parameters = {});

}  // namespace touchstone
