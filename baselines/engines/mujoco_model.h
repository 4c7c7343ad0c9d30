#pragma once

#include <string>

#include "baselines/engines/engine.h"

/// The scene as MuJoCo's users write it: an MJCF model.
namespace touchstone::engines {

struct MujocoSettings {
  std::string cone;       ///< "elliptic" or "pyramidal"
  double timeconst;       ///< solref: time constant of a contact [s]; MuJoCo raises it to at least two steps
  double dampratio;       ///< solref: damping ratio of a contact
  double dmin;            ///< solimp: impedance at zero depth
  double dmax;            ///< solimp: impedance at depth `width`
  double width;           ///< solimp [m]
  double margin;          ///< distance below which a contact acts [m]
  double impratio;        ///< impedance of friction over that of the normal
  int noslip_iterations;  ///< of the solver pass that removes slip
  int iterations;         ///< of Newton's method, at most
  double tolerance;       ///< of Newton's method, on the scaled decrease of the cost
};

/// Body i of the scene is the geom "g<i>"; if it moves it is also the body "b<i>". Spatial bodies have a free
/// joint, planar ones slide joints along x and y and a hinge about z, in this order, whose zero is the
/// world's origin.
/// @throws Unsupported if a shape has no geom
std::string mujoco_xml(const Scene<3>& scene, const MujocoSettings& settings, Motion motion);

}  // namespace touchstone::engines
