#include "core/contact/side.h"

namespace touchstone {

namespace {

/// N = g/|g| of Eq. 9.
template <int Dim>
void smooth_normal(const SurfaceJet<Dim>& jet, const Matrix<Dim>& rotation, SideState<Dim>& state) {
  state.values[0] = jet.value;
  state.gradients[0] = rotation * jet.gradient;
  state.length = state.gradients[0].norm();
  state.normal = state.gradients[0] / state.length;
  state.hessian = jet.hessian;
}

/// N = sum l_i grad f_i, the KKT form of Eqs. 20-22 (with the misprint of Eq. 22 mended: each gradient at its
/// own point).
template <int Dim>
void intersection_normal(const Side<Dim>& side, const Vector<Dim>& x_body, const Matrix<Dim>& rotation,
                         const double* multipliers, SideState<Dim>& state) {
  state.hessian.setZero();
  state.normal.setZero();
  for (int i = 0; i < side.surface->count(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const SurfaceJet<Dim> jet = side.surface->jet(i, x_body);
    state.values[index] = jet.value;
    state.gradients[index] = rotation * jet.gradient;
    state.normal += multipliers[i] * state.gradients[index];
    state.hessian += multipliers[i] * jet.hessian;
  }
}

}  // namespace

template <int Dim>
void evaluate_side(const Side<Dim>& side, const Pose<Dim>& pose, const double* multipliers,
                   SideState<Dim>& state) {
  const Matrix<Dim>& rotation = pose.rotation.matrix();
  if (side.kind == SideKind::plane) {
    state.normal = rotation * side.surface->plane()->normal;
    return;
  }
  const Vector<Dim> x_body = rotation.transpose() * state.arm;
  if (side.kind == SideKind::smooth) {
    smooth_normal(side.surface->jet(0, x_body), rotation, state);
  } else {
    intersection_normal(side, x_body, rotation, multipliers, state);
  }
}

/// dN/d xi: (I - N N^T) H / |g| of a smooth side, sum_i l_i H_i of an intersection.
template <int Dim>
void differentiate_side(const Side<Dim>& side, const Pose<Dim>& pose, SideState<Dim>& state) {
  if (side.kind == SideKind::plane) {
    state.curvature.setZero();
    return;
  }
  const Matrix<Dim>& rotation = pose.rotation.matrix();
  const Matrix<Dim> hessian = rotation * state.hessian * rotation.transpose();
  state.curvature =
      side.kind == SideKind::intersection
          ? hessian
          : Matrix<Dim>((hessian - state.normal * (state.normal.transpose() * hessian)) / state.length);
}

template void evaluate_side(const Side<2>&, const Pose<2>&, const double*, SideState<2>&);
template void evaluate_side(const Side<3>&, const Pose<3>&, const double*, SideState<3>&);
template void differentiate_side(const Side<2>&, const Pose<2>&, SideState<2>&);
template void differentiate_side(const Side<3>&, const Pose<3>&, SideState<3>&);

}  // namespace touchstone
