#pragma once

#include <memory>

#include "baselines/engines/engine.h"

/// Planar scenes in spatial engines, the same way in all of them.
namespace touchstone::engines {

/// What a moving disc becomes. A sphere whose centre stays in z = 0 touches everything in that plane exactly
/// as the disc does, with one contact point; a cylinder touches along its length, with two or more.
enum class DiscAs { sphere, cylinder };

/// The planar scene as a spatial one, symmetric about z = 0: discs become spheres or cylinders, ellipses
/// ellipsoids (whose section with z = 0 they are), boxes and polygons prisms, half-spaces half-spaces. The
/// inertia I becomes I times the identity, so that there is no gyroscopic moment.
/// @throws Unsupported if a shape has no such counterpart
Scene<3> extruded(const Scene<2>& scene, DiscAs disc);

/// Runs a spatial method that was loaded with extruded(scene) as a planar one. The engine is asked to lock
/// the motion out of the plane; whether it does is checked after each step.
class ExtrudedMethod final : public Method<2>, public TellsMass<2> {
 public:
  /// @param spatial  loaded with extruded(scene, ...)
  ExtrudedMethod(Scene<2> scene, Options effective, std::unique_ptr<Method<3>> spatial);

  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] const Scene<2>& scene() const override { return scene_; }
  [[nodiscard]] std::span<const BodyState<2>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<2>> contacts() const override { return contacts_; }
  /// not_converged if a body leaves the plane by more than 1e-6 m, rad, m/s or rad/s.
  [[nodiscard]] StepReport step(double h) override;
  [[nodiscard]] Options effective_options() const override { return effective_; }
  [[nodiscard]] MassProperties<2> mass_properties(int index) const override;

 private:
  void read_contacts();

  Scene<2> scene_;
  Options effective_;
  std::unique_ptr<Method<3>> spatial_;
  std::vector<BodyState<2>> state_;
  std::vector<ContactImpulse<2>> contacts_;
  bool left_plane_ = false;
};

}  // namespace touchstone::engines
