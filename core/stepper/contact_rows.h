#pragma once

#include "core/contact/frame.h"
#include "core/stepper/friction_law.h"
#include "core/stepper/layout.h"

/// The rows of Eqs. 10-11 that belong to one contact, and their derivatives.
namespace touchstone {

template <int Dim>
class MotionJacobian;

/// Which gap the normal complementarity is written with.
enum class GapFunction {
  /// f(a_2), the value of body 1's inequality at body 2's closest point (Eq. 6). Only where body 1 is one
  /// inequality: for an
  /// intersection the signed distance is used, since Eq. 19 does not keep bodies apart (see
  /// contact_rows.cpp).
  workspace,
  distance,  ///< psi = n . (a_1 - a_2), the signed distance
};

/// Units that make rows comparable: lengths over `length`, velocities over `velocity`.
struct Scale {
  double length = 1.0;    ///< L: the largest moving body's size [m]
  double velocity = 1.0;  ///< V = sqrt(|g| L), or L / (1 s) without gravity [m/s]
};

/// Acts on a twist or gives a wrench of one.
template <int Dim>
using MotionMatrix = Eigen::Matrix<double, Dimension<Dim>::velocity, Dimension<Dim>::velocity>;

/// One body at the end of the step, as a function of its unknown nu'.
template <int Dim>
struct BodyAtEnd {
  Pose<Dim> pose{};                           ///< position relative to the contact's origin
  Twist<Dim> nu = Twist<Dim>::Zero();         ///< nu' [m/s, rad/s]
  Inertia<Dim> turn = Inertia<Dim>::Zero();   ///< d(theta)/d(omega')
  Eigen::Index column = -1;                   ///< of its nu in z; -1 for a fixed body
  Twist<Dim> row_scale = Twist<Dim>::Zero();  ///< of its momentum rows
};

/// A plane at the start of the step, and the point of it that in-plane coordinates count from: the foot of
/// the contact's origin.
template <int Dim>
struct PlaneAtStart {
  Vector<Dim> foot = Vector<Dim>::Zero();       ///< relative to the contact's origin, so that it is small [m]
  Vector<Dim> foot_body = Vector<Dim>::Zero();  ///< the same point in the plane's body frame; may be far [m]
  Vector<Dim> position = Vector<Dim>::Zero();   ///< of the plane's body, relative to the contact's origin [m]
  Matrix<Dim> rotation = Matrix<Dim>::Identity();
  PlaneChart<Dim> basis = PlaneChart<Dim>::Zero();  ///< of the plane, in its body frame

  /// Where the foot is when the body has moved to `pose`. Written in differences: a plane that has not moved
  /// leaves the foot exactly where it was, however far from the plane body's own origin.
  [[nodiscard]] Vector<Dim> moved_foot(const Pose<Dim>& pose) const {
    return foot + (pose.position - position) + (pose.rotation.matrix() - rotation) * foot_body;
  }
};

/// What of a contact is fixed before a step's problem is solved.
template <int Dim>
struct PreparedContact {
  Vector<Dim> origin = Vector<Dim>::Zero();      ///< world point that positions are relative to
  Vector<Dim> reference = Vector<Dim>::UnitX();  ///< direction whose projection is t
  FrictionVector<Dim> semi_axes = FrictionVector<Dim>::Zero();  ///< E: t, o, r
  FrictionVector<Dim> active = FrictionVector<Dim>::Zero();     ///< 1 where E is not 0
  double mass = 1.0;                                            ///< m: unit of impulse is mass * V
  double rho = 1.0;                                             ///< of the projection form
  std::array<PlaneAtStart<Dim>, 2> plane{};                     ///< of a side that is a plane
};

/// Everything about one contact at one z.
template <int Dim>
struct ContactState {
  std::array<SideState<Dim>, 2> side{};
  std::array<BodyAtEnd<Dim>, 2> body{};
  ContactFrame<Dim> frame{};
  double normal_length = 1.0;                       ///< |N_2|; 1 unless body 2 is an intersection
  Vector<Dim> separation = Vector<Dim>::Zero();     ///< a_1 - a_2 [m]
  Vector<Dim> slip_velocity = Vector<Dim>::Zero();  ///< of body 1 against body 2 at the closest points [m/s]
  Angular<Dim> spin_velocity = Angular<Dim>::Zero();  ///< omega_1 - omega_2
  FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
  double p = 0.0;  ///< p_n / (m V)
  double s = 0.0;  ///< sigma / V

  // Filled by differentiate_contact() only, as are the sides' curvatures.
  FrameDerivative<Dim> frame_derivative{};
  Matrix<Dim> frame_curvature = Matrix<Dim>::Zero();  ///< d n = this d xi_2 + d theta_2 x n (+ multipliers)

  /// psi [m]
  [[nodiscard]] double distance() const { return frame.normal.dot(separation); }
};

/// E v_f of Eq. 5: slip along t (and o) and, in space, spin about n, times friction's semi-axes [m/s].
/// @param semi_axes  E: t, o, r; [-, -, m]
/// @param slip       velocity of body 1 against body 2 at the contact, world axes [m/s]
/// @param spin       angular velocity of body 1 against body 2, world axes [rad/s]; not read in the plane
template <int Dim>
FrictionVector<Dim> scaled_slip(const ContactFrame<Dim>& frame, const FrictionVector<Dim>& semi_axes,
                                const Vector<Dim>& slip, const Angular<Dim>& spin) {
  FrictionVector<Dim> v;
  v.template head<Dimension<Dim>::tangent>() = frame.tangents.transpose() * slip;
  if constexpr (Dim == 3) v[2] = frame.normal.dot(spin);
  return semi_axes.cwiseProduct(v);
}

struct ContactRowOptions {
  FrictionForm form = FrictionForm::projection;
  GapFunction gap = GapFunction::workspace;
  Scale scale{};
  double h = 0.0;
  double smoothing = 0.0;  ///< of the projection form of friction, see friction_rows()
};

/// Reads the contact's unknowns from z and evaluates both sides and the frame; `state.body` is filled by the
/// caller.
template <int Dim>
void evaluate_contact(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                      const ContactLayout& at, const Eigen::VectorXd& z, ContactState<Dim>& state);

/// What derivatives need beyond what evaluate_contact() filled, at the same z.
template <int Dim>
void differentiate_contact(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                           ContactState<Dim>& state);

/// Writes the contact's own rows and adds its wrench to the bodies' momentum rows. J may be null; else the
/// state is differentiated, and `turn` of its bodies is known.
template <int Dim>
void contact_rows(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared, const ContactLayout& at,
                  const ContactRowOptions& options, const ContactState<Dim>& state, Eigen::VectorXd& f,
                  Eigen::MatrixXd* jacobian);

/// Of a contact without multipliers, in the projection form of friction: friction's and gap's rows, and its
/// wrench, to f; their derivatives by motions of points and normal to `motions`, and those by velocities and
/// impulses directly to the Jacobian. What is added to is zero on entry.
template <int Dim>
void load_rows_by_motion(const ContactPair<Dim>& pair, const PreparedContact<Dim>& prepared,
                         const ContactLayout& at, const ContactRowOptions& options,
                         const ContactState<Dim>& state, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian,
                         MotionJacobian<Dim>& motions);

}  // namespace touchstone
