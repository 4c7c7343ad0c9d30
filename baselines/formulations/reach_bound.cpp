#include "baselines/formulations/reach_bound.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// u [m/s]: out of every half-space that is penetrated, by what is penetrated, in one step.
template <int Dim>
Vector<Dim> lifting_velocity(std::span<const PlaneBelow<Dim>> planes, double h) {
  Vector<Dim> u = Vector<Dim>::Zero();
  for (const auto& plane : planes) u += std::max(-plane.least_gap, 0.0) / h * plane.normal;
  return u;
}

/// The theorem's premise at every vertex: a translation is the same at all of them.
template <int Dim>
bool lifts(const Vector<Dim>& u, std::span<const PlaneBelow<Dim>> planes, double h) {
  return std::all_of(planes.begin(), planes.end(), [&](const PlaneBelow<Dim>& plane) {
    const double up = plane.normal.dot(u);
    const double along = (u - up * plane.normal).norm();
    return plane.least_gap / h + up - plane.friction * along >= 0;
  });
}

}  // namespace

template <int Dim>
ReachBound<Dim>::ReachBound(double mass, const Inertia<Dim>& inertia, const Twist<Dim>& free,
                            std::span<const PlaneBelow<Dim>> planes, double h)
    : one_plane_(planes.size() == 1), mass_(mass), inverse_inertia_(inertia.inverse()), free_(free) {
  const Vector<Dim> u = lifting_velocity(planes, h);
  // One half-space: the premise holds by construction, whatever rounding makes of it.
  known_ = one_plane_ || lifts(u, planes, h);
  Twist<Dim> diameter = free;
  diameter.template head<Dim>() -= u;
  center_ = free - diameter / 2;
  const Angular<Dim> turn = diameter.template tail<Dimension<Dim>::angular>();
  radius_ = std::sqrt(mass * diameter.template head<Dim>().squaredNorm() + turn.dot(inertia * turn)) / 2;
}

template <int Dim>
double ReachBound<Dim>::least_normal_speed(const Vector<Dim>& normal) const {
  const double in_ball = normal.dot(center_.template head<Dim>()) - radius_ / std::sqrt(mass_);
  return one_plane_ ? std::max(in_ball, normal.dot(free_.template head<Dim>())) : in_ball;
}

template <int Dim>
double ReachBound<Dim>::least_turn(const Angular<Dim>& axis) const {
  return axis.dot(center_.template tail<Dimension<Dim>::angular>()) -
         radius_ * std::sqrt(axis.dot(inverse_inertia_ * axis));
}

template class ReachBound<2>;
template class ReachBound<3>;

}  // namespace touchstone
