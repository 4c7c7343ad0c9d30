#include "core/stepper/joint_rows.h"

#include "core/contact/side.h"

namespace touchstone {

namespace {

template <int Dim>
using Coefficient = Eigen::Matrix<double, 1, Dimension<Dim>::velocity>;

/// One row at one state: phi, its gradient by the motion [dp; dtheta] of each body (world axes), and the
/// derivative of gradient^T by these motions, block (i, j) = d gradient_i^T / d motion_j.
template <int Dim>
struct RowState {
  double phi = 0.0;
  std::array<Twist<Dim>, 2> gradient{};
  std::array<std::array<MotionMatrix<Dim>, 2>, 2> second{};
};

template <int Dim>
struct Directions {
  std::array<Matrix<Dim>, 2> rotation{};
  std::array<Vector<Dim>, 2> arm{};       ///< anchors from the centres, world axes
  Vector<Dim> gap = Vector<Dim>::Zero();  ///< x_a - x_b
};

template <int Dim>
Directions<Dim> directions(const JointRows<Dim>& joint, const std::array<BodyAtEnd<Dim>, 2>& body) {
  Directions<Dim> d;
  for (std::size_t k = 0; k < 2; ++k) {
    d.rotation[k] = body[k].pose.rotation.matrix();
    d.arm[k] = d.rotation[k] * joint.anchor[k];
  }
  d.gap = (body[0].pose.position - body[1].pose.position) + d.arm[0] - d.arm[1];
  return d;
}

/// phi = d . (x_a - x_b), d turning with b: the force d acts on a at x_a and, reversed, on b at the same
/// point.
template <int Dim>
RowState<Dim> point_row(const JointRow<Dim>& row, const Directions<Dim>& at) {
  constexpr int kAngular = Dimension<Dim>::angular;
  using Lever = LeverMatrix<Dim>;
  RowState<Dim> state;
  const Vector<Dim> d = at.rotation[1] * row.d_b;
  const Vector<Dim> arm_b = at.arm[1] + at.gap;  // x_a - p_b
  state.phi = d.dot(at.gap);
  state.gradient[0] = wrench<Dim>(d, at.arm[0]);
  state.gradient[1] = -wrench<Dim>(d, arm_b);
  // d(d) = dtheta_b x d;  d(r x d) = dr x d + r x d(d);  dr x d = -lever(d)^T dr.
  const Lever on_d = lever(d);
  const Eigen::Matrix<double, kAngular, Dim> on_arm = -lever(d).transpose();
  for (auto& blocks : state.second) {
    for (auto& block : blocks) block.setZero();
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const double sign = k == 0 ? 1 : -1;
    const Vector<Dim>& arm = k == 0 ? at.arm[0] : arm_b;
    auto& by_b = state.second[k][1];
    by_b.template topRightCorner<Dim, kAngular>() = sign * on_d;
    by_b.template bottomRightCorner<kAngular, kAngular>() = sign * lever(arm).transpose() * on_d;
    auto& by_a = state.second[k][0];
    by_a.template bottomRightCorner<kAngular, kAngular>() += sign * on_arm * lever(at.arm[0]);
    if (k == 1) {
      by_a.template bottomLeftCorner<kAngular, Dim>() += sign * on_arm;
      by_b.template bottomLeftCorner<kAngular, Dim>() -= sign * on_arm;
    }
  }
  return state;
}

/// phi = u . d, u turning with a and d with b: the moment u x d acts on a and, reversed, on b.
template <int Dim>
RowState<Dim> angle_row(const JointRow<Dim>& row, const Directions<Dim>& at) {
  constexpr int kAngular = Dimension<Dim>::angular;
  RowState<Dim> state;
  const Vector<Dim> u = at.rotation[0] * row.u_a;
  const Vector<Dim> d = at.rotation[1] * row.d_b;
  state.phi = u.dot(d);
  const Angular<Dim> on_a = moment(u, d);
  // d(u x d) = du x d + u x dd,  du = dtheta_a x u,  dd = dtheta_b x d.
  const Inertia<Dim> by_a = -lever(d).transpose() * lever(u);
  const Inertia<Dim> by_b = lever(u).transpose() * lever(d);
  for (std::size_t k = 0; k < 2; ++k) {
    const double sign = k == 0 ? 1 : -1;
    state.gradient[k].setZero();
    state.gradient[k].template tail<kAngular>() = sign * on_a;
    for (std::size_t j = 0; j < 2; ++j) {
      state.second[k][j].setZero();
      state.second[k][j].template bottomRightCorner<kAngular, kAngular>() = sign * (j == 0 ? by_a : by_b);
    }
  }
  return state;
}

template <int Dim>
RowState<Dim> evaluate_row(const JointRow<Dim>& row, const Directions<Dim>& at) {
  return row.kind == JointRow<Dim>::Kind::point ? point_row(row, at) : angle_row(row, at);
}

/// Adds coefficient * [dp; dtheta] of a body to rows of the Jacobian, by dp = h dv', dtheta = turn domega'.
template <int Dim, int Rows>
void add_motion(Eigen::MatrixXd& jacobian, Eigen::Index row, const BodyAtEnd<Dim>& body, double h,
                const Eigen::Matrix<double, Rows, Dimension<Dim>::velocity>& coefficient) {
  constexpr int kAngular = Dimension<Dim>::angular;
  if (body.column < 0) return;
  jacobian.template block<Rows, Dim>(row, body.column) += h * coefficient.template leftCols<Dim>();
  jacobian.template block<Rows, kAngular>(row, body.column + Dim) +=
      coefficient.template rightCols<kAngular>() * body.turn;
}

template <int Dim>
double impulse_unit(const JointRows<Dim>& joint, const JointRow<Dim>& row, const Scale& scale) {
  const double unit = joint.mass * scale.velocity;
  return row.kind == JointRow<Dim>::Kind::point ? unit : unit * scale.length;
}

/// A direction d of b along which the anchors coincide, given in the initial pose.
template <int Dim>
void add_point_row(const Vector<Dim>& d, const Pose<Dim>& pose_b, JointRows<Dim>& rows) {
  const Vector<Dim> none = Vector<Dim>::Zero();
  rows.rows.push_back({JointRow<Dim>::Kind::point, none, pose_b.rotation.matrix().transpose() * d});
}

/// Rows of kind point along each coordinate axis of the world in the initial pose.
template <int Dim>
void add_point_rows(const Pose<Dim>& pose_b, JointRows<Dim>& rows) {
  for (int i = 0; i < Dim; ++i) {
    add_point_row<Dim>(Vector<Dim>::Unit(i), pose_b, rows);
  }
}

/// Directions u of a that stay square to directions d of b, both given in the initial pose.
template <int Dim>
void add_angle_row(const Vector<Dim>& u, const Vector<Dim>& d, const Pose<Dim>& pose_a,
                   const Pose<Dim>& pose_b, JointRows<Dim>& rows) {
  rows.rows.push_back({JointRow<Dim>::Kind::angle, pose_a.rotation.matrix().transpose() * u,
                       pose_b.rotation.matrix().transpose() * d});
}

void add_orientation_rows(const Pose<2>& pose_a, const Pose<2>& pose_b, JointRows<2>& rows) {
  add_angle_row<2>(Vector<2>::UnitX(), Vector<2>::UnitY(), pose_a, pose_b, rows);
}
void add_orientation_rows(const Pose<3>& pose_a, const Pose<3>& pose_b, JointRows<3>& rows) {
  for (int i = 0; i < 3; ++i) {
    add_angle_row<3>(Vector<3>::Unit(i), Vector<3>::Unit((i + 1) % 3), pose_a, pose_b, rows);
  }
}

}  // namespace

template <int Dim>
JointRows<Dim> joint_rows(const Joint<Dim>& joint, const Pose<Dim>& pose_a, const Pose<Dim>& pose_b) {
  JointRows<Dim> rows;
  rows.body = {joint.body_a, joint.body_b};
  rows.anchor = {pose_a.to_body(joint.anchor), pose_b.to_body(joint.anchor)};
  const PlaneChart<Dim> across = plane_basis(joint.axis);
  switch (joint.type) {
    case JointType::ball:
      add_point_rows(pose_b, rows);
      break;
    case JointType::hinge:
      add_point_rows(pose_b, rows);
      if constexpr (Dim == 3) {
        for (int i = 0; i < 2; ++i) add_angle_row<3>(joint.axis, across.col(i), pose_a, pose_b, rows);
      }
      break;
    case JointType::slider:
      for (int i = 0; i < Dim - 1; ++i) {
        add_point_row<Dim>(across.col(i), pose_b, rows);
      }
      add_orientation_rows(pose_a, pose_b, rows);
      break;
    case JointType::fixed:
      add_point_rows(pose_b, rows);
      add_orientation_rows(pose_a, pose_b, rows);
      break;
  }
  return rows;
}

template <int Dim>
void add_joint(const JointRows<Dim>& joint, const std::array<BodyAtEnd<Dim>, 2>& body, const Scale& scale,
               double h, Eigen::Index first, const Eigen::Ref<const Eigen::VectorXd>& lambda,
               Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) {
  constexpr int n = Dimension<Dim>::velocity;
  const Directions<Dim> at = directions(joint, body);
  for (std::size_t i = 0; i < joint.rows.size(); ++i) {
    const JointRow<Dim>& row = joint.rows[i];
    const RowState<Dim> state = evaluate_row(row, at);
    const Eigen::Index index = first + static_cast<Eigen::Index>(i);
    const double per_length = row.kind == JointRow<Dim>::Kind::point ? 1 / scale.length : 1.0;
    const double unit = impulse_unit(joint, row, scale);
    f[index] = per_length * state.phi;
    for (std::size_t k = 0; k < 2; ++k) {
      if (jacobian != nullptr) {
        add_motion<Dim, 1>(*jacobian, index, body[k], h, per_length * state.gradient[k].transpose());
      }
      if (body[k].column < 0) continue;
      const Twist<Dim> scaled = -unit * body[k].row_scale.cwiseProduct(state.gradient[k]);
      f.template segment<n>(body[k].column) += lambda[static_cast<Eigen::Index>(i)] * scaled;
      if (jacobian == nullptr) continue;
      jacobian->template block<n, 1>(body[k].column, index) += scaled;
      for (std::size_t j = 0; j < 2; ++j) {
        const MotionMatrix<Dim> second = -unit * lambda[static_cast<Eigen::Index>(i)] *
                                         body[k].row_scale.asDiagonal() * state.second[k][j];
        add_motion<Dim, n>(*jacobian, body[k].column, body[j], h, second);
      }
    }
  }
}

template <int Dim>
std::array<Twist<Dim>, 2> joint_wrenches(const JointRows<Dim>& joint,
                                         const std::array<BodyAtEnd<Dim>, 2>& body, const Scale& scale,
                                         const Eigen::Ref<const Eigen::VectorXd>& lambda) {
  std::array<Twist<Dim>, 2> wrenches = {Twist<Dim>::Zero(), Twist<Dim>::Zero()};
  const Directions<Dim> at = directions(joint, body);
  for (std::size_t i = 0; i < joint.rows.size(); ++i) {
    const RowState<Dim> state = evaluate_row(joint.rows[i], at);
    const double impulse = impulse_unit(joint, joint.rows[i], scale) * lambda[static_cast<Eigen::Index>(i)];
    for (std::size_t k = 0; k < 2; ++k) wrenches[k] += impulse * state.gradient[k];
  }
  return wrenches;
}

template JointRows<2> joint_rows(const Joint<2>&, const Pose<2>&, const Pose<2>&);
template JointRows<3> joint_rows(const Joint<3>&, const Pose<3>&, const Pose<3>&);
template void add_joint(const JointRows<2>&, const std::array<BodyAtEnd<2>, 2>&, const Scale&, double,
                        Eigen::Index, const Eigen::Ref<const Eigen::VectorXd>&, Eigen::VectorXd&,
                        Eigen::MatrixXd*);
template void add_joint(const JointRows<3>&, const std::array<BodyAtEnd<3>, 2>&, const Scale&, double,
                        Eigen::Index, const Eigen::Ref<const Eigen::VectorXd>&, Eigen::VectorXd&,
                        Eigen::MatrixXd*);
template std::array<Twist<2>, 2> joint_wrenches(const JointRows<2>&, const std::array<BodyAtEnd<2>, 2>&,
                                                const Scale&, const Eigen::Ref<const Eigen::VectorXd>&);
template std::array<Twist<3>, 2> joint_wrenches(const JointRows<3>&, const std::array<BodyAtEnd<3>, 2>&,
                                                const Scale&, const Eigen::Ref<const Eigen::VectorXd>&);

}  // namespace touchstone
