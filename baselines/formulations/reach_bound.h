#pragma once

#include <span>

#include "core/model/scene.h"

namespace touchstone {

/// A fixed half-space as one body with vertices sees it at the start of the step.
template <int Dim>
struct PlaneBelow {
  Vector<Dim> normal = Vector<Dim>::Zero();
  double least_gap = 0.0;  ///< of all vertices, < 0 when one is inside [m]
  double friction = 0.0;   ///< largest |p_f| / p_n that the friction pyramid allows
};

/// What is known of the velocity nu' of a body that touches fixed half-spaces only BEFORE its step is solved,
/// and hence which vertices the step cannot bring down. Holds for every solution of the Stewart-Trinkle
/// problem with all vertices, and with any part of them.
///
/// Theorem. Let u be a velocity such that at every vertex v, with u_v the velocity that u gives to it and
/// u_t,v its part along the plane,
///   psi_v / h + n_v . u_v - friction |u_t,v| >= 0.
/// Then nu' lies in the ball, in the norm |x|_M^2 = x^T M x, that has u and the contact-free velocity nu_f as
/// opposite ends.
///
/// Proof. With p_v the impulse at v,  M (nu' - nu_f) = sum W_v p_v.  By complementarity
/// p_n (psi / h + n . v') = 0,  and by maximum dissipation  p_f . v_t' <= 0.  So
///   (nu' - u)^T M (nu' - nu_f) = sum -p_n psi / h + p_f . v_t' - p_n n . u_v - p_f . u_t,v
///                             <= sum -p_n (psi / h + n . u_v - friction |u_t,v|)
///                             <= 0,
/// which is Thales' ball: the points that see its diameter under a right angle or more. []
///
/// Here u is the translation that lifts the body out of what it has penetrated: zero if nothing is
/// penetrated, and then |nu'|_M <= |nu_f|_M, the bound by energy, is part of it. With one half-space u always
/// fits; with several it is tried, and known() tells. With one half-space, moreover,  n . v' >= n . v_f  at
/// the centre of mass, because normal impulses only push and friction is perpendicular to n.
template <int Dim>
class ReachBound {
 public:
  /// @param mass     [kg]
  /// @param inertia  about the centre of mass, world frame [kg m^2]
  /// @param free     nu_f: what the body's velocity would be at the end of the step without contact
  /// @param planes   all half-spaces that the body can touch
  /// @param h        step [s]
  ReachBound(double mass, const Inertia<Dim>& inertia, const Twist<Dim>& free,
             std::span<const PlaneBelow<Dim>> planes, double h);

  /// False if no u was found; then any vertex may be reached and the bounds are not to be asked for.
  [[nodiscard]] bool known() const { return known_; }
  /// Least normal . v' at the centre of mass; `normal` is that of one of the planes, [m/s].
  [[nodiscard]] double least_normal_speed(const Vector<Dim>& normal) const;
  /// Least axis . omega', [rad/s] times the axis' length.
  [[nodiscard]] double least_turn(const Angular<Dim>& axis) const;
  /// Least rate of the gap of a vertex at `arm` from the centre of mass, [m/s].
  [[nodiscard]] double least_gap_rate(const Vector<Dim>& normal, const Vector<Dim>& arm) const {
    return least_normal_speed(normal) + least_turn(moment(arm, normal));
  }

 private:
  bool known_ = false;
  bool one_plane_ = false;
  double mass_ = 1.0;
  Inertia<Dim> inverse_inertia_ = Inertia<Dim>::Identity();
  Twist<Dim> free_ = Twist<Dim>::Zero();
  Twist<Dim> center_ = Twist<Dim>::Zero();  ///< of the ball
  double radius_ = 0.0;                     ///< in the norm of M, [sqrt(J)]
};

}  // namespace touchstone
