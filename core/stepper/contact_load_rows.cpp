#include "core/stepper/contact_jacobian.h"
#include "core/stepper/contact_row_context.h"
#include "core/stepper/motion_jacobian.h"

namespace touchstone {

namespace {

constexpr std::array<double, 2> kSign = {1.0, -1.0};  ///< impulses act on body 1, their opposites on body 2

/// 0 <= p_n _|_ f(a_2) >= 0, Eq. 6.
template <int Dim, typename Derivative>
void workspace_gap_row(const RowContext<Dim, Derivative>& c) {
  const Pose<Dim>& pose = c.state.body[0].pose;
  const Matrix<Dim> rotation = pose.rotation.matrix();
  const Vector<Dim> arm = c.state.side[1].point - pose.position;
  const SurfaceJet<Dim> jet = c.side(0).surface->jet(0, Vector<Dim>(rotation.transpose() * arm));
  const double per_length = 1 / c.options.scale.length;
  c.f[c.at.normal] = per_length * jet.value;
  if (c.derivative == nullptr) return;
  auto& d = *c.derivative;
  const Eigen::Matrix<double, 1, Dim> gradient = per_length * (rotation * jet.gradient).transpose();
  d.template point<1>(c.at.normal, 1, gradient);
  d.template centre<1>(c.at.normal, 0, -gradient);
  d.template turn<1>(c.at.normal, 0, -gradient * lever(arm));
}

/// 0 <= p_n _|_ psi >= 0, psi = n . (a_1 - a_2).
template <int Dim, typename Derivative>
void distance_gap_row(const RowContext<Dim, Derivative>& c) {
  const double per_length = 1 / c.options.scale.length;
  const Eigen::Matrix<double, 1, Dim> n = per_length * c.state.frame.normal.transpose();
  c.f[c.at.normal] = n * c.state.separation;
  if (c.derivative == nullptr) return;
  auto& d = *c.derivative;
  d.template point<1>(c.at.normal, 0, n);
  d.template point<1>(c.at.normal, 1, -n);
  d.template frame<1>(c.at.normal, per_length * c.state.separation.transpose());
}

/// Adds coefficient * d w to `row`, w = E v_f / V, with d w through slip velocity, contact points and frame.
template <int R, int Dim, typename Derivative>
void slip_derivative(const RowContext<Dim, Derivative>& c, Eigen::Index row,
                     const Eigen::Matrix<double, R, Dimension<Dim>::friction>& coefficient) {
  using Rows = Eigen::Matrix<double, R, Dim>;
  auto& d = *c.derivative;
  const auto& state = c.state;
  const Eigen::Matrix<double, R, Dimension<Dim>::friction> on_v =
      coefficient * c.prepared.semi_axes.asDiagonal() / c.options.scale.velocity;
  const Rows on_slip = on_v.template leftCols<Dim - 1>() * state.frame.tangents.transpose();
  Rows on_normal = Rows::Zero();
  for (int i = 0; i < Dim - 1; ++i) {
    on_normal +=
        on_v.col(i) * (state.slip_velocity.transpose() * state.frame_derivative[static_cast<std::size_t>(i)]);
  }
  if constexpr (Dim == 3) on_normal += on_v.col(2) * state.spin_velocity.transpose();
  d.template frame<R>(row, on_normal);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (state.body[k].column < 0) continue;  // rests
    const Rows on_arm = kSign[k] * on_slip *
                        spin_matrix(Angular<Dim>(state.body[k].nu.template tail<Dimension<Dim>::angular>()));
    d.template point<R>(row, k, on_arm);
    d.template centre<R>(row, k, -on_arm);
    d.template velocity<R>(row, k, kSign[k] * on_slip);
    d.template spin<R>(row, k, kSign[k] * on_slip * lever(state.side[k].arm));
    if constexpr (Dim == 3)
      d.template spin<R>(row, k, kSign[k] * on_v.col(2) * state.frame.normal.transpose());
  }
}

/// Eq. 5 in the form asked for, and the row of sigma.
template <int Dim, typename Derivative>
void friction_law_rows(const RowContext<Dim, Derivative>& c) {
  using Scalar = Eigen::Matrix<double, 1, 1>;
  constexpr int n = Dimension<Dim>::friction;
  const auto& state = c.state;
  const FrictionVector<Dim> w =
      scaled_slip(state.frame, c.prepared.semi_axes, state.slip_velocity, state.spin_velocity) /
      c.options.scale.velocity;
  const auto evaluate = [&](auto law) {
    const auto rows = law(c.options.form, c.pair.law.mu, c.prepared.rho, c.prepared.active, state.y, w,
                          state.p, state.s, c.options.smoothing);
    c.f.template segment<n>(c.at.friction) = rows.value;
    c.f[c.at.slip] = rows.slip_value;
    return rows;
  };
  if (c.derivative == nullptr) {
    evaluate(&friction_values<Dim>);
    return;
  }
  const FrictionRows<Dim> rows = evaluate(&friction_rows<Dim>);
  auto& d = *c.derivative;
  slip_derivative<n, Dim>(c, c.at.friction, rows.d_w);
  d.template impulse<n, n>(c.at.friction, c.at.friction, rows.d_y);
  d.template impulse<n, 1>(c.at.friction, c.at.normal, rows.d_p);
  if constexpr (Derivative::has_slip) {
    d.template impulse<n, 1>(c.at.friction, c.at.slip, rows.d_s);
    slip_derivative<1, Dim>(c, c.at.slip, rows.slip_d_w);
    d.template impulse<1, n>(c.at.slip, c.at.friction, rows.slip_d_y);
    d.template impulse<1, 1>(c.at.slip, c.at.normal, Scalar(rows.slip_d_p));
    d.template impulse<1, 1>(c.at.slip, c.at.slip, Scalar(rows.slip_d_s));
  }
}

/// -W_n p_n - W_t p_t - W_o p_o - W_r p_r in the momentum rows of both bodies (Eq. 10, first row), at the end
/// of the step.
template <int Dim, typename Derivative>
void momentum_rows(const RowContext<Dim, Derivative>& c) {
  constexpr int kAngular = Dimension<Dim>::angular;
  const auto& state = c.state;
  const auto& frame = state.frame;
  const double unit = c.prepared.mass * c.options.scale.velocity;  // [N s]
  const FrictionVector<Dim> per_y = unit * c.prepared.semi_axes;
  const FrictionVector<Dim> friction = per_y.cwiseProduct(state.y);
  const Vector<Dim> force =
      unit * state.p * frame.normal + frame.tangents * friction.template head<Dim - 1>();
  Matrix<Dim> force_on_normal = Matrix<Dim>::Zero();
  if (c.derivative != nullptr) {
    force_on_normal = unit * state.p * Matrix<Dim>::Identity();
    for (int i = 0; i < Dim - 1; ++i)
      force_on_normal += friction[i] * state.frame_derivative[static_cast<std::size_t>(i)];
  }

  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const BodyAtEnd<Dim>& body = state.body[k];
    if (body.column < 0) continue;
    const Eigen::Index row = body.column;
    const double linear = -kSign[k] * body.row_scale[0];
    const double angular = -kSign[k] * body.row_scale[Dim];
    c.f.template segment<Dim>(row) += linear * force;
    c.f.template segment<kAngular>(row + Dim) += angular * moment(state.side[k].arm, force);
    if constexpr (Dim == 3) c.f.template segment<3>(row + 3) += angular * friction[2] * frame.normal;
    if (c.derivative == nullptr) continue;

    auto& d = *c.derivative;
    const Eigen::Matrix<double, kAngular, Dim> to_moment =
        lever(state.side[k].arm).transpose();  // F -> r x F
    d.template frame<Dim>(row, linear * force_on_normal);
    Eigen::Matrix<double, kAngular, Dim> moment_on_normal = to_moment * force_on_normal;
    if constexpr (Dim == 3) moment_on_normal += friction[2] * Matrix<3>::Identity();
    d.template frame<kAngular>(row + Dim, angular * moment_on_normal);
    const Eigen::Matrix<double, kAngular, Dim> on_arm =
        -angular * lever(force).transpose();  // d(r x F) = dr x F
    d.template point<kAngular>(row + Dim, k, on_arm);
    d.template centre<kAngular>(row + Dim, k, -on_arm);
    d.template impulse<Dim, 1>(row, c.at.normal, linear * unit * frame.normal);
    d.template impulse<kAngular, 1>(row + Dim, c.at.normal, angular * unit * (to_moment * frame.normal));
    for (int i = 0; i < Dim - 1; ++i) {
      d.template impulse<Dim, 1>(row, c.at.friction + i, linear * per_y[i] * frame.tangents.col(i));
      d.template impulse<kAngular, 1>(row + Dim, c.at.friction + i,
                                      angular * per_y[i] * (to_moment * frame.tangents.col(i)));
    }
    if constexpr (Dim == 3)
      d.template impulse<3, 1>(row + 3, c.at.friction + 2, angular * per_y[2] * frame.normal);
  }
}

}  // namespace

template <int Dim, typename Derivative>
void load_rows(const RowContext<Dim, Derivative>& context) {
  // Not Eq. 19, max_j f_j(a_2), for an intersection: where a_2 lies inside the body but on the plane of
  // another of its faces, that maximum is 0 and the bodies overlap unhindered.
  if (context.options.gap == GapFunction::workspace && context.pair.side_1.kind == SideKind::smooth) {
    workspace_gap_row(context);
  } else {
    distance_gap_row(context);
  }
  friction_law_rows(context);
  momentum_rows(context);
}

template void load_rows(const RowContext<2, ContactJacobian<2>>&);
template void load_rows(const RowContext<3, ContactJacobian<3>>&);
template void load_rows(const RowContext<2, MotionJacobian<2>>&);
template void load_rows(const RowContext<3, MotionJacobian<3>>&);

}  // namespace touchstone
