#include "experiments/scenarios/truths/sphere_on_spheres.h"

#include <algorithm>
#include <cmath>

#include "experiments/scenarios/truths/ball_contact.h"
#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/require.h"

namespace touchstone::truth {
namespace {

using ball::Contact;
using ball::Dynamics;
using ball::Motion;
using ball::Surface;

/// x, v, slip (v_c, omega.n) of the reference contact, quaternion (x, y, z, w as
/// Eigen stores it). The slip stands for omega = n x (v - v_c) / radius + n
/// (omega.n), because slip that grows from zero must keep its relative accuracy.
constexpr int size = 14;
using State = OdeVector<size>;
enum { x_at = 0, v_at = 3, slip_at = 6, q_at = 10 };

constexpr std::size_t events_per_contact = 2;
using Margins = std::array<double, 2 * events_per_contact>;

/// w below which a sliding contact counts as having come to rest; it passes this value once while slip grows.
constexpr double no_slip = 1e-12;
/// Gap above which a contact has opened, and at which it closes again: more than rounding.
constexpr double open_gap = 1e-12;            // [m]
constexpr double ordinary_first_step = 0.01;  // [s]

class Simulation {
 public:
  Simulation(const SphereOnSpheres& scene, const std::vector<double>& times, double tolerance)
      : scene_(scene), times_(times), tolerance_(tolerance) {
    state_.setZero();
    state_.segment<3>(x_at) = scene.position;
    state_[size - 1] = 1.0;
  }

  SphereOnSpheresResult run() {
    if (!begin()) return std::move(result_);
    while (next_sample_ < times_.size() && result_.status == SphereOnSpheresStatus::completed)
      integrate_phase();
    result_.end = t_;
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool begin() {
    const bool found = ball::start_states(scene_, geometry(state_).contacts, contacts_);
    result_.start_modes = {contacts_[0].mode, contacts_[1].mode};
    const bool both_stick =
        contacts_[0].mode == BallContactMode::sticking && contacts_[1].mode == BallContactMode::sticking;
    if (!found || both_stick) result_.status = SphereOnSpheresStatus::no_start;
    return found && !both_stick;
  }

  struct Geometry {
    Motion motion;
    std::array<Contact, 2> contacts;
  };

  [[nodiscard]] Geometry geometry(const State& s) const {
    const Eigen::Vector3d x = s.segment<3>(x_at);
    const Eigen::Vector3d v = s.segment<3>(v_at);
    const Eigen::Vector3d n = (x - scene_.supports[reference_].center).normalized();
    const Eigen::Vector3d omega = n.cross(v - s.segment<3>(slip_at)) / scene_.radius + n * s[slip_at + 3];
    Geometry g{{x, v, omega}, ball::contacts_of(scene_, {x, v, omega})};
    g.contacts[reference_].set_slip(s.segment<4>(slip_at));
    return g;
  }

  [[nodiscard]] State rate(const State& s, const ball::ContactStates& contacts) const {
    const Geometry g = geometry(s);
    const ball::Twist twist_rate = ball::dynamics(scene_, g.contacts, contacts).rate;
    const Contact& reference = g.contacts[reference_];
    const Eigen::Vector3d& omega = g.motion.omega;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(0.0, omega.x(), omega.y(), omega.z()) * Eigen::Quaterniond(s.segment<4>(q_at));
    State result;
    result << g.motion.v, twist_rate.head<3>(), reference.jacobian * twist_rate + reference.drift,
        0.5 * turn.coeffs();
    // A sticking contact's slip is zero by construction; rounding must not accumulate in it.
    if (contacts[reference_].mode == BallContactMode::sticking) result.segment<4>(slip_at).setZero();
    return result;
  }

  /// Two margins a contact, each of which falls through zero when the mode ends: sticking: the
  /// friction limit, (unused); sliding: the normal force, the slip; apart: the gap, (unused).
  [[nodiscard]] Margins margins(const State& s) const {
    const std::array<Contact, 2> contacts = geometry(s).contacts;
    const Dynamics d = ball::dynamics(scene_, contacts, contacts_);
    Margins result;
    result.fill(1.0);
    for (std::size_t i = 0; i < 2; ++i) {
      const double normal = contacts[i].normal.dot(d.force[i].head<3>());
      double& first = result[events_per_contact * i];
      switch (contacts_[i].mode) {
        case BallContactMode::sticking:
          first = scene_.mu * normal - contacts[i].scaled_force(d.force[i]).norm();
          break;
        case BallContactMode::sliding:
          first = normal;
          result[events_per_contact * i + 1] = contacts[i].scaled_velocity(contacts[i].slip).norm() - no_slip;
          break;
        case BallContactMode::apart:
          first = contacts[i].gap - open_gap;
          break;
      }
    }
    return result;
  }

  void integrate_phase() {
    std::array<bool, 2 * events_per_contact> armed{};
    for (std::size_t i = 0; i < 2; ++i)
      armed[events_per_contact * i] = contacts_[i].mode != BallContactMode::apart;
    const auto field = [this](double, const State& s) { return rate(s, contacts_); };
    const auto events = [this](double, const State& s) { return margins(s); };
    const auto observer = [this](const DenseStep<size>& step, double end) { sample_until(step, end); };
    const OdeOptions options{.tolerance = tolerance_, .first_step = first_step_};
    const double end = std::max(times_.back(), std::numeric_limits<double>::min());
    const auto at = integrate<size, 4>(field, t_, state_, end, events, armed, observer, options);
    t_ = at.t;
    state_ = at.y;
    first_step_ = ordinary_first_step;
    if (at.status == OdeStatus::reached_end) {
      next_sample_ = times_.size();
    } else if (at.status == OdeStatus::event) {
      change_mode(at.event / events_per_contact, at.event % events_per_contact == 0);
    } else {
      result_.status = SphereOnSpheresStatus::integration_failed;
    }
  }

  /// Slip of a contact that has been sticking grows like t^2, and its direction, on which friction
  /// depends, is 0/0 at the start. Nearby solutions are drawn to the true one at the rate 1/t^2, so that
  /// a start at t = epsilon with a direction that is right to O(epsilon^2) is enough: until then the
  /// direction is prescribed as d(0) + (d(epsilon) - d(0)) t / epsilon, d being the one in which slip
  /// grows from zero at that state. What is left is an error of slip of O(epsilon^3) = 1e-15.
  void begin_slip(std::size_t i) {
    constexpr double epsilon = 1e-5;
    refer_slip_to(i);
    ball::ContactStates prescribed = contacts_;
    prescribed[i].prescribed = true;
    const auto direction_at = [&](const State& s) {
      return ball::growing_slip_direction(scene_, geometry(s).contacts, contacts_, i);
    };
    const Surface first = direction_at(state_);
    Surface change = Surface::Zero();
    const auto field = [&](double t, const State& s) {
      prescribed[i].direction = (first + change * ((t - t_) / epsilon)).normalized();
      return rate(s, prescribed);
    };
    const auto no_event = [](double, const State&) { return std::array<double, 0>{}; };
    State later = state_;
    constexpr int passes = 3;
    for (int pass = 0; pass < passes; ++pass) {
      const auto observer = [&](const DenseStep<size>& step, double end) {
        if (pass + 1 == passes) sample_until(step, end);
      };
      later = integrate<size, 0>(field, t_, state_, t_ + epsilon, no_event, {}, observer).y;
      change = direction_at(later) - first;
    }
    const Contact contact = geometry(later).contacts[i];
    const double sigma = contact.scaled_velocity(contact.slip).norm();
    contacts_[i].direction = (first + change).normalized();
    later.segment<4>(slip_at) = contact.scaled_force(sigma * contacts_[i].direction);  // E^-1 (sigma d)
    state_ = later;
    t_ += epsilon;
    first_step_ = 0.3 * epsilon;
  }

  /// Makes contact i, whose slip is zero, the one whose slip is a state.
  void refer_slip_to(std::size_t i) {
    reference_ = i;
    state_.segment<4>(slip_at).setZero();
  }

  void sample_until(const DenseStep<size>& step, double end) {
    for (; next_sample_ < times_.size() && times_[next_sample_] <= end; ++next_sample_) {
      result_.samples.push_back(sample(times_[next_sample_], step(times_[next_sample_])));
    }
  }

  void change_mode(std::size_t i, bool first_margin) {
    const int contact = static_cast<int>(i);
    switch (contacts_[i].mode) {
      case BallContactMode::sticking: {
        const std::array<Contact, 2> contacts = geometry(state_).contacts;
        const Surface y = contacts[i].scaled_force(ball::dynamics(scene_, contacts, contacts_).force[i]);
        contacts_[i] = {BallContactMode::sliding, Surface(-y.normalized()), false};
        result_.events.push_back({t_, contact, BallEventKind::slip_begins});
        begin_slip(i);
        break;
      }
      case BallContactMode::sliding:
        if (!first_margin) {
          result_.status = SphereOnSpheresStatus::slip_ends;
          break;
        }
        contacts_[i].mode = BallContactMode::apart;
        result_.events.push_back({t_, contact, BallEventKind::separates});
        break;
      case BallContactMode::apart:
        result_.status = SphereOnSpheresStatus::touches_again;
        break;
    }
  }

  [[nodiscard]] SphereOnSpheresSample sample(double t, const State& s) const {
    const auto& [motion, contacts] = geometry(s);
    const Dynamics d = ball::dynamics(scene_, contacts, contacts_);
    SphereOnSpheresSample result{
        t, motion.x, motion.v, motion.omega, Eigen::Quaterniond(s.segment<4>(q_at)).normalized(), {}};
    for (std::size_t i = 0; i < 2; ++i) {
      BallContactSample& c = result.contacts[i];
      const Eigen::Vector3d force = d.force[i].head<3>();
      c.mode = contacts_[i].mode;
      c.gap = contacts[i].gap;
      c.normal = contacts[i].normal.dot(force);
      c.friction = force - c.normal * contacts[i].normal;
      c.torsion = d.force[i][3];
      c.slip = contacts[i].slip.head<3>();
      c.spin = contacts[i].slip[3];
      c.friction_norm = contacts[i].scaled_force(d.force[i]).norm();
      c.sigma = contacts[i].scaled_velocity(contacts[i].slip).norm();
    }
    return result;
  }

  const SphereOnSpheres& scene_;
  const std::vector<double>& times_;
  double tolerance_;
  SphereOnSpheresResult result_;
  ball::ContactStates contacts_;
  std::size_t reference_ = 1;  ///< the contact whose slip is a state
  double t_ = 0.0;
  double first_step_ = ordinary_first_step;
  State state_;
  std::size_t next_sample_ = 0;
};

void validate(const SphereOnSpheres& scene) {
  require(scene.mass > 0.0, "mass", scene.mass, "> 0");
  require(scene.inertia > 0.0, "inertia", scene.inertia, "> 0");
  require(scene.radius > 0.0, "radius", scene.radius, "> 0");
  require(scene.mu > 0.0, "mu", scene.mu, "> 0");
  require(scene.e_slip > 0.0, "e_slip", scene.e_slip, "> 0");
  require(scene.e_r > 0.0, "e_r", scene.e_r, "> 0");
  for (const FixedBall& support : scene.supports) {
    require(support.radius > 0.0, "support radius", support.radius, "> 0");
    const double gap = (scene.position - support.center).norm() - support.radius - scene.radius;
    require(std::abs(gap) <= 1e-9, "gap at the start", gap, "0 to 1e-9 m");
  }
}

}  // namespace

SphereOnSpheresResult roll_on_spheres(const SphereOnSpheres& scene, const std::vector<double>& times,
                                      double tolerance) {
  validate(scene);
  require(!times.empty(), "times must be given");
  require_increasing(times);
  return Simulation(scene, times, tolerance).run();
}

}  // namespace touchstone::truth
