#pragma once

#include <memory>
#include <string>

#include "baselines/engines/engine.h"

/// Bullet's world behind a wall. Its .cpp is compiled twice: in double precision into the library, and in
/// single precision into a module of its own (bullet_float_module.h).
namespace touchstone::engines {

enum class BulletSolver { sequential_impulse, nncg, dantzig, pgs };

struct BulletSettings {
  BulletSolver solver;
  int iterations;                ///< of the iterative solvers; Dantzig's pivots do not count
  double erp;                    ///< share of an overlap that one step removes
  double restitution_threshold;  ///< approach speed below which nothing bounces [m/s]
  double hull_margin;            ///< thickness around a convex hull [m]
  double split_impulse_below;    ///< distance below which overlap is removed by pseudo-velocities alone [m]
  double contact_below;          ///< distance below which a contact acts [m]; large: speculative contacts
};

/// @throws Unsupported naming a body whose shape has no Bullet counterpart
std::unique_ptr<Engine<3>> make_bullet_world(const Scene<3>& scene, const BulletSettings& settings,
                                             Motion motion);

/// Of the headers, with the file that was loaded. @throws IoError if they are of two versions
std::string bullet_version();

}  // namespace touchstone::engines
