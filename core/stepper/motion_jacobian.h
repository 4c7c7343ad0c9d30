#pragma once

#include "core/stepper/contact_rows.h"

namespace touchstone {

/// Derivatives of a contact's rows by its motions, before it is known how these follow from the unknowns: by
/// da_1, da_2 and dn in a matrix of their own, all else (velocities, poses, impulses) in the contact's block.
/// Where the closest points are eliminated (PointElimination) all three follow from the bodies' velocities,
/// so that one product of small matrices of fixed size, add_motions(), is the rest of the chain rule: the
/// Schur complement, without rows or columns of points in between.
///
/// Rows and columns are those of a StepBlock, of which those of points and of sigma are left out. Same
/// functions of coefficients as ContactJacobian's. For a contact without multipliers.
template <int Dim>
class MotionJacobian {
 public:
  static constexpr int kAngular = Dimension<Dim>::angular;
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kImpulses = Dimension<Dim>::friction + 1;
  static constexpr int kMotions = 3 * Dim;  ///< da_1, da_2, dn
  static constexpr int kMostRows = 2 * kVelocity + kImpulses;
  template <int R>
  using OnPoint = Eigen::Matrix<double, R, Dim>;
  template <int R>
  using OnTurn = Eigen::Matrix<double, R, kAngular>;
  /// Of what effect() gives: the bodies' rows, then those of friction and of the gap.
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;

  static constexpr bool has_slip = false;

  /// Begins anew at a state. @param jacobian  where all goes that is no motion
  void start(const ContactLayout& at, const ContactState<Dim>& state, double h, Eigen::MatrixXd& jacobian) {
    points_ = at.friction - at.point_1;
    velocities_ = at.point_1;
    state_ = &state;
    h_ = h;
    j_ = &jacobian;
    on_motion_.topRows(velocities_ + kImpulses).setZero();
  }

  template <int R>
  void centre(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    velocity<R>(row, k, h_ * coefficient);
  }
  template <int R>
  void turn(Eigen::Index row, std::size_t k, const OnTurn<R>& coefficient) {
    if (state_->body[k].column >= 0) spin<R>(row, k, coefficient * state_->body[k].turn);
  }
  template <int R>
  void velocity(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    const Eigen::Index column = state_->body[k].column;
    if (column >= 0) j_->template block<R, Dim>(row, column) += coefficient;
  }
  template <int R>
  void spin(Eigen::Index row, std::size_t k, const OnTurn<R>& coefficient) {
    const Eigen::Index column = state_->body[k].column;
    if (column >= 0) j_->template block<R, kAngular>(row, column + Dim) += coefficient;
  }
  template <int R, int C>
  void impulse(Eigen::Index row, Eigen::Index column, const Eigen::Matrix<double, R, C>& block) {
    j_->template block<R, C>(row, column) += block;
  }
  template <int R>
  void point(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    on_motion_.template block<R, Dim>(compact(row), Dim * static_cast<Eigen::Index>(k)) += coefficient;
  }
  template <int R>
  void frame(Eigen::Index row, const OnPoint<R>& coefficient) {
    on_motion_.template block<R, Dim>(compact(row), 2 * Dim) += coefficient;
  }

  /// Multiplies the derivatives of a row by motions.
  void scale_row(Eigen::Index row, double factor) { on_motion_.row(compact(row)) *= factor; }

  /// Adds to the Jacobian what N velocities do to the rows by way of the motions that they cause.
  /// @param normal_turns  whether dn may be other than zero
  template <int N, typename Motions>
  void add_motions(const Motions& motions, bool normal_turns) {
    constexpr int kPoints = 2 * Dim;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const Eigen::Index row = state_->body[k].column;
      if (row < 0) continue;
      // Forces do not depend on where they act, and moments on no other point than their own.
      const auto point = Dim * static_cast<Eigen::Index>(k);
      j_->template block<kAngular, N>(row + Dim, 0) +=
          on_motion_.template block<kAngular, Dim>(row + Dim, point)
              .lazyProduct(motions.template middleRows<Dim>(point));
      if (normal_turns) {
        j_->template block<kVelocity, N>(row, 0) += on_motion_.template block<kVelocity, Dim>(row, kPoints)
                                                        .lazyProduct(motions.template bottomRows<Dim>());
      }
    }
    auto impulses = j_->template block<kImpulses, N>(velocities_ + points_, 0);
    const auto on_motion = on_motion_.template middleRows<kImpulses>(N);
    if (normal_turns) {
      impulses += on_motion.lazyProduct(motions);
    } else {
      impulses += on_motion.template leftCols<kPoints>().lazyProduct(motions.template topRows<kPoints>());
    }
  }
  /// What a motion does to the rows.
  [[nodiscard]] Rows effect(const Eigen::Matrix<double, kMotions, 1>& motion) const {
    return on_motion_.topRows(velocities_ + kImpulses).lazyProduct(motion);
  }

 private:
  [[nodiscard]] Eigen::Index compact(Eigen::Index row) const {
    return row < velocities_ ? row : row - points_;
  }

  Eigen::Index points_ = 0;      ///< rows of the closest points, which are left out
  Eigen::Index velocities_ = 0;  ///< rows of the bodies
  const ContactState<Dim>* state_ = nullptr;
  double h_ = 0.0;
  Eigen::MatrixXd* j_ = nullptr;
  Eigen::Matrix<double, kMostRows, kMotions> on_motion_;
};

}  // namespace touchstone
