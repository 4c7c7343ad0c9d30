#include "experiments/harness/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/closest_points.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

namespace {

/// max that does not lose a NaN.
double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

Angular<2> gyroscopic_torque(const Angular<2>&, const Inertia<2>&) { return Angular<2>(0.0); }
Angular<3> gyroscopic_torque(const Angular<3>& omega, const Inertia<3>& inertia) {
  return -omega.cross(Vector<3>(inertia * omega));
}

/// Rotation by which two orientations differ, [rad].
double turn_between(const PlanarRotation& a, const PlanarRotation& b) {
  return std::abs(a.angle() - b.angle());
}
double turn_between(const SpatialRotation& a, const SpatialRotation& b) {
  const Eigen::Quaterniond difference = a.quaternion().conjugate() * b.quaternion();
  return 2 * std::asin(std::min(1.0, difference.vec().norm()));
}

template <int Dim>
double gyration_radius(const Body<Dim>& body) {
  return std::sqrt(body.inertia.trace() / (Dimension<Dim>::angular * body.mass));
}

}  // namespace

double StepResidual::largest() const {
  return worse(worse(worse(dynamics, kinematics), worse(contact, friction)), joints);
}

template <int Dim>
Judge<Dim>::Judge(const Scene<Dim>& scene) : scene_(scene), scale_(scene_scale(scene)) {
  for (const auto& body : scene.bodies) surfaces_.push_back(make_surface(body.shape));
}

template <int Dim>
Energy Judge<Dim>::energy(std::span<const BodyState<Dim>> state) const {
  Energy energy;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Body<Dim>& body = scene_.bodies[i];
    if (body.fixed) continue;
    const Vector<Dim> v = state[i].velocity.template head<Dim>();
    const Angular<Dim> omega = state[i].velocity.template tail<Dimension<Dim>::angular>();
    const Inertia<Dim> inertia = world_inertia(body.inertia, state[i].pose.rotation);
    energy.kinetic += 0.5 * (body.mass * v.squaredNorm() + omega.dot(inertia * omega));
    energy.potential -= (body.mass * scene_.gravity + body.force).dot(state[i].pose.position);
  }
  return energy;
}

template <int Dim>
double Judge<Dim>::largest_penetration(std::span<const BodyState<Dim>> state) const {
  double deepest = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    for (std::size_t j = i + 1; j < state.size(); ++j) {
      if (scene_.bodies[i].fixed && scene_.bodies[j].fixed) continue;
      if (scene_.jointed(static_cast<int>(i), static_cast<int>(j))) continue;  // they do not collide
      const auto ball_i = surfaces_[i]->bounding_ball();
      const auto ball_j = surfaces_[j]->bounding_ball();
      const double apart =
          (state[i].pose.to_world(ball_i.center) - state[j].pose.to_world(ball_j.center)).norm();
      if (apart > ball_i.radius + ball_j.radius) continue;
      const auto closest = closest_points(*surfaces_[i], state[i].pose, *surfaces_[j], state[j].pose);
      deepest = worse(deepest, -closest.gap);
    }
  }
  return deepest;
}

/// Unit of impulse at a contact: the lighter moving body's mass times V.
template <int Dim>
double Judge<Dim>::impulse_unit(const ContactImpulse<Dim>& c) const {
  double mass = std::numeric_limits<double>::infinity();
  for (const int index : {c.body_a, c.body_b}) {
    const Body<Dim>& body = scene_.bodies[static_cast<std::size_t>(index)];
    if (!body.fixed) mass = std::min(mass, body.mass);
  }
  return mass * scale_.velocity;
}

template <int Dim>
double Judge<Dim>::dynamics(std::span<const BodyState<Dim>> before, std::span<const BodyState<Dim>> after,
                            std::span<const ContactImpulse<Dim>> contacts,
                            std::span<const JointImpulse<Dim>> joints, double h) const {
  constexpr int kAngular = Dimension<Dim>::angular;
  double worst = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Body<Dim>& body = scene_.bodies[i];
    if (body.fixed) continue;
    const Inertia<Dim> inertia = world_inertia(body.inertia, before[i].pose.rotation);
    const Angular<Dim> omega = before[i].velocity.template tail<kAngular>();
    Vector<Dim> linear =
        body.mass * (after[i].velocity.template head<Dim>() - before[i].velocity.template head<Dim>()) -
        h * (body.mass * scene_.gravity + body.force);
    Angular<Dim> angular = inertia * (after[i].velocity.template tail<kAngular>() - omega) -
                           h * gyroscopic_torque(omega, inertia);
    for (const auto& c : contacts) {
      const bool is_a = c.body_a == static_cast<int>(i);
      if (!is_a && c.body_b != static_cast<int>(i)) continue;
      const double sign = is_a ? 1 : -1;
      const Vector<Dim> impulse =
          c.normal_impulse * c.normal + c.tangents * c.friction_impulse.template head<Dim - 1>();
      const Vector<Dim> arm = (is_a ? c.point_a : c.point_b) - after[i].pose.position;
      linear -= sign * impulse;
      angular -= sign * (lever(arm).transpose() * impulse);
      if constexpr (Dim == 3) angular -= sign * c.friction_impulse[2] * c.normal;
    }
    for (const auto& j : joints) {
      const Joint<Dim>& joint = scene_.joints[static_cast<std::size_t>(j.joint)];
      for (const auto& [index, impulse] :
           {std::pair{joint.body_a, j.on_a}, std::pair{joint.body_b, j.on_b}}) {
        if (index != static_cast<int>(i)) continue;
        linear -= impulse.template head<Dim>();
        angular -= impulse.template tail<kAngular>();
      }
    }
    const double unit = body.mass * scale_.velocity;
    worst = worse(worst, linear.cwiseAbs().maxCoeff() / unit);
    worst = worse(worst, angular.cwiseAbs().maxCoeff() / (unit * gyration_radius(body)));
  }
  return worst;
}

/// Distance of the anchors across the directions that the joint blocks, over L, and turn away from the
/// initial relative orientation (of a hinge: of the axis) [rad].
template <int Dim>
double Judge<Dim>::joint(const Joint<Dim>& joint, std::span<const BodyState<Dim>> after) const {
  const auto a = static_cast<std::size_t>(joint.body_a);
  const auto b = static_cast<std::size_t>(joint.body_b);
  const Pose<Dim>& start_a = scene_.bodies[a].pose;
  const Pose<Dim>& start_b = scene_.bodies[b].pose;
  const Pose<Dim>& end_a = after[a].pose;
  const Pose<Dim>& end_b = after[b].pose;
  const auto turned = [](const Pose<Dim>& start, const Pose<Dim>& end, const Vector<Dim>& direction) {
    return Vector<Dim>(end.rotation.matrix() * (start.rotation.matrix().transpose() * direction));
  };
  Vector<Dim> gap =
      end_a.to_world(start_a.to_body(joint.anchor)) - end_b.to_world(start_b.to_body(joint.anchor));
  if (joint.type == JointType::slider) {
    const Vector<Dim> axis = turned(start_b, end_b, joint.axis);
    gap -= axis.dot(gap) * axis;
  }
  double turn = 0;
  if (joint.type == JointType::hinge && Dim == 3) {
    turn = (turned(start_a, end_a, joint.axis) - turned(start_b, end_b, joint.axis)).norm();
  } else if (joint.type == JointType::slider || joint.type == JointType::fixed) {
    for (int i = 0; i < Dim; ++i) {
      const Vector<Dim> axis = Vector<Dim>::Unit(i);
      turn = worse(turn, (turned(start_a, end_a, axis) - turned(start_b, end_b, axis)).norm());
    }
  }
  return worse(gap.norm() / scale_.length, turn);
}

/// |max_i f_i(point)|: 0 on the surface, to first order a distance [m].
template <int Dim>
double Judge<Dim>::distance_from_surface(int body, const BodyState<Dim>& state,
                                         const Vector<Dim>& point) const {
  const ConvexSurface<Dim>& surface = *surfaces_[static_cast<std::size_t>(body)];
  const Vector<Dim> x = state.pose.to_body(point);
  double value = surface.value(0, x);
  for (int i = 1; i < surface.count(); ++i) value = worse(value, surface.value(i, x));
  return std::abs(value);
}

template <int Dim>
double Judge<Dim>::contact(const ContactImpulse<Dim>& c, std::span<const BodyState<Dim>> after) const {
  const Vector<Dim> separation = c.point_a - c.point_b;
  double worst = (c.tangents.transpose() * separation).norm() / scale_.length;
  for (const auto& [body, point] : {std::pair{c.body_a, c.point_a}, std::pair{c.body_b, c.point_b}}) {
    worst = worse(worst,
                  distance_from_surface(body, after[static_cast<std::size_t>(body)], point) / scale_.length);
  }
  const double gap = c.normal.dot(separation) / scale_.length;
  return worse(worst, std::abs(std::min(c.normal_impulse / impulse_unit(c), gap)));
}

/// mu p_n w + y sigma = 0 and 0 <= sigma _|_ (mu p_n)^2 - |y|^2 >= 0 in y = E^-1 p_f, w = E v_f; sigma = |w|,
/// its value at any solution (below Eq. 5).
template <int Dim>
double Judge<Dim>::friction(const ContactImpulse<Dim>& c, std::span<const BodyState<Dim>> after) const {
  const BodyState<Dim>& a = after[static_cast<std::size_t>(c.body_a)];
  const BodyState<Dim>& b = after[static_cast<std::size_t>(c.body_b)];
  const ContactLaw<Dim>& law = scene_.law(c.body_a, c.body_b);
  const FrictionVector<Dim> e = law.semi_axes();
  const Vector<Dim> slip = point_velocity<Dim>(a.velocity, c.point_a - a.pose.position) -
                           point_velocity<Dim>(b.velocity, c.point_b - b.pose.position);
  FrictionVector<Dim> v;
  v.template head<Dim - 1>() = c.tangents.transpose() * slip;
  if constexpr (Dim == 3) v[2] = c.normal.dot((a.velocity - b.velocity).template tail<3>());
  const FrictionVector<Dim> w = e.cwiseProduct(v) / scale_.velocity;
  const double unit = impulse_unit(c);
  FrictionVector<Dim> y;
  double worst = 0;
  for (int i = 0; i < Dimension<Dim>::friction; ++i) {
    const bool carries = e[i] > 0;
    y[i] = carries ? c.friction_impulse[i] / (e[i] * unit) : 0;
    if (!carries) worst = worse(worst, std::abs(c.friction_impulse[i]) / unit);
  }
  const double limit = law.mu * c.normal_impulse / unit;
  const double sigma = w.norm();
  worst = worse(worst, (limit * w + sigma * y).cwiseAbs().maxCoeff());
  return worse(worst, std::abs(std::min(sigma, limit * limit - y.squaredNorm())));
}

template <int Dim>
StepResidual Judge<Dim>::step_residual(std::span<const BodyState<Dim>> before,
                                       std::span<const BodyState<Dim>> after,
                                       std::span<const ContactImpulse<Dim>> contacts, double h,
                                       std::span<const JointImpulse<Dim>> joints) const {
  StepResidual residual;
  residual.dynamics = dynamics(before, after, contacts, joints, h);
  for (const auto& j : scene_.joints) residual.joints = worse(residual.joints, joint(j, after));
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    const Pose<Dim> expected = advanced(before[i].pose, after[i].velocity, h);
    const double moved = (after[i].pose.position - expected.position).norm() / scale_.length;
    residual.kinematics = worse(residual.kinematics, moved);
    residual.kinematics = worse(residual.kinematics, turn_between(after[i].pose.rotation, expected.rotation));
  }
  residual.contact = largest_penetration(after) / scale_.length;
  for (const auto& c : contacts) {
    if (c.normal_impulse == 0 && c.friction_impulse.isZero(0)) continue;
    residual.contact = worse(residual.contact, contact(c, after));
    residual.friction = worse(residual.friction, friction(c, after));
  }
  return residual;
}

template class Judge<2>;
template class Judge<3>;

}  // namespace touchstone
