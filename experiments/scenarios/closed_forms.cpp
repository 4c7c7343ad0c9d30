#include "experiments/scenarios/closed_forms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "experiments/scenarios/truths/gauss_legendre.h"
#include "experiments/scenarios/truths/rolling_and_sliding.h"
#include "experiments/scenarios/truths/spin_and_slide.h"
#include "experiments/scenarios/truths/swings_and_bounces.h"

namespace touchstone {

namespace {

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kRadius = 1.0;    // [m] of the round body, of 1 kg

/// I / (m r^2): a disc, a solid ball.
template <int Dim>
constexpr double kShapeFactor = Dim == 2 ? truth::solid_disc : truth::solid_ball;

/// A plane through the origin, tilted by theta, and the direction of steepest descent (theta = 0: the
/// direction of motion).
template <int Dim>
struct Plane {
  Vector<Dim> normal;
  Vector<Dim> along;
  Angular<Dim> rolling;   ///< angular velocity of rolling along `along` at 1 m/s with a radius of 1 m
  Rotation<Dim> upright;  ///< of a body whose last axis is the normal
};

template <int Dim>
Plane<Dim> plane(double theta) {
  const double s = std::sin(theta);
  const double c = std::cos(theta);
  if constexpr (Dim == 2) {
    return {{s, c}, {c, -s}, Angular<2>(-1.0), PlanarRotation(-theta)};
  } else {
    const Vector<3> heading(std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6), 0);
    const Vector<3> up(0, 0, 1);
    const Vector<3> normal = c * up + s * heading;
    const Vector<3> along = c * heading - s * up;
    return {normal, along, normal.cross(along), SpatialRotation(exp_rotation(theta * up.cross(heading)))};
  }
}

/// The body on, or above, the plane `theta`.
template <int Dim>
ClosedFormScenario<Dim> scenario(std::string key, double theta, double mu, double restitution = 0.0) {
  ClosedFormScenario<Dim> made;
  made.key = std::move(key);
  made.scene.gravity = -kGravity * Vector<Dim>::Unit(Dim - 1);
  made.scene.contact_law.mu = mu;
  made.scene.contact_law.restitution = restitution;
  Body<Dim> body;
  body.name = "body";
  body.inertia = kShapeFactor<Dim> * kRadius * kRadius * Inertia<Dim>::Identity();
  body.shape.geometry = Sphere<Dim>{kRadius};
  Body<Dim> ground;
  ground.name = "ground";
  ground.fixed = true;
  HalfSpace<Dim> half_space;
  half_space.normal = plane<Dim>(theta).normal;
  ground.shape.geometry = half_space;
  made.scene.bodies = {body, ground};
  return made;
}

/// Gives body 0 the state at t = 0.
template <int Dim>
ClosedFormScenario<Dim> started(ClosedFormScenario<Dim> made) {
  const BodyState<Dim> start = made.body_at(0.0);
  made.scene.bodies[0].pose = start.pose;
  made.scene.bodies[0].velocity = start.velocity;
  made.scene.validate();
  return made;
}

template <int Dim>
Twist<Dim> twist(const Vector<Dim>& linear, const Angular<Dim>& angular) {
  Twist<Dim> nu;
  nu << linear, angular;
  return nu;
}

// --- flight and impact

template <int Dim>
ClosedFormScenario<Dim> free_fall() {
  auto made = scenario<Dim>("free_fall", 0.0, 0.5);
  const Plane<Dim> ground = plane<Dim>(0.0);
  const Vector<Dim> gravity = made.scene.gravity;
  const Vector<Dim> from = 10.0 * ground.normal;
  const Vector<Dim> thrown = 3.0 * ground.along + 2.0 * ground.normal;
  Angular<Dim> spin = 2.0 * ground.rolling;
  if constexpr (Dim == 3) spin = Vector<3>(1.0, -2.0, 1.5);
  made.body_at = [=](double t) {
    BodyState<Dim> state;
    state.pose.position = from + t * thrown + 0.5 * t * t * gravity;
    state.pose.rotation = Rotation<Dim>{}.turned(t * spin);
    state.velocity = twist<Dim>(thrown + t * gravity, spin);
    return state;
  };
  made.length = (thrown + 0.5 * gravity).norm();
  made.angle = spin.norm();
  made.speed = (thrown + gravity).norm();
  return started(std::move(made));
}

/// Velocity away from the ground at t, between impacts [m/s].
double bounce_speed(const truth::BouncingBall& ball, double t) {
  if (t >= ball.rest_time()) return 0.0;
  if (t < ball.first_impact()) return -ball.gravity * t;
  int impacts = 1;
  while (ball.impact_time(impacts + 1) <= t) ++impacts;
  const double leaves = std::pow(ball.restitution, impacts) * ball.gravity * ball.first_impact();
  return leaves - ball.gravity * (t - ball.impact_time(impacts));
}

/// Dropped from a gap of 1 m without spin.
template <int Dim>
ClosedFormScenario<Dim> dropped(const std::string& key, double restitution) {
  auto made = scenario<Dim>(key, 0.0, 0.5, restitution);
  const truth::BouncingBall ball{1.0, restitution, kGravity};
  const Plane<Dim> ground = plane<Dim>(0.0);
  made.body_at = [=](double t) {
    BodyState<Dim> state;
    state.pose.position = (kRadius + ball.gap(t)) * ground.normal;
    state.velocity.template head<Dim>() = bounce_speed(ball, t) * ground.normal;
    return state;
  };
  made.length = ball.height;
  made.speed = std::sqrt(2.0 * kGravity * ball.height);
  return started(std::move(made));
}

// --- a round body on a plane

/// `motion(t)` is how far along the plane, how fast, by how much turned and how fast turning, as if rolling.
template <int Dim>
void set_round_motion(ClosedFormScenario<Dim>& made, double theta,
                      std::function<std::array<double, 4>(double t)> motion) {
  const Plane<Dim> ground = plane<Dim>(theta);
  made.body_at = [ground, motion](double t) {
    const auto [distance, speed, turn, spin] = motion(t);
    BodyState<Dim> state;
    state.pose.position = kRadius * ground.normal + distance * ground.along;
    state.pose.rotation = Rotation<Dim>{}.turned(turn * ground.rolling);
    state.velocity = twist<Dim>(speed * ground.along, spin * ground.rolling);
    return state;
  };
}

/// Thrown along the plane with `speed` [m/s] and `spin` [rad/s].
template <int Dim>
ClosedFormScenario<Dim> thrown_flat(const std::string& key, double speed, double spin, double mu) {
  auto made = scenario<Dim>(key, 0.0, mu);
  const truth::SlidingRoller roller{kShapeFactor<Dim>, kRadius, mu, kGravity, speed, spin};
  set_round_motion<Dim>(made, 0.0, [roller](double t) -> std::array<double, 4> {
    const truth::RollerState state = truth::roller_at(roller, t);
    // Friction turns the body by b r spin' = -v', so b r turn + x = (b r spin0 + v0) t while it slides; after
    // that both grow as the rolling speed says.
    const double sliding = std::min(t, roller.rolls_from());
    const double reached = truth::roller_at(roller, sliding).position;
    const double b = roller.shape_factor;
    const double turned =
        ((b * roller.radius * roller.spin + roller.speed) * sliding - reached) / (b * roller.radius);
    return {state.position, state.speed, turned + state.spin * (t - sliding), state.spin};
  });
  made.length = std::abs(speed);
  made.angle = std::max(std::abs(speed), std::abs(spin)) / kRadius;
  made.speed = std::max(std::abs(speed), std::abs(spin) * kRadius);
  return started(std::move(made));
}

template <int Dim>
ClosedFormScenario<Dim> down_incline(const std::string& key, double theta, double mu) {
  auto made = scenario<Dim>(key, theta, mu);
  const truth::InclineRolling incline{kShapeFactor<Dim>, mu, kGravity, theta};
  const double a = incline.acceleration();
  const double alpha = incline.surface_acceleration() / kRadius;
  set_round_motion<Dim>(made, theta, [a, alpha](double t) -> std::array<double, 4> {
    return {0.5 * a * t * t, a * t, 0.5 * alpha * t * t, alpha * t};
  });
  made.length = 0.5 * a;
  made.angle = 0.5 * alpha;
  made.speed = a;
  return started(std::move(made));
}

/// Slips and spins at once; the orientation has no closed form.
ClosedFormScenario<3> spin_and_slide() {
  constexpr double kMu = 0.2;
  constexpr double kTorsion = 0.3;  // e_r [m]
  auto made = scenario<3>("spin_and_slide", 0.0, kMu);
  made.scene.contact_law.e_r = kTorsion;
  truth::SpinAndSlide motion;
  motion.shape_factor = kShapeFactor<3>;
  motion.spin_inertia = kShapeFactor<3>;
  motion.friction = kMu;
  motion.e_r = kTorsion;
  motion.gravity = kGravity;
  const Plane<3> ground = plane<3>(0.0);
  made.body_at = [motion, ground](double t) {
    // Of the change of slip the centre has its share, and the spin about the horizontal axis the rest.
    const double share = 1.0 / (1.0 + 1.0 / motion.shape_factor);
    const auto speed_at = [&](double time) {
      return motion.slip - share * (motion.slip - motion.at(time).slip);
    };
    const double sliding = std::min(t, motion.end_time());
    constexpr int kPanels = 16;
    const double distance = (sliding > 0 ? truth::quadrature(speed_at, 0.0, sliding, kPanels) : 0.0) +
                            speed_at(t) * (t - sliding);
    const auto now = motion.at(t);
    const double rolling = (speed_at(t) - now.slip) / kRadius;
    BodyState<3> state;
    state.pose.position = kRadius * ground.normal + distance * ground.along;
    state.velocity =
        twist<3>(speed_at(t) * ground.along, rolling * ground.rolling + now.spin * ground.normal);
    return state;
  };
  made.has_orientation = false;
  return started(std::move(made));
}

// --- a block on a plane

/// A flat block of 1 m by 0.5 m that moves along the plane by `distance(t)` at `speed(t)` and does not turn.
template <int Dim>
ClosedFormScenario<Dim> block(const std::string& key, double theta, double mu,
                              std::function<double(double)> distance, std::function<double(double)> speed) {
  auto made = scenario<Dim>(key, theta, mu);
  constexpr double kHalfBase = 0.5;
  constexpr double kHalfHeight = 0.25;
  Vector<Dim> half = Vector<Dim>::Constant(kHalfBase);
  half[Dim - 1] = kHalfHeight;
  Body<Dim>& body = made.scene.bodies[0];
  body.shape.geometry = Box<Dim>{half};
  if constexpr (Dim == 2) {
    body.inertia = Inertia<2>(half.squaredNorm() / 3.0);
  } else {
    const Vector<3> squares = half.cwiseAbs2();
    body.inertia = (squares.sum() - squares.array()).matrix().asDiagonal();
    body.inertia /= 3.0;
  }
  const Plane<Dim> ground = plane<Dim>(theta);
  made.body_at = [=](double t) {
    BodyState<Dim> state;
    state.pose.position = kHalfHeight * ground.normal + distance(t) * ground.along;
    state.pose.rotation = ground.upright;
    state.velocity.template head<Dim>() = speed(t) * ground.along;
    return state;
  };
  return made;
}

/// Thrown flat at 2 m/s; stops after v0^2 / (2 mu g).
template <int Dim>
ClosedFormScenario<Dim> block_slide() {
  constexpr double kSpeed = 2.0;
  constexpr double kMu = 0.3;
  const auto speed = [](double t) { return std::max(0.0, kSpeed - kMu * kGravity * t); };
  const auto distance = [](double t) {
    const double sliding = std::min(t, truth::stopping_time(kSpeed, kMu, kGravity));
    return (kSpeed - 0.5 * kMu * kGravity * sliding) * sliding;
  };
  auto made = block<Dim>("block_slide", 0.0, kMu, distance, speed);
  made.length = truth::stopping_distance(kSpeed, kMu, kGravity);
  made.speed = kSpeed;
  return started(std::move(made));
}

/// At rest at 9/10 of the slope that it would slide on. Sizes are those of a slide without friction.
template <int Dim>
ClosedFormScenario<Dim> block_rest() {
  constexpr double kMu = 0.5;
  const double theta = std::atan(0.9 * kMu);
  const auto zero = [](double) { return 0.0; };
  auto made = block<Dim>("block_rest", theta, kMu, zero, zero);
  made.length = 0.5 * kGravity * std::sin(theta);
  made.speed = kGravity * std::sin(theta);
  return started(std::move(made));
}

}  // namespace

template <int Dim>
std::vector<ClosedFormScenario<Dim>> closed_form_scenarios() {
  std::vector<ClosedFormScenario<Dim>> all = {
      thrown_flat<Dim>("backspin", 1.0, -8.0, 0.5),
      block_rest<Dim>(),
      block_slide<Dim>(),
      dropped<Dim>("bounce", 0.5),
      dropped<Dim>("drop", 0.0),
      free_fall<Dim>(),
      down_incline<Dim>("incline_rolling", 0.3, 0.5),
      down_incline<Dim>("incline_sliding", 0.5, 0.1),
      thrown_flat<Dim>("slide_to_roll", 2.0, 0.0, 0.1),
  };
  if constexpr (Dim == 3) all.push_back(spin_and_slide());
  return all;
}
template std::vector<ClosedFormScenario<2>> closed_form_scenarios();
template std::vector<ClosedFormScenario<3>> closed_form_scenarios();

}  // namespace touchstone
