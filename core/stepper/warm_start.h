#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/stepper/layout.h"

namespace touchstone {

/// What a step's solution leaves of one contact.
template <int Dim>
struct ContactSolution {
  Vector<Dim> a_1 = Vector<Dim>::Zero();  ///< closest points relative to body 1, world axes [m]
  Vector<Dim> a_2 = Vector<Dim>::Zero();
  Vector<Dim> normal = Vector<Dim>::Zero();
  FrictionVector<Dim> y = FrictionVector<Dim>::Zero();  ///< as in ContactLayout
  double p = 0.0;
  double s = 0.0;
  std::vector<double> multipliers;
};

/// The last solutions of a stepper, extrapolated to where the next step's search starts. As long as contacts
/// stay as they are the motion is smooth in time, and a parabola through three steps is within O(h^3) of the
/// next one: one Newton step, where the last solution itself would need three.
template <int Dim>
class WarmStart {
 public:
  static constexpr int kDepth = 3;

  explicit WarmStart(const Scene<Dim>& scene);

  /// Finds what is known of these contacts, which come in ascending order of (lower, higher body).
  void match(std::span<const ContactPair<Dim>> contacts);
  [[nodiscard]] bool knows(std::size_t contact) const { return known_[contact] != nullptr; }
  /// How many last steps, at most kDepth, all of these bodies and contacts have gone through without a
  /// contact that closed or opened; 1 if nothing changes.
  [[nodiscard]] int depth(std::span<const int> bodies, std::span<const std::size_t> contacts) const;

  /// Extrapolated through `depth` >= 1 last steps.
  [[nodiscard]] Twist<Dim> velocity(int body, int depth) const;
  /// Valid until the next call. The contact is known.
  [[nodiscard]] const ContactSolution<Dim>& contact(std::size_t contact, int depth);

  /// The last accepted solution of contact number i of those that were matched for it.
  [[nodiscard]] const ContactSolution<Dim>& last(std::size_t contact) const {
    return traces_[contact].last[0];
  }

  /// Where a step's solution of contact number i is to be written, before accept().
  [[nodiscard]] ContactSolution<Dim>& next(std::size_t contact) { return next_[contact]; }
  /// Makes the solutions written, of the contacts that were matched last, the last ones.
  void accept(std::span<const ContactPair<Dim>> contacts, std::span<const BodyState<Dim>> state);

 private:
  /// Solutions of one contact, the latest first.
  struct Trace {
    std::array<int, 2> bodies{};
    int count = 0;
    std::array<ContactSolution<Dim>, kDepth> last{};
  };
  struct VelocityTrace {
    int count = 0;
    bool steady = false;  ///< the last two are the same but for rounding
    std::array<Twist<Dim>, kDepth> last{};
  };

  std::vector<VelocityTrace> velocities_;  ///< one a body
  std::vector<Trace> traces_, new_traces_;
  std::size_t trace_count_ = 0;
  std::vector<Trace*> known_;  ///< of the contacts that were matched; null for a new one
  std::vector<ContactSolution<Dim>> next_;
  ContactSolution<Dim> extrapolated_;
};

}  // namespace touchstone
