#include "core/stepper/contact_rows.h"

#include <cassert>

#include "core/stepper/contact_jacobian.h"

namespace touchstone {

namespace {

constexpr std::array<double, 2> kSign = {1.0, -1.0};  ///< impulses act on body 1, their opposites on body 2

/// The arguments that every row function needs.
template <int Dim>
struct RowContext {
  const ContactPair<Dim>& pair;
  const PreparedContact<Dim>& prepared;
  const ContactLayout& at;
  const ContactRowOptions& options;
  const ContactState<Dim>& state;
  Eigen::VectorXd& f;
  Eigen::MatrixXd* jacobian;

  [[nodiscard]] const Side<Dim>& side(std::size_t k) const { return k == 0 ? pair.side_1 : pair.side_2; }
  [[nodiscard]] ContactJacobian<Dim> derivative() const { return {pair, at, state, options.h, *jacobian}; }
};

/// Closest point of side k from its unknowns: a itself, or the plane's chart.
template <int Dim>
void read_point(const Side<Dim>& side, const PreparedContact<Dim>& prepared, std::size_t k, Eigen::Index at,
                const Eigen::VectorXd& z, ContactState<Dim>& state) {
  SideState<Dim>& s = state.side[k];
  const Pose<Dim>& pose = state.body[k].pose;
  if (side.kind == SideKind::plane) {
    const PlaneAtStart<Dim>& plane = prepared.plane[k];
    s.chart = pose.rotation.matrix() * plane.basis;
    s.point = plane.moved_foot(pose) + s.chart * z.template segment<Dim - 1>(at);
    s.arm = s.point - pose.position;
  } else {
    s.point = z.template segment<Dim>(at);
    s.arm = s.point - pose.position;
  }
}

/// Eq. 9 in signed-gap form, psi = n . (a_1 - a_2) eliminated: a_1 - a_2 is along n, and N_1 is opposite to
/// n.
template <int Dim>
Eigen::Index closeness_rows(const RowContext<Dim>& c, Eigen::Index row) {
  const auto& frame = c.state.frame;
  const double per_length = 1 / c.options.scale.length;
  c.f.template segment<Dim - 1>(row) = per_length * frame.tangents.transpose() * c.state.separation;
  if (c.jacobian != nullptr) {
    auto d = c.derivative();
    d.template point<Dim - 1>(row, 0, per_length * frame.tangents.transpose());
    d.template point<Dim - 1>(row, 1, -per_length * frame.tangents.transpose());
    Eigen::Matrix<double, Dim - 1, Dim> on_normal;
    for (int i = 0; i < Dim - 1; ++i) {
      on_normal.row(i) =
          per_length * c.state.separation.transpose() * c.state.frame_derivative[static_cast<std::size_t>(i)];
    }
    d.template frame<Dim - 1>(row, on_normal);
  }
  return row + Dim - 1;
}

template <int Dim>
Eigen::Index alignment_rows(const RowContext<Dim>& c, Eigen::Index row) {
  const auto& frame = c.state.frame;
  const Vector<Dim>& normal_1 = c.state.side[0].normal;
  if (c.side(0).kind == SideKind::intersection) {  // N_1 + n = 0 fixes the multipliers' scale as well
    c.f.template segment<Dim>(row) = normal_1 + frame.normal;
    if (c.jacobian != nullptr) {
      c.derivative().template body_normal<Dim>(row, 0, Matrix<Dim>::Identity());
      c.derivative().template frame<Dim>(row, Matrix<Dim>::Identity());
    }
    return row + Dim;
  }
  c.f.template segment<Dim - 1>(row) = frame.tangents.transpose() * normal_1;
  if (c.jacobian != nullptr) {
    auto d = c.derivative();
    d.template body_normal<Dim - 1>(row, 0, frame.tangents.transpose());
    Eigen::Matrix<double, Dim - 1, Dim> on_normal;
    for (int i = 0; i < Dim - 1; ++i) {
      on_normal.row(i) = normal_1.transpose() * c.state.frame_derivative[static_cast<std::size_t>(i)];
    }
    d.template frame<Dim - 1>(row, on_normal);
  }
  return row + Dim - 1;
}

/// f(a_1) = 0 and g(a_2) = 0 of smooth sides, and |N_2| = 1 of an intersection that owns the frame.
template <int Dim>
Eigen::Index surface_rows(const RowContext<Dim>& c, Eigen::Index row) {
  const double per_length = 1 / c.options.scale.length;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const SideState<Dim>& s = c.state.side[k];
    if (c.side(k).kind == SideKind::smooth) {
      c.f[row] = per_length * s.values[0];
      if (c.jacobian != nullptr)
        c.derivative().template relative<1>(row, k, per_length * s.gradients[0].transpose());
      ++row;
    } else if (c.side(k).kind == SideKind::intersection && k == 1) {
      c.f[row] = 0.5 * (s.normal.squaredNorm() - 1);
      if (c.jacobian != nullptr) c.derivative().template body_normal<1>(row, 1, s.normal.transpose());
      ++row;
    }
  }
  return row;
}

/// 0 <= l_i _|_ -f_i(a) >= 0 of Eq. 20.
template <int Dim>
void multiplier_rows(const RowContext<Dim>& c) {
  const double per_length = 1 / c.options.scale.length;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const Eigen::Index first = k == 0 ? c.at.multipliers_1 : c.at.multipliers_2;
    for (int i = 0; i < c.side(k).multipliers(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      c.f[first + i] = -per_length * c.state.side[k].values[index];
      if (c.jacobian != nullptr) {
        c.derivative().template relative<1>(first + i, k,
                                            -per_length * c.state.side[k].gradients[index].transpose());
      }
    }
  }
}

/// 0 <= p_n _|_ f(a_2) >= 0, Eq. 6.
template <int Dim>
void workspace_gap_row(const RowContext<Dim>& c) {
  const Pose<Dim>& pose = c.state.body[0].pose;
  const Matrix<Dim> rotation = pose.rotation.matrix();
  const Vector<Dim> arm = c.state.side[1].point - pose.position;
  const SurfaceJet<Dim> jet = c.side(0).surface->jet(0, Vector<Dim>(rotation.transpose() * arm));
  const double per_length = 1 / c.options.scale.length;
  c.f[c.at.normal] = per_length * jet.value;
  if (c.jacobian == nullptr) return;
  auto d = c.derivative();
  const Eigen::Matrix<double, 1, Dim> gradient = per_length * (rotation * jet.gradient).transpose();
  d.template point<1>(c.at.normal, 1, gradient);
  d.template centre<1>(c.at.normal, 0, -gradient);
  d.template turn<1>(c.at.normal, 0, -gradient * lever(arm));
}

/// 0 <= p_n _|_ psi >= 0, psi = n . (a_1 - a_2).
template <int Dim>
void distance_gap_row(const RowContext<Dim>& c) {
  const double per_length = 1 / c.options.scale.length;
  const Eigen::Matrix<double, 1, Dim> n = per_length * c.state.frame.normal.transpose();
  c.f[c.at.normal] = n * c.state.separation;
  if (c.jacobian == nullptr) return;
  auto d = c.derivative();
  d.template point<1>(c.at.normal, 0, n);
  d.template point<1>(c.at.normal, 1, -n);
  d.template frame<1>(c.at.normal, per_length * c.state.separation.transpose());
}

/// w = E v_f / V: slip along t (and o) and spin about n, times the semi-axes.
template <int Dim>
FrictionVector<Dim> scaled_slip(const RowContext<Dim>& c) {
  FrictionVector<Dim> v;
  v.template head<Dim - 1>() = c.state.frame.tangents.transpose() * c.state.slip_velocity;
  if constexpr (Dim == 3) v[2] = c.state.frame.normal.dot(c.state.spin_velocity);
  return c.prepared.semi_axes.cwiseProduct(v) / c.options.scale.velocity;
}

/// Adds coefficient * d w to `row`, with d w through slip velocity, contact points and frame.
template <int R, int Dim>
void slip_derivative(const RowContext<Dim>& c, Eigen::Index row,
                     const Eigen::Matrix<double, R, Dimension<Dim>::friction>& coefficient) {
  using Rows = Eigen::Matrix<double, R, Dim>;
  auto d = c.derivative();
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
template <int Dim>
void friction_law_rows(const RowContext<Dim>& c) {
  constexpr int n = Dimension<Dim>::friction;
  const auto& state = c.state;
  const FrictionRows<Dim> rows =
      friction_rows<Dim>(c.options.form, c.pair.law.mu, c.prepared.rho, c.prepared.active, state.y,
                         scaled_slip(c), state.p, state.s, c.options.smoothing);
  c.f.template segment<n>(c.at.friction) = rows.value;
  c.f[c.at.slip] = rows.slip_value;
  if (c.jacobian == nullptr) return;
  Eigen::MatrixXd& j = *c.jacobian;
  slip_derivative<n, Dim>(c, c.at.friction, rows.d_w);
  j.template block<n, n>(c.at.friction, c.at.friction) += rows.d_y;
  j.template block<n, 1>(c.at.friction, c.at.normal) += rows.d_p;
  j.template block<n, 1>(c.at.friction, c.at.slip) += rows.d_s;
  slip_derivative<1, Dim>(c, c.at.slip, rows.slip_d_w);
  j.template block<1, n>(c.at.slip, c.at.friction) += rows.slip_d_y;
  j(c.at.slip, c.at.normal) += rows.slip_d_p;
  j(c.at.slip, c.at.slip) += rows.slip_d_s;
}

/// -W_n p_n - W_t p_t - W_o p_o - W_r p_r in the momentum rows of both bodies (Eq. 10, first row), at the end
/// of the step.
template <int Dim>
void momentum_rows(const RowContext<Dim>& c) {
  constexpr int kAngular = Dimension<Dim>::angular;
  const auto& state = c.state;
  const auto& frame = state.frame;
  const double unit = c.prepared.mass * c.options.scale.velocity;  // [N s]
  const FrictionVector<Dim> per_y = unit * c.prepared.semi_axes;
  const FrictionVector<Dim> friction = per_y.cwiseProduct(state.y);
  const Vector<Dim> force =
      unit * state.p * frame.normal + frame.tangents * friction.template head<Dim - 1>();
  Matrix<Dim> force_on_normal;
  if (c.jacobian != nullptr) {
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
    const Eigen::Matrix<double, kAngular, Dim> moment = lever(state.side[k].arm).transpose();  // F -> r x F
    c.f.template segment<Dim>(row) += linear * force;
    c.f.template segment<kAngular>(row + Dim) += angular * (moment * force);
    if constexpr (Dim == 3) c.f.template segment<3>(row + 3) += angular * friction[2] * frame.normal;
    if (c.jacobian == nullptr) continue;

    Eigen::MatrixXd& j = *c.jacobian;
    auto d = c.derivative();
    d.template frame<Dim>(row, linear * force_on_normal);
    Eigen::Matrix<double, kAngular, Dim> moment_on_normal = moment * force_on_normal;
    if constexpr (Dim == 3) moment_on_normal += friction[2] * Matrix<3>::Identity();
    d.template frame<kAngular>(row + Dim, angular * moment_on_normal);
    const Eigen::Matrix<double, kAngular, Dim> on_arm =
        -angular * lever(force).transpose();  // d(r x F) = dr x F
    d.template point<kAngular>(row + Dim, k, on_arm);
    d.template centre<kAngular>(row + Dim, k, -on_arm);
    j.template block<Dim, 1>(row, c.at.normal) += linear * unit * frame.normal;
    j.template block<kAngular, 1>(row + Dim, c.at.normal) += angular * unit * (moment * frame.normal);
    for (int i = 0; i < Dim - 1; ++i) {
      j.template block<Dim, 1>(row, c.at.friction + i) += linear * per_y[i] * frame.tangents.col(i);
      j.template block<kAngular, 1>(row + Dim, c.at.friction + i) +=
          angular * per_y[i] * (moment * frame.tangents.col(i));
    }
    if constexpr (Dim == 3)
      j.template block<3, 1>(row + 3, c.at.friction + 2) += angular * per_y[2] * frame.normal;
  }
}

}  // namespace

template <int Dim>
void evaluate_contact(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                      const ContactLayout& at, const Eigen::VectorXd& z, ContactState<Dim>& state) {
  read_point(pair.side_1, prepared, 0, at.point_1, z, state);
  read_point(pair.side_2, prepared, 1, at.point_2, z, state);
  evaluate_side(pair.side_1, state.body[0].pose, z.data() + at.multipliers_1, state.side[0]);
  evaluate_side(pair.side_2, state.body[1].pose, z.data() + at.multipliers_2, state.side[1]);
  const SideState<Dim>& owner = state.side[1];
  state.normal_length = owner.normal.norm();
  const Vector<Dim> n = owner.normal / state.normal_length;
  state.frame = contact_frame(n, prepared.reference);
  state.separation = state.side[0].point - state.side[1].point;
  constexpr int kAngular = Dimension<Dim>::angular;
  state.slip_velocity = point_velocity<Dim>(state.body[0].nu, state.side[0].arm) -
                        point_velocity<Dim>(state.body[1].nu, state.side[1].arm);
  state.spin_velocity =
      state.body[0].nu.template tail<kAngular>() - state.body[1].nu.template tail<kAngular>();
  state.y = z.template segment<Dimension<Dim>::friction>(at.friction);
  state.p = z[at.normal];
  state.s = z[at.slip];
}

template <int Dim>
void differentiate_contact(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                           ContactState<Dim>& state) {
  differentiate_side(pair.side_1, state.body[0].pose, state.side[0]);
  differentiate_side(pair.side_2, state.body[1].pose, state.side[1]);
  state.frame_derivative = frame_derivative(state.frame, prepared.reference);
  const Vector<Dim>& n = state.frame.normal;
  const Matrix<Dim>& curvature = state.side[1].curvature;
  state.frame_curvature = (curvature - n * (n.transpose() * curvature)) / state.normal_length;
}

template <int Dim>
void contact_rows(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared, const ContactLayout& at,
                  const ContactRowOptions& options, const ContactState<Dim>& state, Eigen::VectorXd& f,
                  Eigen::MatrixXd* jacobian) {
  const RowContext<Dim> context{pair, prepared, at, options, state, f, jacobian};
  Eigen::Index row = at.point_1;
  row = closeness_rows(context, row);
  row = alignment_rows(context, row);
  row = surface_rows(context, row);
  assert(row == at.friction);
  multiplier_rows(context);
  // Not Eq. 19, max_j f_j(a_2), for an intersection: where a_2 lies inside the body but on the plane of
  // another of its faces, that maximum is 0 and the bodies overlap unhindered.
  if (options.gap == GapFunction::workspace && pair.side_1.kind == SideKind::smooth) {
    workspace_gap_row(context);
  } else {
    distance_gap_row(context);
  }
  friction_law_rows(context);
  momentum_rows(context);
}

template void evaluate_contact(const ContactPair<2>&, const PreparedContact<2>&, const ContactLayout&,
                               const Eigen::VectorXd&, ContactState<2>&);
template void differentiate_contact(const ContactPair<2>&, const PreparedContact<2>&, ContactState<2>&);
template void evaluate_contact(const ContactPair<3>&, const PreparedContact<3>&, const ContactLayout&,
                               const Eigen::VectorXd&, ContactState<3>&);
template void differentiate_contact(const ContactPair<3>&, const PreparedContact<3>&, ContactState<3>&);
template void contact_rows(const ContactPair<2>&, const PreparedContact<2>&, const ContactLayout&,
                           const ContactRowOptions&, const ContactState<2>&, Eigen::VectorXd&,
                           Eigen::MatrixXd*);
template void contact_rows(const ContactPair<3>&, const PreparedContact<3>&, const ContactLayout&,
                           const ContactRowOptions&, const ContactState<3>&, Eigen::VectorXd&,
                           Eigen::MatrixXd*);

}  // namespace touchstone
