#pragma once

#include <memory>
#include <utility>

#include "baselines/engines/engine.h"

namespace touchstone::engines {

/// A Method in front of an Engine: checks on loading that the engine echoes the scene, keeps the read-back
/// state, and turns a NaN into a status with the last finite state kept. After a failed step the engine's own
/// state is unknown, so every later step fails the same way.
template <int Dim>
class EngineMethod final : public Method<Dim>, public TellsMass<Dim> {
 public:
  /// @param precision  relative rounding that the echo allows, kDoublePrecision or kSinglePrecision
  /// @throws std::logic_error naming body and quantity if mass, inertia, pose or velocity differ from the
  /// scene's
  EngineMethod(Scene<Dim> scene, Options effective, Capabilities capabilities, double precision,
               std::unique_ptr<Engine<Dim>> engine);

  [[nodiscard]] Capabilities capabilities() const override { return capabilities_; }
  [[nodiscard]] const Scene<Dim>& scene() const override { return scene_; }
  [[nodiscard]] std::span<const BodyState<Dim>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<Dim>> contacts() const override { return contacts_; }
  [[nodiscard]] StepReport step(double h) override;
  [[nodiscard]] Options effective_options() const override { return effective_; }
  [[nodiscard]] MassProperties<Dim> mass_properties(int index) const override {
    return engine_->mass_properties(index);
  }

 private:
  void read_state(std::vector<BodyState<Dim>>& state) const;
  void check_echo(double precision) const;
  StepReport guarded_advance(double h);

  Scene<Dim> scene_;
  Options effective_;
  Capabilities capabilities_;
  std::unique_ptr<Engine<Dim>> engine_;
  std::vector<BodyState<Dim>> state_;
  std::vector<BodyState<Dim>> next_state_;
  std::vector<ContactImpulse<Dim>> contacts_;
  StepReport failure_{};  ///< of the first step that failed
};

}  // namespace touchstone::engines
