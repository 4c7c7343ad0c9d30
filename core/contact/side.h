#pragma once

#include <vector>

#include "core/surfaces/convex_surface.h"

/// One body's half of a contact: where its closest point is, its outward normal there, and how both move.
namespace touchstone {

/// How a body's closest point and normal are made of unknowns (section IV and the appendix of the paper).
enum class SideKind {
  smooth,        ///< one inequality f: unknown a (Dim), row f(a) = 0, N = grad f / |grad f|
  plane,         ///< one plane: unknown s (Dim - 1 in-plane coordinates), no row, N constant in the body
  intersection,  ///< m inequalities: unknowns a (Dim) and l (m), rows 0 <= l_i _|_ -f_i(a) >= 0, N = sum l_i
                 ///< grad f_i
};

template <int Dim>
struct Side {
  SideKind kind = SideKind::smooth;
  const ConvexSurface<Dim>* surface = nullptr;

  [[nodiscard]] int point_unknowns() const { return kind == SideKind::plane ? Dim - 1 : Dim; }
  [[nodiscard]] int multipliers() const { return kind == SideKind::intersection ? surface->count() : 0; }
};

template <int Dim>
Side<Dim> make_side(const ConvexSurface<Dim>& surface) {
  if (surface.plane() != nullptr) return {SideKind::plane, &surface};
  return {surface.count() == 1 ? SideKind::smooth : SideKind::intersection, &surface};
}

template <int Dim>
using PlaneChart = Eigen::Matrix<double, Dim, Dim - 1>;

/// An orthonormal basis of the plane with unit normal `n`.
inline PlaneChart<2> plane_basis(const Vector<2>& n) { return {n.y(), -n.x()}; }
inline PlaneChart<3> plane_basis(const Vector<3>& n) {
  PlaneChart<3> basis;
  basis.col(0) = n.unitOrthogonal();
  basis.col(1) = n.cross(Vector<3>(basis.col(0)));
  return basis;
}

/// A side evaluated at a pose and at its unknowns. Positions are relative to the contact's origin, axes are
/// the world's.
///
/// With xi the motion of the point relative to the body, d xi = d a - d p - d theta x r, the normal turns as
///   d N = curvature d xi + d theta x N + sum_i gradients[i] d l_i   (the last for intersections only).
template <int Dim>
struct SideState {
  Vector<Dim> point = Vector<Dim>::Zero();    ///< a [m]
  Vector<Dim> arm = Vector<Dim>::Zero();      ///< r = a - p [m]
  Vector<Dim> normal = Vector<Dim>::Zero();   ///< N, outward; of unit length unless the kind is intersection
  Matrix<Dim> hessian = Matrix<Dim>::Zero();  ///< of f, or of sum_i l_i f_i, body axes
  double length = 1.0;                        ///< |grad f| of a smooth side
  Matrix<Dim> curvature = Matrix<Dim>::Zero();      ///< filled by differentiate_side() only
  PlaneChart<Dim> chart = PlaneChart<Dim>::Zero();  ///< d a / d s of a plane
  std::vector<double> values;                       ///< f_i(a) [m], one an inequality; none for a plane
  std::vector<Vector<Dim>> gradients;               ///< grad f_i(a), world axes

  void reserve(const Side<Dim>& side) {
    const auto rows = static_cast<std::size_t>(side.surface->count());
    values.resize(rows);
    gradients.resize(rows);
  }
};

/// Fills everything but `point`, `arm` and `curvature` from the surface; `pose.position` is relative to the
/// contact's origin.
/// @param multipliers  l, side.multipliers() entries
template <int Dim>
void evaluate_side(const Side<Dim>& side, const Pose<Dim>& pose, const double* multipliers,
                   SideState<Dim>& state);

/// Fills `curvature` of a side that was evaluated at the same pose.
template <int Dim>
void differentiate_side(const Side<Dim>& side, const Pose<Dim>& pose, SideState<Dim>& state);

}  // namespace touchstone
