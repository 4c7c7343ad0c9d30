#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/method.h"
#include "core/surfaces/convex_surface.h"
#include "experiments/harness/judge.h"

/// Where the mechanical energy of a trajectory goes, from read-back states and contact impulses alone:
///
///   T' - T = W_applied - D_friction - L_impact + drift.
///
/// Over a step with a constant mass matrix M and the momentum balance M (nu' - nu) = h f + sum_c W_c p_c,
///
///   T' - T = (nu + nu')^T M (nu' - nu) / 2 = h f . (nu + nu')/2 + sum_c p_c . (u_c + u_c')/2,
///
/// with u_c and u_c' = W_c^T nu' the relative velocities at the contact before and after the step. So each
/// impulse's work is its product with the MEAN of the two,
///
///   D_friction = -sum_c p_f . (u_f + u_f')/2,      L_impact = -sum_c p_n (u_n + u_n')/2,
///
/// with no remainder as long as u_c = W_c^T nu with the same W_c. The slip at the end of the step alone would
/// do for neither of these: for a body that slides to rest it books m v mu g h / 2 too little of m v^2 / 2,
/// and for slip that an impact stops at once it books nothing.
///
/// Curved bodies turn W_c within the step, and that is to be drift, neither friction nor impact. Therefore a
/// contact that is still on the same features of both bodies (vertex, edge, face or smooth patch: the
/// inequalities that hold with equality) as in the last step has for u_c its own u_c' of that step. And its
/// u_n' is the rate of its gap over the step, because a step that ends in touch moves along the chord and not
/// along the tangent. So whatever rolls without slip loses nothing to friction or impact, and resting on a
/// curved body is no impact either. A contact that is new, or on a new feature as that of a polygon which
/// rolls over a corner, has W_c^T nu and W_c^T nu'.
///
/// The drift is what is left: forces that work along h v' instead of h (v + v')/2, geometry that turns, the
/// gyroscopic impulse, an inertia that turns with its body, impulses that acted through another W than the
/// one at the end of the step, or that a method does not tell, joints, and rounding.
namespace touchstone {

/// How two bodies move against each other at a contact, a against b, world frame.
template <int Dim>
struct RelativeMotion {
  double normal = 0.0;                         ///< u_n along the contact's normal [m/s]; > 0: they part
  Vector<Dim> velocity = Vector<Dim>::Zero();  ///< of a's material point against b's [m/s]
  double spin = 0.0;                           ///< about the normal [rad/s]; 0 in the plane

  /// u_f: slip along the columns of `tangents`, and in space the spin.
  [[nodiscard]] FrictionVector<Dim> friction(const TangentBasis<Dim>& tangents) const;
};

/// With the contact's points and normal at the poses in `at`.
/// @param velocities  of which the generalised velocities are read, and not the poses
template <int Dim>
RelativeMotion<Dim> relative_motion(const ContactImpulse<Dim>& contact, std::span<const BodyState<Dim>> at,
                                    std::span<const BodyState<Dim>> velocities);

/// Since the start, all [J].
struct EnergyAccount {
  double applied_work =
      0.0;  ///< of gravity and the bodies' constant forces, along the path: the fall of the potential
  double friction_loss = 0.0;  ///< D; sliding and torsion
  double impact_loss = 0.0;    ///< L; < 0 where contacts drive bodies apart
  double drift = 0.0;          ///< what is left; it contains joint_work
  double joint_work = 0.0;     ///< by the joints' impulses that the method tells; ideal joints do none
};

/// Books one step after another.
template <int Dim>
class EnergyLedger {
 public:
  /// @param scene  as the method represents it; must outlive the ledger, as must
  /// @param judge  its judge
  /// @param start  the state that the trajectory begins in
  EnergyLedger(const Scene<Dim>& scene, const Judge<Dim>& judge, std::span<const BodyState<Dim>> start);

  /// Books the step of `h` [s] from `before` to `after`, the read-back states of all bodies.
  void book(double h, std::span<const BodyState<Dim>> before, std::span<const BodyState<Dim>> after,
            std::span<const ContactImpulse<Dim>> contacts, std::span<const JointImpulse<Dim>> joints);

  [[nodiscard]] const EnergyAccount& account() const { return account_; }
  /// Now.
  [[nodiscard]] const Energy& energy() const { return energy_; }

 private:
  /// A contact of the last step as the next one finds it.
  struct Known {
    std::pair<int, int> bodies;  ///< a, b
    std::vector<int> features_a;
    std::vector<int> features_b;
    Vector<Dim> point =
        Vector<Dim>::Zero();  ///< on a, in its frame, to tell contacts on one feature apart [m]
    double gap = 0.0;         ///< [m]
    RelativeMotion<Dim> motion;
  };

  [[nodiscard]] Known known(const ContactImpulse<Dim>& contact, std::span<const BodyState<Dim>> state) const;
  [[nodiscard]] const Known* in_last_step(const Known& contact) const;
  [[nodiscard]] static bool in_order(const Known& x, const Known& y) { return x.bodies < y.bodies; }
  void book_joints(std::span<const BodyState<Dim>> before, std::span<const BodyState<Dim>> after,
                   std::span<const JointImpulse<Dim>> joints);

  const Scene<Dim>& scene_;
  const Judge<Dim>& judge_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
  Energy start_;
  Energy energy_;
  EnergyAccount account_;
  std::vector<Known> last_;  ///< in the order of their bodies
  std::vector<Known> now_;
};

}  // namespace touchstone
