#pragma once

#include <span>
#include <vector>

#include "core/stepper/layout.h"

namespace touchstone {

/// The pairs of a scene's bodies that may touch during a step.
///
/// A pair enters a step's problem if its bounding balls come within reach of each other during the step at
/// the speeds that the bodies have. That is a guess, since impulses change speeds: after the solve the
/// stepper asks for the pairs that were left out and overlap nevertheless, adds them, and solves again. So
/// the result does not depend on the guess.
template <int Dim>
class ContactCandidates {
 public:
  /// One pair of bodies, not both fixed and not coupled by a joint, and its surfaces.
  struct Pair {
    ContactPair<Dim> contact{};
    bool selected = false;
  };

  /// @throws Unsupported for a shape without a surface, or two half-spaces of which one moves
  explicit ContactCandidates(const Scene<Dim>& scene);

  /// Selects the pairs within reach of a step of h [s] from `state`.
  void select(std::span<const BodyState<Dim>> state, double h);
  /// Selects those that are not selected and overlap in `state`. @return whether there were any
  bool add_overlapping(std::span<const BodyState<Dim>> state);

  [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }
  [[nodiscard]] const ConvexSurface<Dim>& surface(int body) const {
    return *surfaces_[static_cast<std::size_t>(body)];
  }

 private:
  /// Least distance of the bounding balls, or of ball and half-space, [m].
  [[nodiscard]] double ball_gap(const ContactPair<Dim>& contact, std::span<const BodyState<Dim>> state) const;
  [[nodiscard]] double reach(const ContactPair<Dim>& contact, std::span<const BodyState<Dim>> state,
                             double h) const;

  const Scene<Dim>& scene_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
  std::vector<typename ConvexSurface<Dim>::BoundingBall> balls_;  ///< body frame
  std::vector<Pair> pairs_;
};

}  // namespace touchstone
