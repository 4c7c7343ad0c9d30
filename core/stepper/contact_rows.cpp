#include "core/stepper/contact_rows.h"

#include <cassert>
#include <optional>

#include "core/stepper/contact_jacobian.h"
#include "core/stepper/contact_row_context.h"
#include "core/stepper/motion_jacobian.h"

namespace touchstone {

namespace {

template <int Dim>
using PointRows = RowContext<Dim, ContactJacobian<Dim>>;

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
Eigen::Index closeness_rows(const PointRows<Dim>& c, Eigen::Index row) {
  const auto& frame = c.state.frame;
  const double per_length = 1 / c.options.scale.length;
  c.f.template segment<Dim - 1>(row) = per_length * frame.tangents.transpose() * c.state.separation;
  if (c.derivative != nullptr) {
    auto& d = *c.derivative;
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
Eigen::Index alignment_rows(const PointRows<Dim>& c, Eigen::Index row) {
  const auto& frame = c.state.frame;
  const Vector<Dim>& normal_1 = c.state.side[0].normal;
  if (c.side(0).kind == SideKind::intersection) {  // N_1 + n = 0 fixes the multipliers' scale as well
    c.f.template segment<Dim>(row) = normal_1 + frame.normal;
    if (c.derivative != nullptr) {
      c.derivative->template body_normal<Dim>(row, 0, Matrix<Dim>::Identity());
      c.derivative->template frame<Dim>(row, Matrix<Dim>::Identity());
    }
    return row + Dim;
  }
  c.f.template segment<Dim - 1>(row) = frame.tangents.transpose() * normal_1;
  if (c.derivative != nullptr) {
    auto& d = *c.derivative;
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
Eigen::Index surface_rows(const PointRows<Dim>& c, Eigen::Index row) {
  const double per_length = 1 / c.options.scale.length;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const SideState<Dim>& s = c.state.side[k];
    if (c.side(k).kind == SideKind::smooth) {
      c.f[row] = per_length * s.values[0];
      if (c.derivative != nullptr)
        c.derivative->template relative<1>(row, k, per_length * s.gradients[0].transpose());
      ++row;
    } else if (c.side(k).kind == SideKind::intersection && k == 1) {
      c.f[row] = 0.5 * (s.normal.squaredNorm() - 1);
      if (c.derivative != nullptr) c.derivative->template body_normal<1>(row, 1, s.normal.transpose());
      ++row;
    }
  }
  return row;
}

/// 0 <= l_i _|_ -f_i(a) >= 0 of Eq. 20.
template <int Dim>
void multiplier_rows(const PointRows<Dim>& c) {
  const double per_length = 1 / c.options.scale.length;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const Eigen::Index first = k == 0 ? c.at.multipliers_1 : c.at.multipliers_2;
    for (int i = 0; i < c.side(k).multipliers(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      c.f[first + i] = -per_length * c.state.side[k].values[index];
      if (c.derivative != nullptr) {
        c.derivative->template relative<1>(first + i, k,
                                           -per_length * c.state.side[k].gradients[index].transpose());
      }
    }
  }
}

/// All of the rows that say where the closest points are, but those of multipliers.
template <int Dim>
void point_rows(const PointRows<Dim>& c) {
  Eigen::Index row = c.at.point_1;
  row = closeness_rows(c, row);
  row = alignment_rows(c, row);
  row = surface_rows(c, row);
  assert(row == c.at.friction);
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
  if (pair.side_2.kind == SideKind::intersection) {
    state.normal_length = owner.normal.norm();
    state.frame = contact_frame(Vector<Dim>(owner.normal / state.normal_length), prepared.reference);
  } else {
    state.normal_length = 1.0;
    state.frame = contact_frame(owner.normal, prepared.reference);
  }
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
  std::optional<ContactJacobian<Dim>> derivative;
  if (jacobian != nullptr) derivative.emplace(pair, at, state, options.h, *jacobian);
  const PointRows<Dim> context{pair, prepared, at, options, state, f, derivative ? &*derivative : nullptr};
  point_rows(context);
  multiplier_rows(context);
  load_rows(context);
}

template <int Dim>
void load_rows_by_motion(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                         const ContactLayout& at, const ContactRowOptions& options,
                         const ContactState<Dim>& state, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian,
                         MotionJacobian<Dim>& motions) {
  assert(pair.side_1.multipliers() + pair.side_2.multipliers() == 0);
  motions.start(at, state, options.h, jacobian);
  load_rows(RowContext<Dim, MotionJacobian<Dim>>{pair, prepared, at, options, state, f, &motions});
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
template void load_rows_by_motion(const ContactPair<2>&, const PreparedContact<2>&, const ContactLayout&,
                                  const ContactRowOptions&, const ContactState<2>&, Eigen::VectorXd&,
                                  Eigen::MatrixXd&, MotionJacobian<2>&);
template void contact_rows(const ContactPair<3>&, const PreparedContact<3>&, const ContactLayout&,
                           const ContactRowOptions&, const ContactState<3>&, Eigen::VectorXd&,
                           Eigen::MatrixXd*);
template void load_rows_by_motion(const ContactPair<3>&, const PreparedContact<3>&, const ContactLayout&,
                                  const ContactRowOptions&, const ContactState<3>&, Eigen::VectorXd&,
                                  Eigen::MatrixXd&, MotionJacobian<3>&);

}  // namespace touchstone
