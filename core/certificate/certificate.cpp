#include "core/certificate/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/certificate/body_conditions.h"

namespace touchstone::certificate {

std::string_view to_string(Condition condition) {
  static constexpr std::array<std::string_view, kConditions> kNames = {"finite",
                                                                       "linear momentum",
                                                                       "angular momentum",
                                                                       "position",
                                                                       "orientation",
                                                                       "unit quaternion",
                                                                       "joint",
                                                                       "frame",
                                                                       "surface",
                                                                       "opposite points",
                                                                       "normal",
                                                                       "multipliers",
                                                                       "normal impulse",
                                                                       "gap",
                                                                       "complementarity",
                                                                       "friction cone",
                                                                       "dissipation",
                                                                       "slip outside",
                                                                       "separation"};
  return kNames[static_cast<std::size_t>(condition)];
}

// Comparisons are written so that a NaN wins, and stays.
void Report::note(Condition c, const Missed& missed, int subject, int other) {
  if (!std::isnan(beyond_rounding) && !(missed.beyond() <= beyond_rounding))
    beyond_rounding = missed.beyond();
  Worst& w = worst[static_cast<std::size_t>(c)];
  if (std::isnan(w.residual) || missed.residual <= w.residual) return;
  w = {missed.residual, subject, other};
}

Condition Report::worst_condition() const {
  std::size_t at = 0;
  for (std::size_t c = 0; c < kConditions; ++c) {
    if (std::isnan(worst[c].residual)) return static_cast<Condition>(c);
    if (worst[c].residual > worst[at].residual) at = c;
  }
  return static_cast<Condition>(at);
}

namespace {

/// Change of each body's momentum less what acts on it; of fixed bodies not meant. One pass over contacts and
/// joints for all bodies, so that many bodies take a time in proportion.
template <int Dim>
std::vector<Momentum<Dim>> missing_momentum(const Scene<Dim>& scene, const Step<Dim>& step) {
  std::vector<Momentum<Dim>> missing(scene.bodies.size());
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const Body<Dim>& body = scene.bodies[i];
    if (body.fixed) continue;
    missing[i] = change_of_momentum(body, step.before[i], step.after[i]);
    missing[i].linear -= step.h * (body.mass * scene.gravity + body.force);
    missing[i].angular -= step.h * gyroscopic_moment(body, step.before[i]);
  }
  for (const auto& c : step.contacts) {
    const auto a = static_cast<std::size_t>(c.body_a);
    const auto b = static_cast<std::size_t>(c.body_b);
    missing[a] -= contact_impulse(c, c.point_a - step.after[a].pose.position);
    missing[b] += contact_impulse(c, c.point_b - step.after[b].pose.position);
  }
  for (const auto& j : step.joints) {
    const Joint<Dim>& joint = scene.joints[static_cast<std::size_t>(j.joint)];
    missing[static_cast<std::size_t>(joint.body_a)] -= joint_impulse<Dim>(j.on_a);
    missing[static_cast<std::size_t>(joint.body_b)] -= joint_impulse<Dim>(j.on_b);
  }
  return missing;
}

}  // namespace

template <int Dim>
Checker<Dim>::Checker(const Scene<Dim>& scene) : scene_(scene) {
  double size = 0;
  for (const auto& body : scene.bodies) {
    surfaces_.push_back(make_surface(body.shape));
    const double radius = surfaces_.back()->bounding_ball().radius;
    if (!body.fixed && std::isfinite(radius)) size = std::max(size, radius);
  }
  if (size > 0) units_.length = size;
  const double g = scene.gravity.norm();
  units_.velocity = g > 0 ? std::sqrt(g * units_.length) : units_.length;
}

template <int Dim>
Report Checker<Dim>::check(const Step<Dim>& step, Contacts which) const {
  Report report;
  const std::vector<Momentum<Dim>> missing = missing_momentum(scene_, step);
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const bool finite = step.after[i].pose.is_finite() && step.after[i].velocity.allFinite();
    if (!finite) report.note(Condition::finite, std::numeric_limits<double>::infinity(), static_cast<int>(i));
    if (!scene_.bodies[i].fixed) check_body(i, step, missing[i], report);
  }
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) check_joint(i, step, report);
  for (std::size_t i = 0; i < step.contacts.size(); ++i) {
    const ContactImpulse<Dim>& c = step.contacts[i];
    const bool loaded = c.normal_impulse != 0 || !c.friction_impulse.isZero(0);
    if (which == Contacts::all || loaded) check_contact(i, step, report);
  }
  return report;
}

template <int Dim>
Report Checker<Dim>::certify(const Step<Dim>& step) const {
  Report report = check(step, Contacts::all);
  check_separation(step, report);
  return report;
}

template <int Dim>
void Checker<Dim>::check_body(std::size_t i, const Step<Dim>& step, const Momentum<Dim>& missing,
                              Report& report) const {
  const int subject = static_cast<int>(i);
  const Body<Dim>& body = scene_.bodies[i];
  const BodyState<Dim>& before = step.before[i];
  const BodyState<Dim>& after = step.after[i];
  const double unit = body.mass * units_.velocity;
  const double gyration = std::sqrt(body.inertia.trace() / (Dimension<Dim>::angular * body.mass));
  report.note(Condition::linear_momentum, missing.linear.cwiseAbs().maxCoeff() / unit, subject);
  report.note(Condition::angular_momentum, missing.angular.cwiseAbs().maxCoeff() / (unit * gyration),
              subject);
  const Vector<Dim> moved = before.pose.position + step.h * after.velocity.template head<Dim>();
  report.note(Condition::position, (after.pose.position - moved).norm() / units_.length, subject);
  report.note(Condition::orientation, turn_error(before, after, step.h), subject);
  report.note(Condition::unit_quaternion, norm_error(after.pose.rotation), subject);
}

/// Distance of the anchors across the directions that the joint blocks, and turn away from the initial
/// relative orientation (of a hinge: of the axis) [rad].
template <int Dim>
void Checker<Dim>::check_joint(std::size_t i, const Step<Dim>& step, Report& report) const {
  const Joint<Dim>& joint = scene_.joints[i];
  const auto a = static_cast<std::size_t>(joint.body_a);
  const auto b = static_cast<std::size_t>(joint.body_b);
  const Pose<Dim>& start_a = scene_.bodies[a].pose;
  const Pose<Dim>& start_b = scene_.bodies[b].pose;
  const Pose<Dim>& end_a = step.after[a].pose;
  const Pose<Dim>& end_b = step.after[b].pose;
  const auto turned = [](const Pose<Dim>& start, const Pose<Dim>& end, const Vector<Dim>& direction) {
    return Vector<Dim>(end.rotation.matrix() * (start.rotation.matrix().transpose() * direction));
  };
  Vector<Dim> gap =
      end_a.to_world(start_a.to_body(joint.anchor)) - end_b.to_world(start_b.to_body(joint.anchor));
  if (joint.type == JointType::slider) {
    const Vector<Dim> axis = turned(start_b, end_b, joint.axis);
    gap -= axis.dot(gap) * axis;
  }
  const int subject = static_cast<int>(i);
  report.note(Condition::joint, gap.norm() / units_.length, subject);
  const auto note_turn = [&](const Vector<Dim>& axis) {
    const double turn = (turned(start_a, end_a, axis) - turned(start_b, end_b, axis)).norm();
    report.note(Condition::joint, turn, subject);
  };
  if (joint.type == JointType::hinge && Dim == 3) note_turn(joint.axis);
  if (joint.type == JointType::slider || joint.type == JointType::fixed) {
    for (int k = 0; k < Dim; ++k) note_turn(Vector<Dim>::Unit(k));
  }
}

template <int Dim>
std::string Checker<Dim>::describe(const Report& report, const Step<Dim>& step) const {
  const Condition c = report.worst_condition();
  const Report::Worst& worst = report[c];
  const auto name = [&](int body) { return scene_.bodies[static_cast<std::size_t>(body)].name; };
  std::string subject;
  if (worst.subject >= 0) {
    if (c == Condition::joint) {
      const Joint<Dim>& joint = scene_.joints[static_cast<std::size_t>(worst.subject)];
      subject = fmt::format(" of {} and {}", name(joint.body_a), name(joint.body_b));
    } else if (c == Condition::separation) {
      subject = fmt::format(" of {} and {}", name(worst.subject), name(worst.other));
    } else if (c < Condition::joint) {
      subject = fmt::format(" of {}", name(worst.subject));
    } else {
      const ContactImpulse<Dim>& contact = step.contacts[static_cast<std::size_t>(worst.subject)];
      subject = fmt::format(" of {} on {}", name(contact.body_a), name(contact.body_b));
    }
  }
  return fmt::format("{}{}: {:.1e}", to_string(c), subject, worst.residual);
}

template class Checker<2>;
template class Checker<3>;

}  // namespace touchstone::certificate
