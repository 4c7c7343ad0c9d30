#pragma once

#include "core/stepper/contact_rows.h"

namespace touchstone {

/// The closest points of a contact of two sides without multipliers, eliminated in closed form: the Newton
/// equations of their rows at one state, solved for da_1, da_2 and dn by the bodies' velocities.
///
/// With xi = da - dp - dtheta x r, the motion of a point on its body, xi_2 = T u_2 + beta n, since the rows
/// of surfaces (or a plane's chart) say how far it goes along n, and xi_1 = W u_1 + (...) n; the rows "a_1 -
/// a_2 is along n" give u_1 by u_2, and "N_1 is opposite to n" are left: Dim - 1 equations G u_2 = e.
template <int Dim>
class PointElimination {
 public:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kMotions = 3 * Dim;  ///< da_1, da_2, dn
  using Motion = Eigen::Matrix<double, kMotions, 1>;

  /// Whether this is for such contacts: body 1 smooth, body 2 smooth or a plane.
  [[nodiscard]] static bool applies_to(const ContactPair<Dim>& pair) {
    return pair.side_1.kind == SideKind::smooth && pair.side_2.kind != SideKind::intersection;
  }

  /// Takes a state that was differentiated (differentiate_contact()).
  /// @param length  L of the rows (Scale)
  /// @param h       step [s]
  /// @return false if the points do not follow from the poses: flat on flat
  [[nodiscard]] bool factor(const ContactPair<Dim>& pair, const ContactState<Dim>& state, double length,
                            double h);
  /// By the velocities of the bodies that move, in the columns that the state's bodies have: the first N.
  template <int N>
  [[nodiscard]] auto motions() const {
    return motions_.template leftCols<N>();
  }
  /// Whether they turn the normal: not that of a plane at rest.
  [[nodiscard]] bool normal_turns() const { return !plane_ || carrier_ >= 0; }
  /// That makes the points' rows grow by `rows`, with bodies at rest.
  [[nodiscard]] Motion motion_of(const double* rows) const;
  /// Change of the points' unknowns, in their order: of `rest`, a motion with bodies at rest, and of what the
  /// velocities add to it.
  void read_unknowns(const Motion& rest, const double* velocities, double* unknowns) const;

 private:
  static constexpr int kTangent = Dim - 1;
  static constexpr int kAngular = Dimension<Dim>::angular;
  using Square = Eigen::Matrix<double, kTangent, kTangent>;
  using Across = Eigen::Matrix<double, kTangent, Dim>;
  using Tangents = Eigen::Matrix<double, Dim, kTangent>;
  using Few = Eigen::Matrix<double, kTangent, 1>;
  using ByVelocity = Eigen::Matrix<double, Dim, kVelocity>;

  void find_motions(const ContactState<Dim>& state, double h);

  // Of the state that was taken: a chord step asks again when its contact has moved on.
  Tangents tangents_;
  Vector<Dim> normal_;
  Matrix<Dim> frame_curvature_;
  PlaneChart<Dim> chart_;

  bool plane_ = false;  ///< body 2
  double length_ = 1.0;
  double along_ = 1.0;          ///< grad f_1 . n
  double gradient_2_ = 1.0;     ///< |grad f_2|
  Across closeness_by_normal_;  ///< of L times the rows of closeness
  Across alignment_by_normal_;
  Tangents slide_1_;  ///< W: xi_1 by u_1 where f(a_1) stays
  Square u_1_by_u_2_;
  Square alignment_by_u_1_;
  Few alignment_by_surface_1_;  ///< of L times its row
  Square inverse_;              ///< G^-1
  Eigen::Index velocities_ = 0;
  Eigen::Matrix<double, kMotions, 2 * kVelocity> motions_;
  Eigen::Index carrier_ = -1;  ///< column of the body of a plane that moves
  ByVelocity carried_;         ///< what that moves on the plane
};

}  // namespace touchstone
