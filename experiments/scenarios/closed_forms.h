#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/model/scene.h"

/// One body and a plane, in the plane and in space, with its motion in closed form.
///
/// In space the motion is at 30 degrees to the world's axes, so that no axis of a friction box or pyramid
/// lies along it. An incline is a tilted half-space, not a tilted gravity.
namespace touchstone {

template <int Dim>
struct ClosedFormScenario {
  std::string key;                                  ///< "slide_to_roll"
  Scene<Dim> scene;                                 ///< body 0 moves, body 1 is the fixed half-space
  std::function<BodyState<Dim>(double t)> body_at;  ///< body 0 at t >= 0 [s]
  bool has_orientation = true;                      ///< whether body_at() knows the orientation
  double length = 1.0;                              ///< size of the motion up to about 1 s [m]
  double angle = 1.0;                               ///< of the turn [rad]
  double speed = 1.0;                               ///< of velocities [m/s]; angular ones times 1 m
};

/// All of them, sorted by key; spin_and_slide in space only.
template <int Dim>
std::vector<ClosedFormScenario<Dim>> closed_form_scenarios();

}  // namespace touchstone
