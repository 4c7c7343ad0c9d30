#pragma once

#include <string>
#include <vector>

#include "core/model/shape.h"

namespace touchstone {

/// What happens where two bodies touch.
/// Friction: maximum dissipation over (p_t/e_t)^2 + (p_o/e_o)^2 + (p_r/e_r)^2 <= (mu p_n)^2 (Eq. 5). In the
/// plane e_o, e_r are not read.
template <int Dim>
struct ContactLaw {
  double mu = 0.0;           ///< coefficient of friction
  double e_t = 1.0;          ///< semi-axis along t
  double e_o = 1.0;          ///< semi-axis along o
  double e_r = 0.0;          ///< semi-axis of torsion [m]; 0: no torsional friction
  double restitution = 0.0;  ///< Newton's coefficient; 0: plastic
  /// World direction whose projection on the contact plane is t. Matters only if e_t != e_o.
  Vector<Dim> tangent = Vector<Dim>::UnitX();

  /// E as a vector, in the order t, o, r.
  [[nodiscard]] FrictionVector<Dim> semi_axes() const;
};

template <int Dim>
struct Body {
  std::string name;
  bool fixed = false;  ///< does not move; mass, inertia, velocity and loads are not read
  double mass = 1.0;   ///< [kg]
  Inertia<Dim> inertia = Inertia<Dim>::Identity();  ///< about the centre of mass, body frame [kg m^2]
  Pose<Dim> pose{};
  Twist<Dim> velocity = Twist<Dim>::Zero();  ///< [v; omega], world frame
  Vector<Dim> force = Vector<Dim>::Zero();   ///< constant, world, at the centre of mass [N]
  Shape<Dim> shape{};
};

/// An exception to the scene's default contact law for one pair of bodies (indices, any order).
template <int Dim>
struct PairLaw {
  int body_a = 0;
  int body_b = 0;
  ContactLaw<Dim> law{};
};

enum class JointType {
  ball,    ///< one point of both bodies stays together; in the plane the same as a hinge
  hinge,   ///< and an axis; both may turn about it
  slider,  ///< no relative turn, and relative motion only along an axis
  fixed,   ///< no relative motion
};

/// A bilateral constraint between two bodies ("all of the discussion holds in the presence of bilateral
/// constraints", section III). Two bodies that a joint couples do not collide with each other.
template <int Dim>
struct Joint {
  JointType type = JointType::ball;
  int body_a = 0;
  int body_b = 0;
  Vector<Dim> anchor = Vector<Dim>::Zero();  ///< world frame, in the initial pose [m]
  Vector<Dim> axis =
      Vector<Dim>::UnitX();  ///< unit, world frame, in the initial pose; of a slider, and of a hinge in space
};

/// A scene is pure data in SI units; methods load it, the judge reads it.
template <int Dim>
struct Scene {
  Vector<Dim> gravity = Vector<Dim>::Zero();  ///< [m/s^2]
  ContactLaw<Dim> contact_law{};
  std::vector<PairLaw<Dim>> pair_laws;
  std::vector<Body<Dim>> bodies;
  std::vector<Joint<Dim>> joints;

  /// The law of a pair: its own, or the default.
  [[nodiscard]] const ContactLaw<Dim>& law(int body_a, int body_b) const;
  /// Whether a joint couples the two bodies.
  [[nodiscard]] bool jointed(int body_a, int body_b) const;
  /// Index of the body called `name`. @throws InputError if there is none
  [[nodiscard]] int body(const std::string& name) const;
  /// @throws InputError naming the first field that makes no sense, its value and what is allowed
  void validate() const;
};

/// Position, orientation and velocity of one body.
template <int Dim>
struct BodyState {
  Pose<Dim> pose{};
  Twist<Dim> velocity = Twist<Dim>::Zero();
};

/// I in the world frame for a body at `rotation`.
inline Inertia<2> world_inertia(const Inertia<2>& body, const PlanarRotation&) { return body; }
inline Inertia<3> world_inertia(const Inertia<3>& body, const SpatialRotation& r) {
  return r.matrix() * body * r.matrix().transpose();
}

/// The state that each body of the scene starts in.
template <int Dim>
std::vector<BodyState<Dim>> initial_state(const Scene<Dim>& scene);

}  // namespace touchstone
