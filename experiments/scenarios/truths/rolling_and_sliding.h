#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

/// Closed forms of rolling and sliding under Coulomb friction. SI units; every
/// derivation is a few lines and stands here. A round body's shape factor is
/// b = I / (m r^2): 2/5 solid ball, 1/2 disc or cylinder, 1 ring.
namespace touchstone::truth {

inline constexpr double solid_ball = 0.4;
inline constexpr double solid_disc = 0.5;

/// A round body on a horizontal plane that may slip: slide_to_roll and backspin.
struct SlidingRoller {
  double shape_factor = solid_ball;  ///< b > 0
  double radius = 1.0;               ///< > 0 [m]
  double friction = 0.2;             ///< mu > 0
  double gravity = 9.81;             ///< > 0 [m/s^2]
  double speed = 1.0;                ///< of the centre at t = 0 [m/s]
  double spin = 0.0;                 ///< at t = 0, positive as if rolling with speed > 0 [rad/s]

  /// [m/s] Falls at mu g (1 + 1/b): friction slows the centre by mu g and turns the body by mu g / (b r).
  [[nodiscard]] double slip() const { return speed - radius * spin; }
  /// When slip has come to zero [s].
  [[nodiscard]] double rolls_from() const {
    return shape_factor / (1.0 + shape_factor) * std::abs(slip()) / (friction * gravity);
  }
  /// Angular momentum about a point of the plane is kept: (1 + b) v = v0 + b r spin0.
  [[nodiscard]] double rolling_speed() const {
    return (speed + shape_factor * radius * spin) / (1.0 + shape_factor);
  }
  /// Energy lost to friction for ever, per unit mass [J/kg]: b / (1 + b) s^2 / 2, all of it before rolling.
  [[nodiscard]] double lost_energy() const {
    return 0.5 * shape_factor / (1.0 + shape_factor) * slip() * slip();
  }
};

struct RollerState {
  double position = 0.0, speed = 0.0, spin = 0.0;  ///< [m], [m/s], [rad/s]
};

/// At time t >= 0 [s]: sliding first, then rolling for ever.
inline RollerState roller_at(const SlidingRoller& roller, double t) {
  const double sliding = std::min(t, roller.rolls_from());
  const double push = -std::copysign(roller.friction * roller.gravity, roller.slip());
  RollerState state;
  state.speed = roller.speed + push * sliding;
  state.position = roller.speed * sliding + 0.5 * push * sliding * sliding;
  state.spin = roller.spin - push * sliding / (roller.shape_factor * roller.radius);
  if (t > sliding) {
    state.speed = roller.rolling_speed();
    state.spin = state.speed / roller.radius;
    state.position += state.speed * (t - sliding);
  }
  return state;
}

/// A round body released at rest on an incline of angle theta [rad], 0 <= theta < pi/2.
struct InclineRolling {
  double shape_factor = solid_ball;  ///< b > 0
  double friction = 0.5;             ///< mu >= 0
  double gravity = 9.81;             ///< > 0 [m/s^2]
  double theta = 0.3;                ///< [rad]

  /// Least mu for rolling: friction b/(1+b) m g sin(theta) must be within mu m g cos(theta).
  [[nodiscard]] double needed_friction() const {
    return shape_factor / (1.0 + shape_factor) * std::tan(theta);
  }
  [[nodiscard]] bool rolls() const { return friction >= needed_friction(); }
  /// Down the slope [m/s^2]: g sin / (1 + b) if it rolls, else g
  /// (sin - mu cos). Rolling down a height h gives v^2 = 2 g h / (1 + b).
  [[nodiscard]] double acceleration() const {
    if (rolls()) return gravity * std::sin(theta) / (1.0 + shape_factor);
    return gravity * (std::sin(theta) - friction * std::cos(theta));
  }
  /// r times the angular acceleration [m/s^2]: equals acceleration() when it rolls.
  [[nodiscard]] double surface_acceleration() const {
    return rolls() ? acceleration() : friction * gravity * std::cos(theta) / shape_factor;
  }
  /// Friction force per unit mass, up the slope [m/s^2].
  [[nodiscard]] double friction_acceleration() const {
    return std::min(needed_friction(), friction) * gravity * std::cos(theta);
  }
};

/// A uniform block put at rest on an incline: what does it do?
struct BlockOnIncline {
  double base = 1.0;      ///< along the slope, > 0 [m]
  double height = 1.0;    ///< across it, > 0 [m]
  double friction = 0.5;  ///< mu >= 0
  double theta = 0.3;     ///< in [0, pi/2) [rad]
  double gravity = 9.81;  ///< > 0 [m/s^2]

  enum class Start { rests, slides, tips, tips_and_slides };

  /// Friction above which the block that tips about its lower edge does not slide at once. About the edge
  ///   alpha = (3 g / 2) (h sin - b cos) / (b^2 + h^2),
  /// so friction is m (g sin - alpha h/2) and the normal force m (g cos + alpha b/2): their
  /// ratio, with k = b/h and T = tan(theta), is (T (k^2 + 1/4) + 3k/4) / (1 + k^2/4 + 3kT/4).
  [[nodiscard]] double friction_to_tip_in_place() const {
    const double k = base / height;
    const double tangent = std::tan(theta);
    return (tangent * (k * k + 0.25) + 0.75 * k) / (1.0 + 0.25 * k * k + 0.75 * k * tangent);
  }

  /// With k = base/height: rests iff tan(theta) <= min(mu, k). If tan(theta) > mu and
  /// mu <= k it slides flat, since its normal forces need reach only mu h/2 ahead of the
  /// centre. Otherwise it tips, and slides too below friction_to_tip_in_place().
  [[nodiscard]] Start start() const {
    const double k = base / height;
    const double tangent = std::tan(theta);
    if (tangent <= friction && tangent <= k) return Start::rests;
    if (tangent <= k || friction <= k) return Start::slides;
    return friction < friction_to_tip_in_place() ? Start::tips_and_slides : Start::tips;
  }

  /// Down the slope while it slides flat [m/s^2].
  [[nodiscard]] double sliding_acceleration() const {
    return gravity * (std::sin(theta) - friction * std::cos(theta));
  }
};

/// How far a block slides on a horizontal plane until it rests, v^2 / (2 mu g) [m], whatever its
/// mass; and for how long, v / (mu g) [s]. It does not tip on the way iff mu < base / height.
inline double stopping_distance(double speed, double friction, double gravity) {
  return speed * speed / (2.0 * friction * gravity);
}
inline double stopping_time(double speed, double friction, double gravity) {
  return std::abs(speed) / (friction * gravity);
}

/// A ball that rolls without slip on a horizontal table that turns at Omega about the
/// vertical through the origin (e_r = 0). From v' = Omega b/(1+b) z x v, with v the
/// velocity of the centre in the world: it goes round in circles at b/(1+b) Omega (2/7
/// Omega for a solid ball), in the table's sense. Needs b/(1+b) |Omega| |v| <= mu g.
/// @param position, velocity  of the centre at t = 0, world [m], [m/s]
/// @returns the centre at time t
inline Eigen::Vector2d turntable_position(double shape_factor, double table_rate,
                                          const Eigen::Vector2d& position, const Eigen::Vector2d& velocity,
                                          double t) {
  const double rate = shape_factor / (1.0 + shape_factor) * table_rate;
  if (rate == 0.0) return position + velocity * t;
  const double s = std::sin(rate * t) / rate;
  const double versine = 2.0 * std::sin(0.5 * rate * t) * std::sin(0.5 * rate * t) / rate;
  return position + Eigen::Vector2d(s * velocity.x() - versine * velocity.y(),
                                    versine * velocity.x() + s * velocity.y());
}

/// Least mu for which a uniform rod, at the angle theta from the ground and
/// with its tip sliding AWAY from the centre of mass, has Painleve's paradox:
///   mu = (tan^2 theta + 4) / (3 tan theta),
/// where the tip's normal acceleration for a unit normal force, [1 + 3 cos^2 - 3
/// mu sin cos] / m, changes sign. The least of all is 4/3, at tan theta = 2.
inline double painleve_friction(double theta) {
  const double tangent = std::tan(theta);
  return (tangent * tangent + 4.0) / (3.0 * tangent);
}

}  // namespace touchstone::truth
