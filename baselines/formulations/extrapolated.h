#pragma once

#include <memory>

#include "core/method.h"

namespace touchstone {

/// What the registry has of a method: loads a scene with options.
template <int Dim>
using MakeMethod = std::unique_ptr<Method<Dim>> (*)(const Scene<Dim>& scene, const Options& options);

/// Richardson's extrapolation over a first-order method (L. F. Richardson, Phil. Trans. R. Soc. A 226, 1927):
/// the method is run twice from the start, side by side, with steps h (c) and h/2 (f), and what is read back
/// is
///   x = 2 x_f - x_c,   q = exp(2 log(q_f q_c^-1)) q_c,   nu = 2 nu_f - nu_c.
/// It is passive: the two runs know nothing of each other or of the combination. Where the method's error is
/// C(t) h + O(h^2) with a smooth C the combination's is O(h^2). Where it is not (an impact that the runs
/// place in different steps, contact points that jump) it may be worse than either, for one step or for good.
///
/// error_estimate() is f - c, which estimates the error of the FINE run and so is a cautious bound of the
/// combination's where extrapolation works. It grows by itself where the runs part.
///
/// The combination solves no step: Capabilities::one_run is false, and the residual of Eqs. 10-11 is that of
/// the two runs (see coarse() and fine()). Its bodies may overlap, by O(h^2) in continuous contact.
///
/// contacts() and joints() are the FINE run's, over both half steps: impulses of a pair of bodies that has
/// one contact in each are added up, at the place and in the frame of the second. They do not account for the
/// change of the combined velocities to rounding, hence Capabilities::contact_impulses is false. Impulses
/// combined as velocities are would balance momentum, but at an impact they may pull, and what they lose
/// there has no limit for h -> 0: energy is quadratic, and a combination of before and after is neither.
template <int Dim>
class Extrapolated final : public Method<Dim> {
 public:
  /// @throws what `make` throws
  Extrapolated(MakeMethod<Dim> make, const Scene<Dim>& scene, const Options& options);

  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] const Scene<Dim>& scene() const override { return coarse_->scene(); }
  [[nodiscard]] std::span<const BodyState<Dim>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<Dim>> contacts() const override { return contacts_; }
  [[nodiscard]] std::span<const JointImpulse<Dim>> joints() const override { return joints_; }
  [[nodiscard]] std::span<const StateError<Dim>> error_estimate() const override { return error_; }
  /// Iterations are those of all three steps, the residual is their largest. If one of the three fails the
  /// runs are no longer at the same time: state() stays, and every further step fails too.
  [[nodiscard]] StepReport step(double h) override;
  [[nodiscard]] Options effective_options() const override { return coarse_->effective_options(); }

  [[nodiscard]] const Method<Dim>& coarse() const { return *coarse_; }
  [[nodiscard]] const Method<Dim>& fine() const { return *fine_; }

 private:
  void remember_first_half();
  void add_first_half();
  void combine();

  std::unique_ptr<Method<Dim>> coarse_;
  std::unique_ptr<Method<Dim>> fine_;
  bool parted_ = false;  ///< a step failed in one of the runs
  std::vector<BodyState<Dim>> state_;
  std::vector<StateError<Dim>> error_;
  std::vector<ContactImpulse<Dim>> contacts_;
  std::vector<ContactImpulse<Dim>> first_half_;
  std::vector<JointImpulse<Dim>> joints_;
  std::vector<JointImpulse<Dim>> joints_first_half_;
};

/// The method that `make` makes, extrapolated; a factory for the table of methods. Options are the method's.
template <int Dim, MakeMethod<Dim> make>
std::unique_ptr<Method<Dim>> make_extrapolated(const Scene<Dim>& scene, const Options& options) {
  return std::make_unique<Extrapolated<Dim>>(make, scene, options);
}

}  // namespace touchstone
