#pragma once

#include "core/stepper/contact_rows.h"

namespace touchstone {

/// x -> omega x x as a matrix on a displacement: d(omega x r) = spin_matrix(omega) dr.
inline Matrix<2> spin_matrix(const Angular<2>& omega) {
  return (Matrix<2>() << 0, -omega[0], omega[0], 0).finished();
}
inline Matrix<3> spin_matrix(const Angular<3>& omega) { return -lever(Vector<3>(omega)); }

/// Adds derivatives of a contact's rows to the Jacobian, given as coefficients of the motions that they
/// depend on. How those motions follow from the unknowns (chain rule through q' = q (+) h nu', Eq. 2, and
/// through a plane's chart) is in this one place. Side 0 is body 1, side 1 is body 2.
///
/// Coefficients are plain matrices of R rows, not expressions: each function then exists once for each R,
/// which keeps the compiler's work, and the code, small.
template <int Dim>
class ContactJacobian {
 public:
  static constexpr int kAngular = Dimension<Dim>::angular;
  template <int R>
  using OnPoint = Eigen::Matrix<double, R, Dim>;
  template <int R>
  using OnTurn = Eigen::Matrix<double, R, kAngular>;

  static constexpr bool has_slip = true;  ///< holds the row and column of sigma

  ContactJacobian(const ContactPair<Dim>& pair, const ContactLayout& at, const ContactState<Dim>& state,
                  double h, Eigen::MatrixXd& jacobian)
      : pair_(pair), at_(at), state_(state), h_(h), j_(jacobian) {}

  /// Coefficient of d p: the body's centre moves.
  template <int R>
  void centre(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    velocity<R>(row, k, h_ * coefficient);
  }

  /// Coefficient of d theta: the body turns about world axes.
  template <int R>
  void turn(Eigen::Index row, std::size_t k, const OnTurn<R>& coefficient) {
    if (state_.body[k].column >= 0) spin<R>(row, k, coefficient * state_.body[k].turn);
  }

  /// Coefficient of d v' of the body.
  template <int R>
  void velocity(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    const Eigen::Index column = state_.body[k].column;
    if (column >= 0) j_.template block<R, Dim>(row, column) += coefficient;
  }

  /// Coefficient of d omega' of the body.
  template <int R>
  void spin(Eigen::Index row, std::size_t k, const OnTurn<R>& coefficient) {
    const Eigen::Index column = state_.body[k].column;
    if (column >= 0) j_.template block<R, kAngular>(row, column + Dim) += coefficient;
  }

  /// Derivatives by the contact's own impulses or sigma.
  template <int R, int C>
  void impulse(Eigen::Index row, Eigen::Index column, const Eigen::Matrix<double, R, C>& block) {
    j_.template block<R, C>(row, column) += block;
  }

  /// Coefficient of d a: the closest point moves. On a plane d a = chart d s + d p + d theta x r.
  template <int R>
  void point(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    if (side(k).kind != SideKind::plane) {
      j_.template block<R, Dim>(row, point_column(k)) += coefficient;
      return;
    }
    j_.template block<R, Dim - 1>(row, point_column(k)) += coefficient * state_.side[k].chart;
    move_with_body<R>(row, k, coefficient);
  }

  /// Coefficient of d xi = d a - d p - d theta x r: the closest point moves on its body.
  template <int R>
  void relative(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    if (side(k).kind == SideKind::plane) {
      j_.template block<R, Dim - 1>(row, point_column(k)) += coefficient * state_.side[k].chart;
      return;
    }
    j_.template block<R, Dim>(row, point_column(k)) += coefficient;
    move_with_body<R>(row, k, -coefficient);
  }

  /// Coefficient of d N_1 or of d N_2 as they are, not normalised.
  template <int R>
  void body_normal(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    const SideState<Dim>& s = state_.side[k];
    relative<R>(row, k, coefficient * s.curvature);
    turn<R>(row, k, coefficient * lever(s.normal));
    multipliers<R>(row, k, coefficient);
  }

  /// Coefficient of d n, the frame's unit normal N_2 / |N_2|.
  template <int R>
  void frame(Eigen::Index row, const OnPoint<R>& coefficient) {
    constexpr std::size_t kOwner = 1;
    const Vector<Dim>& n = state_.frame.normal;
    if (side(kOwner).kind != SideKind::plane) relative<R>(row, kOwner, coefficient * state_.frame_curvature);
    turn<R>(row, kOwner, coefficient * lever(n));
    if (side(kOwner).kind == SideKind::intersection) {
      multipliers<R>(row, kOwner, (coefficient - (coefficient * n) * n.transpose()) / state_.normal_length);
    }
  }

 private:
  [[nodiscard]] const Side<Dim>& side(std::size_t k) const { return k == 0 ? pair_.side_1 : pair_.side_2; }
  [[nodiscard]] Eigen::Index point_column(std::size_t k) const { return k == 0 ? at_.point_1 : at_.point_2; }

  /// Coefficient of d p + d theta x r.
  template <int R>
  void move_with_body(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    if (state_.body[k].column < 0) return;
    centre<R>(row, k, coefficient);
    turn<R>(row, k, coefficient * lever(state_.side[k].arm));
  }

  /// Coefficient of sum_i gradients_i d l_i.
  template <int R>
  void multipliers(Eigen::Index row, std::size_t k, const OnPoint<R>& coefficient) {
    const Eigen::Index first = k == 0 ? at_.multipliers_1 : at_.multipliers_2;
    for (int i = 0; i < side(k).multipliers(); ++i) {
      j_.template block<R, 1>(row, first + i) +=
          coefficient * state_.side[k].gradients[static_cast<std::size_t>(i)];
    }
  }

  const ContactPair<Dim>& pair_;
  const ContactLayout& at_;
  const ContactState<Dim>& state_;
  double h_;
  Eigen::MatrixXd& j_;
};

}  // namespace touchstone
