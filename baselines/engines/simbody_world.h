#pragma once

#include <memory>
#include <string>

#include "baselines/engines/motion.h"
#include "core/model/scene.h"

/// Simbody behind a wall: its headers are not C++20, so this header and its .cpp keep to C++17, and
/// simbody.cpp makes an Engine of it.
namespace touchstone::engines {

/// Of the rigid contacts: unilateral constraints in the semi-explicit Euler stepper.
struct SimbodyRigidSettings {
  int iterations;    ///< of projected Gauss-Seidel, at most
  double tolerance;  ///< of projected Gauss-Seidel
  double proximity;  ///< gap below which a contact is a constraint [m], and slip below which it sticks [m/s]
};

/// Of the compliant contacts: Hunt and Crossley's forces under an integrator with error control.
struct SimbodyCompliantSettings {
  double stiffness;            ///< plane-strain modulus of each surface [Pa]
  double dissipation;          ///< Hunt and Crossley's c of each surface [s/m]
  double transition_velocity;  ///< slip at which friction has its full size [m/s]
  double accuracy;             ///< of the integrator, relative
};

class SimbodyWorld {
 public:
  virtual ~SimbodyWorld() = default;
  /// Advances by `h` [s]. @returns the steps that the integrator took, or 0
  virtual int advance(double h) = 0;
  [[nodiscard]] virtual BodyState<3> body(int index) const = 0;
  [[nodiscard]] virtual double mass(int index) const = 0;
  /// About the centre of mass, body frame [kg m^2].
  [[nodiscard]] virtual Inertia<3> inertia(int index) const = 0;
};

/// @throws Unsupported naming a body or pair that has no such contact
std::unique_ptr<SimbodyWorld> make_simbody_world(const Scene<3>& scene, const SimbodyRigidSettings& settings,
                                                 Motion motion);
std::unique_ptr<SimbodyWorld> make_simbody_world(const Scene<3>& scene,
                                                 const SimbodyCompliantSettings& settings, Motion motion);

std::string simbody_version();

}  // namespace touchstone::engines
