#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/method.h"

/// The judge stands outside the accused: everything here is computed from the scene, read-back states and
/// contact impulses, by the same code for every method. The residual of a step is that of the certificate's
/// checker, which shares nothing with the step problem but the surfaces.
namespace touchstone {

struct Energy {
  double kinetic = 0.0;    ///< [J]
  double potential = 0.0;  ///< of gravity and the constant applied forces, zero at the world's origin [J]
  [[nodiscard]] double total() const { return kinetic + potential; }
};

/// By how much one step misses Eqs. 10-11, the paper's own system, with the geometry at the END of the step.
/// Lengths are over the size L of the largest moving body, velocities (and impulses over the body's mass)
/// over V = sqrt(|g| L), or L / (1 s) without gravity, so that one number means one thing.
struct StepResidual {
  double dynamics = 0.0;    ///< M nu' - M nu - sum W p - p_app - p_vp
  double kinematics = 0.0;  ///< q' - q (+) h nu'
  double contact = 0.0;   ///< Eqs. 6, 9, 20-22: points on their surfaces, opposite, along both normals, 0 <=
                          ///< p_n _|_ psi >= 0, nothing overlaps
  double joints = 0.0;    ///< by how much the joints' anchors, axes and orientations have come apart
  double friction = 0.0;  ///< Eq. 5 as printed (Fritz-John), with sigma the least that its rows allow
  [[nodiscard]] double largest() const;
};

template <int Dim>
class Judge {
 public:
  /// @param scene  as the method represents it; must outlive the judge. @throws Unsupported for a shape
  /// without a surface
  explicit Judge(const Scene<Dim>& scene);

  [[nodiscard]] Energy energy(std::span<const BodyState<Dim>> state) const;
  /// Depth of the deepest overlap of any two bodies that collide, [m]; 0 if none overlap. Bodies that a joint
  /// couples do not collide.
  [[nodiscard]] double largest_penetration(std::span<const BodyState<Dim>> state) const;
  /// @param contacts  every contact that carried an impulse in the step; others may be there too
  [[nodiscard]] StepResidual step_residual(std::span<const BodyState<Dim>> before,
                                           std::span<const BodyState<Dim>> after,
                                           std::span<const ContactImpulse<Dim>> contacts, double h,
                                           std::span<const JointImpulse<Dim>> joints = {}) const;

 private:
  /// Depth of the overlap of two bodies, i < j; 0 if they are apart or do not collide [m].
  [[nodiscard]] double overlap(std::size_t i, std::size_t j, std::span<const BodyState<Dim>> state) const;

  const Scene<Dim>& scene_;
  certificate::Checker<Dim> checker_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
};

}  // namespace touchstone
