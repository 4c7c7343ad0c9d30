#include "experiments/harness/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/closest_points.h"
#include "core/stepper/box_tree.h"

namespace touchstone {

namespace {

/// max that does not lose a NaN.
double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

}  // namespace

double StepResidual::largest() const {
  return worse(worse(worse(dynamics, kinematics), worse(contact, friction)), joints);
}

template <int Dim>
Judge<Dim>::Judge(const Scene<Dim>& scene) : scene_(scene), checker_(scene) {
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
double Judge<Dim>::overlap(std::size_t i, std::size_t j, std::span<const BodyState<Dim>> state) const {
  if (scene_.bodies[i].fixed && scene_.bodies[j].fixed) return 0;
  if (scene_.jointed(static_cast<int>(i), static_cast<int>(j))) return 0;  // they do not collide
  const auto ball_i = surfaces_[i]->bounding_ball();
  const auto ball_j = surfaces_[j]->bounding_ball();
  const double apart = (state[i].pose.to_world(ball_i.center) - state[j].pose.to_world(ball_j.center)).norm();
  if (apart > ball_i.radius + ball_j.radius) return 0;
  return -closest_points(*surfaces_[i], state[i].pose, *surfaces_[j], state[j].pose).gap;
}

/// Bodies whose bounding balls are apart do not overlap: of bounded bodies only those whose boxes meet are
/// held against each other, which a tree finds in O(n log n). A body of no bounds, or nowhere, meets all.
template <int Dim>
double Judge<Dim>::largest_penetration(std::span<const BodyState<Dim>> state) const {
  constexpr double kRounding = 1e-9;  // of the box; far above that of the balls' distance
  std::vector<AlignedBox<Dim>> boxes;
  std::vector<std::size_t> bounded;
  std::vector<std::size_t> unbounded;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto ball = surfaces_[i]->bounding_ball();
    const Vector<Dim> center = state[i].pose.to_world(ball.center);
    if (!std::isfinite(ball.radius) || !center.allFinite()) {
      unbounded.push_back(i);
      continue;
    }
    const double extent = ball.radius + kRounding * (ball.radius + center.template lpNorm<Eigen::Infinity>());
    bounded.push_back(i);
    boxes.push_back({center.array() - extent, center.array() + extent});
  }
  double deepest = 0;
  for (std::size_t k = 0; k < unbounded.size(); ++k) {
    for (std::size_t other = k + 1; other < unbounded.size(); ++other)
      deepest = worse(deepest, overlap(unbounded[k], unbounded[other], state));
    for (const std::size_t j : bounded)
      deepest = worse(deepest, overlap(std::min(unbounded[k], j), std::max(unbounded[k], j), state));
  }
  if (boxes.empty()) return deepest;
  BoxTree<Dim> tree;
  tree.build(boxes);
  for (std::size_t k = 0; k < bounded.size(); ++k) {
    tree.for_each_overlapping(boxes[k], [&](int other) {
      const auto l = static_cast<std::size_t>(other);
      if (k < l) deepest = worse(deepest, overlap(bounded[k], bounded[l], state));
    });
  }
  return deepest;
}

template <int Dim>
StepResidual Judge<Dim>::step_residual(std::span<const BodyState<Dim>> before,
                                       std::span<const BodyState<Dim>> after,
                                       std::span<const ContactImpulse<Dim>> contacts, double h,
                                       std::span<const JointImpulse<Dim>> joints) const {
  using enum certificate::Condition;
  const certificate::Report report =
      checker_.check({before, after, contacts, joints, h}, certificate::Contacts::loaded);
  const auto worst_of = [&](std::initializer_list<certificate::Condition> conditions) {
    double worst = 0;
    for (const auto condition : conditions) worst = worse(worst, report.residual(condition));
    return worst;
  };
  StepResidual residual;
  residual.dynamics = worst_of({linear_momentum, angular_momentum});
  residual.kinematics = worst_of({position, orientation, unit_quaternion});
  residual.contact =
      worse(largest_penetration(after) / checker_.units().length,
            worst_of({frame, surface, opposite, normal, normal_impulse, gap, complementarity}));
  residual.friction = worst_of({friction_cone, dissipation, slip_outside});
  residual.joints = report.residual(joint);
  if (!(report.residual(finite) == 0)) residual.kinematics = std::numeric_limits<double>::quiet_NaN();
  return residual;
}

template class Judge<2>;
template class Judge<3>;

}  // namespace touchstone
