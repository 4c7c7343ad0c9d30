#pragma once

#include <vector>

#include "baselines/engines/motion.h"
#include "core/method.h"

/// What an adapter writes: load a scene in the constructor, advance, read back. Everything that is the same
/// for all engines (read-back checks, the echo, failures, extrusion) is written once, in EngineMethod and
/// ExtrudedMethod.
namespace touchstone::engines {

/// What a body weighs as the engine tells it after loading.
template <int Dim>
struct MassProperties {
  double mass = 0.0;                            ///< [kg]
  Inertia<Dim> inertia = Inertia<Dim>::Zero();  ///< about the centre of mass, body frame [kg m^2]
};

/// One loaded world. Body indices are those of the scene.
template <int Dim>
class Engine {
 public:
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  /// Takes one step of `h` [s] the way the engine's users do.
  virtual StepReport advance(double h) = 0;
  /// Pose and velocity of a body now; a fixed body's velocity is zero.
  [[nodiscard]] virtual BodyState<Dim> body(int index) const = 0;
  /// Asked of moving bodies only.
  [[nodiscard]] virtual MassProperties<Dim> mass_properties(int index) const = 0;
  /// Appends the contacts of the last step; nothing if the engine does not give their impulses.
  virtual void read_contacts(std::vector<ContactImpulse<Dim>>& contacts) const = 0;
};

/// For the conformance tests: a method that can tell what it loaded.
template <int Dim>
class TellsMass {
 public:
  virtual ~TellsMass() = default;
  [[nodiscard]] virtual MassProperties<Dim> mass_properties(int index) const = 0;
};

/// Relative rounding of an engine's state, which the echo allows.
inline constexpr double kDoublePrecision = 1e-12;
inline constexpr double kSinglePrecision = 1e-6;

}  // namespace touchstone::engines
