#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/scene.h"

/// The interface that every method stands behind, ours and the engines' alike: load a scene, step, read back.
namespace touchstone {

enum class StepStatus {
  solved,         ///< the step's problem is solved to the method's tolerance
  not_converged,  ///< the solver gave up; the state is as it was before the step
  non_finite,     ///< the method produced a NaN or an infinity
};
std::string_view to_string(StepStatus status);

/// What a method says of one step. Complete on every exit.
struct StepReport {
  StepStatus status = StepStatus::solved;
  int iterations = 0;  ///< of the method's own solver: Newton steps, pivots, sweeps; 0 if it does not tell
  double residual =
      0.0;  ///< of the problem that the method solves, in its own measure; not what it is judged by
  std::string_view reason = {};  ///< why it is not solved, e.g. "ray termination"; refers to static storage
};

/// One contact of the last step, as read back. The impulse acts on `body_a`; `body_b` gets its opposite.
template <int Dim>
struct ContactImpulse {
  int body_a = 0;
  int body_b = 0;
  Vector<Dim> point_a = Vector<Dim>::Zero();  ///< where it acts on body_a, world frame, end of step [m]
  Vector<Dim> point_b = Vector<Dim>::Zero();
  Vector<Dim> normal = Vector<Dim>::Zero();                ///< unit, world frame, from body_b into body_a
  TangentBasis<Dim> tangents = TangentBasis<Dim>::Zero();  ///< columns t (and o)
  double normal_impulse = 0.0;                             ///< p_n >= 0 [N s]
  FrictionVector<Dim> friction_impulse = FrictionVector<Dim>::Zero();  ///< p_t, p_o [N s], p_r [N m s]
};

/// What a joint did in the last step, as wrenches [N s; N m s] about the bodies' centres of mass.
template <int Dim>
struct JointImpulse {
  int joint = 0;  ///< index in Scene::joints
  Twist<Dim> on_a = Twist<Dim>::Zero();
  Twist<Dim> on_b = Twist<Dim>::Zero();
};

/// By how much a method itself takes the state of one body to be off.
template <int Dim>
struct StateError {
  Vector<Dim> position = Vector<Dim>::Zero();  ///< [m]
  Angular<Dim> turn = Angular<Dim>::Zero();    ///< rotation vector about world axes [rad]
  Twist<Dim> velocity = Twist<Dim>::Zero();    ///< [m/s, rad/s]
};

/// What a method can represent; a conformance test checks that each claim is true.
struct Capabilities {
  bool contact_impulses =
      true;  ///< contacts() tells what acted in the last step, and accounts for the momentum
  /// state() after a step is the end of one step from state() before it. False where it is made of several
  /// runs: then equations of a step, Eqs. 10-11 among them, hold for each of those and not for state().
  bool one_run = true;
  bool torsional_friction = false;
  bool anisotropic_friction = false;
  bool restitution = false;
  bool joints = false;
};

/// Options of a method by name, as given on a command line: name=value.
using Options = std::map<std::string, std::string>;

template <int Dim>
class Method {
 public:
  virtual ~Method() = default;

  [[nodiscard]] virtual Capabilities capabilities() const = 0;
  /// The scene as this method represents it: with its polygons for discs, say. What it is judged on.
  [[nodiscard]] virtual const Scene<Dim>& scene() const = 0;
  /// One entry a body of the scene, fixed ones included.
  [[nodiscard]] virtual std::span<const BodyState<Dim>> state() const = 0;
  /// The contacts of the last step, those without an impulse included where the method keeps them.
  [[nodiscard]] virtual std::span<const ContactImpulse<Dim>> contacts() const = 0;
  /// The joints' impulses of the last step; none from a method without joints or one that does not tell.
  [[nodiscard]] virtual std::span<const JointImpulse<Dim>> joints() const { return {}; }
  /// By how much state() is estimated to be off, one entry a body, fixed ones included; none from a method
  /// without an estimate.
  [[nodiscard]] virtual std::span<const StateError<Dim>> error_estimate() const { return {}; }
  /// Advances by h [s], h > 0. If it is not solved the state is as it was.
  [[nodiscard]] virtual StepReport step(double h) = 0;
  /// Every option with the value in force, defaults included.
  [[nodiscard]] virtual Options effective_options() const = 0;
};

}  // namespace touchstone
