#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/certificate/body_conditions.h"
#include "core/certificate/certificate.h"
#include "core/certificate/separation.h"

namespace touchstone::certificate {

namespace {

/// |N - sum l_i g_i| at the best l >= 0 with at most Dim of them positive (Caratheodory), by trying every
/// choice: bodies have few faces at one point.
template <int Dim>
double cone_distance(const std::vector<Vector<Dim>>& gradients, const Vector<Dim>& normal) {
  double best = normal.norm();
  std::array<std::size_t, Dim> chosen{};
  const auto attempt = [&](int size) {
    Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim> g(Dim, size);
    for (int k = 0; k < size; ++k) g.col(k) = gradients[chosen[static_cast<std::size_t>(k)]];
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1> l = g.colPivHouseholderQr().solve(normal);
    if (l.minCoeff() >= 0) best = std::min(best, (normal - g * l).norm());
  };
  const auto choose = [&](const auto& self, int size, std::size_t from) -> void {
    if (size > 0) attempt(size);
    if (size == Dim) return;
    for (std::size_t i = from; i < gradients.size(); ++i) {
      chosen[static_cast<std::size_t>(size)] = i;
      self(self, size + 1, i + 1);
    }
  };
  choose(choose, 0, 0);
  return best;
}

constexpr double kSpacing = std::numeric_limits<double>::epsilon();

/// By how much a point of a body, relative to its centre, is uncertain because both are told in rounded world
/// coordinates: half a spacing of the numbers for each [m].
template <int Dim>
double arm_rounding(const Vector<Dim>& point, const Vector<Dim>& center) {
  return std::sqrt(Dim) * kSpacing *
         std::max(point.template lpNorm<Eigen::Infinity>(), center.template lpNorm<Eigen::Infinity>());
}

}  // namespace

/// Unit of impulse at a contact: the lighter moving body's mass times V.
template <int Dim>
double Checker<Dim>::impulse_unit(const ContactImpulse<Dim>& c) const {
  double mass = std::numeric_limits<double>::infinity();
  for (const int index : {c.body_a, c.body_b}) {
    const Body<Dim>& body = scene_.bodies[static_cast<std::size_t>(index)];
    if (!body.fixed) mass = std::min(mass, body.mass);
  }
  return mass * units_.velocity;
}

template <int Dim>
void Checker<Dim>::check_contact(std::size_t i, const Step<Dim>& step, Report& report) const {
  const ContactImpulse<Dim>& c = step.contacts[i];
  check_frame(i, c, report);
  check_points(i, c, step.after, report);
  check_multipliers(i, step, report);
  check_gap(i, c, report);
  check_friction(i, c, step.after, report);
}

template <int Dim>
void Checker<Dim>::check_frame(std::size_t i, const ContactImpulse<Dim>& c, Report& report) const {
  const int subject = static_cast<int>(i);
  Matrix<Dim> frame;
  frame << c.normal, c.tangents;
  report.note(Condition::frame, (frame.transpose() * frame - Matrix<Dim>::Identity()).norm(), subject);
  if constexpr (Dim == 3) {
    constexpr double kLeastSine = 0.2;  // a direction closer to n than this may be replaced by another
    const ContactLaw<3>& law = scene_.law(c.body_a, c.body_b);
    const Vector<3> direction = law.tangent.normalized();
    const Vector<3> across = direction - c.normal.dot(direction) * c.normal;
    if (law.e_t == law.e_o || across.norm() < kLeastSine) return;
    report.note(Condition::frame, (across.normalized() - c.tangents.col(0)).norm(), subject);
  }
}

template <int Dim>
void Checker<Dim>::check_points(std::size_t i, const ContactImpulse<Dim>& c, State after,
                                Report& report) const {
  const int subject = static_cast<int>(i);
  const Vector<Dim> separation = c.point_a - c.point_b;
  const double off = (separation - c.normal.dot(separation) * c.normal).norm();
  report.note(Condition::opposite, off / units_.length, subject);
  for (const auto& [body, point, outward] :
       {std::tuple(c.body_a, c.point_a, Vector<Dim>(-c.normal)), std::tuple(c.body_b, c.point_b, c.normal)}) {
    const BodyState<Dim>& state = after[static_cast<std::size_t>(body)];
    const ConvexSurface<Dim>& surface = *surfaces_[static_cast<std::size_t>(body)];
    const Vector<Dim> x = state.pose.to_body(point);
    double value = surface.value(0, x);
    for (int k = 1; k < surface.count(); ++k) value = std::max(value, surface.value(k, x));
    report.note(Condition::surface, std::abs(value) / units_.length, subject);
    report.note(Condition::normal, normal_missed(body, state, point, outward), subject);
  }
}

/// The multipliers are found here: over a widening band below the surface, the larger of the band used and of
/// the distance of the normal from the cone of the gradients in it.
template <int Dim>
Missed Checker<Dim>::normal_missed(int body, const BodyState<Dim>& state, const Vector<Dim>& point,
                                   const Vector<Dim>& outward) const {
  constexpr double kFirstBand = 1e-13;  // over L
  constexpr double kLastBand = 1e-2;
  constexpr std::size_t kMost = 16;  // gradients; the nearest ones
  const ConvexSurface<Dim>& surface = *surfaces_[static_cast<std::size_t>(body)];
  const Vector<Dim> x = state.pose.to_body(point);
  const Vector<Dim> normal = state.pose.rotation.matrix().transpose() * outward;
  const double uncertain = arm_rounding<Dim>(point, state.pose.position);
  const auto turn = [&](const SurfaceJet<Dim>& jet) {
    return jet.hessian.norm() / jet.gradient.norm() * uncertain;
  };
  if (surface.count() == 1) {
    const SurfaceJet<Dim> jet = surface.jet(0, x);
    return {(jet.gradient.normalized() - normal).norm(), turn(jet)};
  }
  double best = std::numeric_limits<double>::infinity();
  double best_beyond = best;
  std::vector<Vector<Dim>> gradients;
  double top = surface.value(0, x);
  for (int k = 1; k < surface.count(); ++k) top = std::max(top, surface.value(k, x));
  for (double band = kFirstBand; band <= kLastBand && band < best; band *= 10) {
    gradients.clear();
    double largest_turn = 0;
    for (int k = 0; k < surface.count() && gradients.size() < kMost; ++k) {
      if (!(surface.value(k, x) >= top - band * units_.length)) continue;
      const SurfaceJet<Dim> jet = surface.jet(k, x);
      gradients.push_back(jet.gradient);
      largest_turn = std::max(largest_turn, turn(jet));
    }
    const double inexact = band > kFirstBand ? band : 0.0;
    const Missed missed(cone_distance(gradients, normal), largest_turn);
    best = std::min(best, std::max(inexact, missed.residual));
    best_beyond = std::min(best_beyond, std::max(inexact, missed.beyond()));
  }
  return {best, best - best_beyond};
}

/// The multipliers that the answer tells: nonnegative, of active inequalities alone, making up the normal.
template <int Dim>
void Checker<Dim>::check_multipliers(std::size_t i, const Step<Dim>& step, Report& report) const {
  if (step.multipliers.empty()) return;
  const ContactImpulse<Dim>& c = step.contacts[i];
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const std::vector<double>& l = step.multipliers[i][side];
    if (l.empty()) continue;
    const auto body = static_cast<std::size_t>(side == 0 ? c.body_a : c.body_b);
    const Pose<Dim>& pose = step.after[body].pose;
    const Vector<Dim> x = pose.to_body(side == 0 ? c.point_a : c.point_b);
    Vector<Dim> normal = Vector<Dim>::Zero();
    double turn = 0;
    for (int k = 0; k < surfaces_[body]->count(); ++k) {
      const SurfaceJet<Dim> jet = surfaces_[body]->jet(k, x);
      const double multiplier = l.at(static_cast<std::size_t>(k));
      normal += multiplier * jet.gradient;
      turn += std::abs(multiplier) * jet.hessian.norm();
      const double missed = std::abs(std::min(multiplier, -jet.value / units_.length));
      report.note(Condition::multipliers, missed, static_cast<int>(i));
    }
    const Vector<Dim> outward = side == 0 ? Vector<Dim>(-c.normal) : c.normal;
    const double uncertain = turn * arm_rounding<Dim>(side == 0 ? c.point_a : c.point_b, pose.position);
    report.note(Condition::multipliers, {(pose.rotation.matrix() * normal - outward).norm(), uncertain},
                static_cast<int>(i));
  }
}

template <int Dim>
void Checker<Dim>::check_gap(std::size_t i, const ContactImpulse<Dim>& c, Report& report) const {
  const int subject = static_cast<int>(i);
  const double p = c.normal_impulse / impulse_unit(c);
  const double psi = c.normal.dot(c.point_a - c.point_b) / units_.length;
  report.note(Condition::normal_impulse, -p, subject);
  report.note(Condition::gap, -psi, subject);
  report.note(Condition::complementarity, std::min(p, psi), subject);
}

/// Eqs. 5 and 11 with sigma = |w|, its value at any solution.
template <int Dim>
void Checker<Dim>::check_friction(std::size_t i, const ContactImpulse<Dim>& c, State after,
                                  Report& report) const {
  const int subject = static_cast<int>(i);
  const BodyState<Dim>& a = after[static_cast<std::size_t>(c.body_a)];
  const BodyState<Dim>& b = after[static_cast<std::size_t>(c.body_b)];
  const ContactLaw<Dim>& law = scene_.law(c.body_a, c.body_b);
  const FrictionVector<Dim> e = law.semi_axes();
  const auto velocity_of = [](const BodyState<Dim>& body, const Vector<Dim>& point) {
    return Vector<Dim>(body.velocity.template head<Dim>() + turning(omega(body), point - body.pose.position));
  };
  FrictionVector<Dim> v;
  v.template head<Dim - 1>() =
      c.tangents.transpose() * (velocity_of(a, c.point_a) - velocity_of(b, c.point_b));
  if constexpr (Dim == 3) v[2] = c.normal.dot(omega(a) - omega(b));
  const FrictionVector<Dim> w = e.cwiseProduct(v) / units_.velocity;
  const double unit = impulse_unit(c);
  FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
  for (int k = 0; k < Dimension<Dim>::friction; ++k) {
    if (e[k] > 0) {
      y[k] = c.friction_impulse[k] / (e[k] * unit);
    } else {
      report.note(Condition::friction_cone, std::abs(c.friction_impulse[k]) / unit, subject);
    }
  }
  const double limit = law.mu * c.normal_impulse / unit;
  const double sigma = w.norm();
  report.note(Condition::friction_cone, y.norm() - std::max(limit, 0.0), subject);
  double uncertain = 0;  // of v
  for (const auto& [body, point] : {std::tuple(&a, c.point_a), std::tuple(&b, c.point_b)}) {
    const double speed = body->velocity.template head<Dim>().norm();
    const double turning = omega(*body).norm();
    uncertain += turning * arm_rounding<Dim>(point, body->pose.position) +
                 kSpacing * (speed + turning * (point - body->pose.position).norm());
  }
  const double by_slip = (std::abs(limit) + y.norm()) * e.maxCoeff() * uncertain / units_.velocity;
  report.note(Condition::dissipation, {(limit * w + sigma * y).cwiseAbs().maxCoeff(), by_slip}, subject);
  // Not the difference of squares as printed, which has the same zeros but hides slip under small loads.
  report.note(Condition::slip_outside, std::min(sigma, limit - y.norm()), subject);
}

/// Pairs with a contact are apart by its gap, which the conditions of closest points prove to be the
/// distance; for the others a plane between them is looked for.
template <int Dim>
void Checker<Dim>::check_separation(const Step<Dim>& step, Report& report) const {
  const auto has_contact = [&](int i, int j) {
    return std::any_of(step.contacts.begin(), step.contacts.end(), [&](const auto& c) {
      return (c.body_a == i && c.body_b == j) || (c.body_a == j && c.body_b == i);
    });
  };
  const int count = static_cast<int>(scene_.bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const auto a = static_cast<std::size_t>(i);
      const auto b = static_cast<std::size_t>(j);
      if ((scene_.bodies[a].fixed && scene_.bodies[b].fixed) || scene_.jointed(i, j) || has_contact(i, j))
        continue;
      const double overlap =
          -separation(*surfaces_[a], step.after[a].pose, *surfaces_[b], step.after[b].pose);
      report.note(Condition::separation, overlap / units_.length, i, j);
    }
  }
}

template class Checker<2>;
template class Checker<3>;

}  // namespace touchstone::certificate
