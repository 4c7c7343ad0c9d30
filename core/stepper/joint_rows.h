#pragma once

#include <array>
#include <vector>

#include "core/stepper/contact_rows.h"

/// Joints as equality rows phi(q') = 0 at the end of the step, with impulses G^T lambda, G = d phi /
/// d(motion): the bilateral constraints that the paper leaves out "to simplify the exposition" (section III).
namespace touchstone {

/// One scalar constraint, of two kinds from which all joints are made. Directions turn with their bodies.
template <int Dim>
struct JointRow {
  enum class Kind {
    point,  ///< d_b . (x_a - x_b) = 0: the anchors coincide along a direction of body b
    angle,  ///< u_a . d_b = 0: a direction of body a stays square to one of body b
  };
  Kind kind = Kind::point;
  Vector<Dim> u_a = Vector<Dim>::Zero();  ///< body frame of a; only for angles
  Vector<Dim> d_b = Vector<Dim>::Zero();  ///< body frame of b
};

/// A joint taken apart into rows, with its anchors in the bodies' frames.
template <int Dim>
struct JointRows {
  std::array<int, 2> body{};            ///< a, b
  std::array<Vector<Dim>, 2> anchor{};  ///< body frames [m]
  std::vector<JointRow<Dim>> rows;
  double mass = 1.0;  ///< unit of impulse is mass * V, of an angle's moment impulse mass * V * L
};

/// @param pose_a, pose_b  in which the joint's anchor and axis are given
template <int Dim>
JointRows<Dim> joint_rows(const Joint<Dim>& joint, const Pose<Dim>& pose_a, const Pose<Dim>& pose_b);

/// Writes phi of every row at `first`, and adds -G^T lambda to the momentum rows.
/// @param lambda  the joint's scaled impulses, one a row, which are the unknowns at `first`
/// @param body    both bodies at the end of the step, positions relative to one origin
template <int Dim>
void add_joint(const JointRows<Dim>& joint, const std::array<BodyAtEnd<Dim>, 2>& body, const Scale& scale,
               double h, Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& lambda,
               Eigen::VectorXd& f, Eigen::MatrixXd* jacobian);

/// The wrenches [N s; N m s] of the joint's impulses on both bodies.
template <int Dim>
std::array<Twist<Dim>, 2> joint_wrenches(const JointRows<Dim>& joint,
                                         const std::array<BodyAtEnd<Dim>, 2>& body, const Scale& scale,
                                         const Eigen::Ref<const Eigen::VectorXd>& lambda);

}  // namespace touchstone
