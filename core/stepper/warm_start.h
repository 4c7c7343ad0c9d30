#pragma once

#include <algorithm>
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

/// The last values of something, the latest first, at most `Depth`.
template <typename Value, unsigned Depth>
class History {
 public:
  [[nodiscard]] int count() const { return static_cast<int>(count_); }
  void clear() { count_ = 0; }
  /// @param age  0 for the latest
  [[nodiscard]] const Value& operator[](unsigned age) const { return values_[(latest_ + age) % Depth]; }
  /// The value to be the latest: what is overwritten was the oldest.
  [[nodiscard]] Value& push() {
    latest_ = (latest_ + Depth - 1) % Depth;
    count_ = std::min(count_ + 1, Depth);
    return values_[latest_];
  }

 private:
  std::array<Value, Depth> values_{};
  unsigned latest_ = 0;
  unsigned count_ = 0;
};

/// The last solutions of a stepper, extrapolated to where the next step's search starts. As long as contacts
/// stay as they are the motion is smooth in time, and a cubic through four steps is within O(h^4) of the next
/// one: one Newton step, where the last solution itself would need three.
template <int Dim>
class WarmStart {
 public:
  static constexpr int kDepth = 4;

  explicit WarmStart(const Scene<Dim>& scene);

  /// Finds what is known of these contacts, which come in ascending order of (lower, higher body).
  void match(std::span<const ContactPair<Dim>> contacts);
  [[nodiscard]] bool knows(std::size_t contact) const { return known_[contact] != kNew; }
  /// How many last steps, at most kDepth, all of these bodies and contacts have gone through without a
  /// contact that closed or opened; 1 if nothing changes.
  [[nodiscard]] int depth(std::span<const int> bodies, std::span<const std::size_t> contacts) const;

  /// Extrapolated through `depth` >= 1 last steps.
  [[nodiscard]] Twist<Dim> velocity(int body, int depth) const;
  /// Valid until the next call. The contact is known.
  [[nodiscard]] const ContactSolution<Dim>& contact(std::size_t contact, int depth);

  /// The last accepted solution of contact number i of those that were matched for it.
  [[nodiscard]] const ContactSolution<Dim>& last(std::size_t contact) const {
    return traces_[order_[contact]].solutions[0];
  }

  /// Where a step's solution of contact number i is to be written, before accept().
  [[nodiscard]] ContactSolution<Dim>& next(std::size_t contact) { return next_[contact]; }
  /// Makes the solutions written, of the contacts that were matched last, the last ones.
  void accept(std::span<const ContactPair<Dim>> contacts, std::span<const BodyState<Dim>> state);

 private:
  static constexpr std::size_t kNew = static_cast<std::size_t>(-1);

  struct ContactTrace {
    std::array<int, 2> bodies{};
    History<ContactSolution<Dim>, kDepth> solutions;
  };
  struct VelocityTrace {
    bool steady = false;  ///< the last two are the same but for rounding
    History<Twist<Dim>, kDepth> velocities;
  };

  std::vector<VelocityTrace> velocities_;  ///< one a body
  std::vector<ContactTrace> traces_;       ///< in no order
  std::vector<std::size_t> order_;         ///< of the last step's contacts in traces_
  std::vector<bool> taken_;                ///< of traces_, by this step's contacts
  std::vector<std::size_t> known_;         ///< of the contacts that were matched; kNew for a new one
  std::vector<ContactSolution<Dim>> next_;
  ContactSolution<Dim> extrapolated_;
};

}  // namespace touchstone
