#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/method.h"
#include "core/surfaces/convex_surface.h"

/// Whether a step's answer solves Eqs. 10-11, written from the equations and read-back states alone. Shares
/// nothing with the solvers and the rows that they solve but the surfaces: rotations, moments, multipliers
/// and distances are computed here in another way.
namespace touchstone::certificate {

/// What a solution has to fulfil, in the order in which a report names equals. Residuals are without unit:
/// lengths over L, velocities over V, impulses over the (lighter) moving body's mass times V, moments over
/// its radius of gyration too (Units).
enum class Condition {
  finite,            ///< no NaN and no infinity
  linear_momentum,   ///< m v' = m v + h (m g + f) + sum p
  angular_momentum,  ///< I w' = I w - h w x I w + sum r x p + p_r n, I at the start, r at the end of the step
  position,          ///< x' = x + h v'
  orientation,       ///< R' = exp(h w') R
  unit_quaternion,   ///< |q'| = 1
  joint,             ///< anchors, axes and orientations together
  frame,             ///< n, t, o orthonormal; t along the law's direction where e_t != e_o
  surface,           ///< max_i f_i(a) = 0 for both points, Eqs. 9 and 20
  opposite,          ///< a_1 - a_2 along n
  normal,            ///< -n and n in the normal cones of body 1 at a_1 and of body 2 at a_2, Eqs. 9, 20-22
  multipliers,       ///< l >= 0, l_i f_i = 0, for those that the answer tells
  normal_impulse,    ///< p_n >= 0
  gap,               ///< psi = n . (a_1 - a_2) >= 0
  complementarity,   ///< p_n or psi is 0
  friction_cone,     ///< |E^-1 p_f| <= mu p_n, and no friction where E is 0
  dissipation,       ///< mu p_n w + |w| y = 0, y = E^-1 p_f, w = E v_f: Eq. 5
  slip_outside,      ///< |w| or mu p_n - |y| is 0: Eq. 11
  separation,        ///< bodies without a contact in the answer do not overlap
};
inline constexpr std::size_t kConditions = static_cast<std::size_t>(Condition::separation) + 1;
std::string_view to_string(Condition condition);

/// Units that make residuals comparable.
struct Units {
  double length = 1.0;    ///< L: radius of the largest moving body's bounding ball [m]
  double velocity = 1.0;  ///< V = sqrt(|g| L), or L / (1 s) without gravity [m/s]
};

/// A step: problem and answer. Spans outlive the check.
template <int Dim>
struct Step {
  std::span<const BodyState<Dim>> before;
  std::span<const BodyState<Dim>> after;
  std::span<const ContactImpulse<Dim>> contacts;
  std::span<const JointImpulse<Dim>> joints;
  double h = 0.0;  ///< [s]
  /// The multipliers l of each contact, of body a and of body b: as many as the surface has inequalities, or
  /// none where the answer does not tell them. Empty: of no contact.
  std::span<const std::array<std::vector<double>, 2>> multipliers = {};
};

/// By how much a condition is missed, and how much of that the rounding of the answer's own numbers explains.
///
/// The answer is told in rounded world coordinates and velocities, which no step can choose finer than their
/// spacing: 4e-15 m at 25 m. Some conditions magnify that: a normal turns by curvature times the point's
/// spacing, which is 3e-10 on the rounded apex of a cone, and Eq. 5 multiplies slip by a load that may be 1e4
/// m V.
struct Missed {
  Missed(double missed, double explained = 0.0) : residual(missed), rounding(explained) {}
  double residual;
  double rounding;
  /// What rounding does not explain; NaN stays.
  [[nodiscard]] double beyond() const { return residual > rounding ? residual - rounding : residual * 0; }
};

/// By how much each condition is missed, and where most.
struct Report {
  struct Worst {
    double residual = 0.0;
    int subject = -1;  ///< body of momentum, motion; contact; joint; of `separation` see `other`
    int other = -1;    ///< `separation`: the second body
  };
  std::array<Worst, kConditions> worst{};
  double beyond_rounding = 0.0;  ///< largest of what rounding does not explain, of all conditions

  [[nodiscard]] const Worst& operator[](Condition c) const { return worst[static_cast<std::size_t>(c)]; }
  [[nodiscard]] double residual(Condition c) const { return (*this)[c].residual; }
  /// The condition with the largest residual; NaN is larger than any number.
  [[nodiscard]] Condition worst_condition() const;
  [[nodiscard]] double largest() const { return residual(worst_condition()); }
  [[nodiscard]] bool holds(double tolerance) const { return largest() <= tolerance; }
  [[nodiscard]] bool holds_but_for_rounding(double tolerance) const { return beyond_rounding <= tolerance; }

  void note(Condition c, const Missed& missed, int subject, int other = -1);
};

/// Which contacts are held to the conditions of closest points, gap and friction.
enum class Contacts {
  all,
  loaded,  ///< those with an impulse: other methods list points that are nothing but near
};

template <int Dim>
struct Momentum;

template <int Dim>
class Checker {
 public:
  /// @param scene  must outlive the checker. @throws Unsupported for a shape without a surface
  explicit Checker(const Scene<Dim>& scene);

  [[nodiscard]] const Units& units() const { return units_; }

  /// Every condition, separation included: the certificate.
  [[nodiscard]] Report certify(const Step<Dim>& step) const;
  /// Every condition but `separation`.
  [[nodiscard]] Report check(const Step<Dim>& step, Contacts which) const;

  /// "dissipation of ball on ground: 3.2e-07"
  [[nodiscard]] std::string describe(const Report& report, const Step<Dim>& step) const;

 private:
  using State = std::span<const BodyState<Dim>>;

  void check_body(std::size_t i, const Step<Dim>& step, const Momentum<Dim>& missing, Report& report) const;
  void check_joint(std::size_t i, const Step<Dim>& step, Report& report) const;
  void check_contact(std::size_t i, const Step<Dim>& step, Report& report) const;
  void check_frame(std::size_t i, const ContactImpulse<Dim>& c, Report& report) const;
  void check_points(std::size_t i, const ContactImpulse<Dim>& c, State after, Report& report) const;
  void check_multipliers(std::size_t i, const Step<Dim>& step, Report& report) const;
  void check_gap(std::size_t i, const ContactImpulse<Dim>& c, Report& report) const;
  void check_friction(std::size_t i, const ContactImpulse<Dim>& c, State after, Report& report) const;
  void check_separation(const Step<Dim>& step, Report& report) const;
  /// By how much `outward` (world frame) misses the normal cone of the body at `point`.
  [[nodiscard]] Missed normal_missed(int body, const BodyState<Dim>& state, const Vector<Dim>& point,
                                     const Vector<Dim>& outward) const;
  [[nodiscard]] double impulse_unit(const ContactImpulse<Dim>& c) const;

  const Scene<Dim>& scene_;
  Units units_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
};

}  // namespace touchstone::certificate
