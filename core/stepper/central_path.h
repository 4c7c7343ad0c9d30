#pragma once

#include <Eigen/LU>

#include "core/stepper/smoothed_step.h"

namespace touchstone {

/// Follows the central path of a step's problem (SmoothedStep) by pseudo-arclength continuation (Keller 1977;
/// Allgower & Georg, Introduction to numerical continuation methods, 2003, ch. 6): an Euler step along the
/// tangent, then Newton's method in the plane across it. Epsilon is one of the unknowns, so that the path may
/// turn back in it.
///
/// Dense and slow, for problems that nothing faster solves. The path of a problem that has a solution may
/// still miss it; one that has none runs off to infinity (State::unbounded) at an epsilon > 0.
template <int Dim>
class CentralPath {
 public:
  enum class State {
    arrived,    ///< at the epsilon asked for
    unbounded,  ///< normal impulses grow without bound at an epsilon that stays
    stuck,      ///< no step, however short, leads on; or all steps are used up
  };

  /// Starts a path at `epsilon`. @param problem  see SmoothedStep::begin()
  void begin(StepProblem<Dim>& problem, double epsilon);
  /// Follows it down to `epsilon`. Once it is not `arrived` there is no more to follow.
  [[nodiscard]] State follow_to(double epsilon);

  /// Where the path is.
  /// @param z       at least as long as the problem
  /// @param closed  with what the path leaves open at its end: see SmoothedStep::close()
  void estimate(Eigen::VectorXd& z, bool closed) const;
  [[nodiscard]] double epsilon() const { return system_.epsilon(tau_); }
  /// Of all steps since begin().
  [[nodiscard]] int factorisations() const { return factorisations_; }

 private:
  [[nodiscard]] bool advance(double end);
  [[nodiscard]] bool find_tangent();
  [[nodiscard]] bool try_step(double length);
  [[nodiscard]] double largest_impulse() const;
  void factor(const Eigen::VectorXd& last_row);

  SmoothedStep<Dim> system_;
  Eigen::VectorXd z_, trial_;
  double tau_ = 0.0;
  double trial_tau_ = 0.0;
  Eigen::VectorXd tangent_;  ///< in (z over its units, tau), of unit length
  double length_ = 0.0;      ///< of the next step
  int corrections_ = 0;      ///< of the last one
  int steps_ = 0;
  int factorisations_ = 0;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd row_scale_, solution_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace touchstone
