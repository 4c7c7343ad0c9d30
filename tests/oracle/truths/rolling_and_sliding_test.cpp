// Are the closed forms of rolling and sliding right? Oracles: figures known from elsewhere, a
// small-step simulation of Coulomb's law, energy balances, and enumeration of every mode of a block.
#include "experiments/scenarios/truths/rolling_and_sliding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/spin_and_slide.h"

namespace touchstone::truth {
namespace {

/// Implicit Euler with Coulomb friction: the impulse that would stop the slip, clamped.
RollerState stepped_roller(const SlidingRoller& roller, double end) {
  const double h = 1e-5;
  RollerState s{0.0, roller.speed, roller.spin};
  for (int k = 0; k < static_cast<int>(std::lround(end / h)); ++k) {
    const double slip = s.speed - roller.radius * s.spin;
    const double limit = roller.friction * roller.gravity * h;
    const double push = std::clamp(-slip / (1.0 + 1.0 / roller.shape_factor), -limit, limit);
    s.speed += push;
    s.spin -= push / (roller.shape_factor * roller.radius);
    s.position += h * s.speed;
  }
  return s;
}

TEST(SlidingRoller, AgreesWithSmallSteps) {
  const SlidingRoller slides{.shape_factor = 0.5, .radius = 0.3, .friction = 0.3, .speed = 2.0, .spin = 0.0};
  const SlidingRoller overspun{.radius = 0.5, .friction = 0.4, .speed = 1.0, .spin = 20.0};
  const SlidingRoller backspun{.radius = 0.25, .friction = 0.5, .speed = 4.0, .spin = -200.0};
  for (const SlidingRoller& roller : {slides, overspun, backspun}) {
    for (const double t : {0.1, 0.5, 2.0, 4.0}) {
      const RollerState exact = roller_at(roller, t);
      const RollerState crude = stepped_roller(roller, t);
      EXPECT_NEAR(exact.position, crude.position, 1e-3);
      EXPECT_NEAR(exact.speed, crude.speed, 1e-4);
      EXPECT_NEAR(exact.spin, crude.spin, 2e-3);
    }
  }
}

TEST(SlidingRoller, HasTheKnownFigures) {
  const SlidingRoller ball{.speed = 7.0};
  EXPECT_NEAR(ball.rolls_from(), 2.0 / 7.0 * 7.0 / (0.2 * 9.81), 1e-15);
  EXPECT_NEAR(ball.rolling_speed(), 5.0, 1e-14);
  EXPECT_NEAR(ball.lost_energy() / (0.5 * 49.0), 2.0 / 7.0, 1e-15);
  const SlidingRoller disc{.shape_factor = solid_disc, .speed = 3.0};
  EXPECT_NEAR(disc.lost_energy() / 4.5, 1.0 / 3.0, 1e-15);
  const SlidingRoller backspun{.radius = 0.25, .friction = 0.5, .speed = 4.0, .spin = -200.0};
  EXPECT_NEAR(backspun.rolling_speed(), -11.43, 2e-3);
  EXPECT_NEAR(backspun.rolls_from(), 3.1455, 5e-5);
}

TEST(SlidingRoller, LosesTheEnergyItSaysAndIsContinuous) {
  const SlidingRoller roller{.radius = 0.25, .friction = 0.5, .speed = 4.0, .spin = -20.0};
  const auto energy = [&](const RollerState& s) {
    return 0.5 * s.speed * s.speed + 0.5 * roller.shape_factor * std::pow(roller.radius * s.spin, 2);
  };
  const double t = roller.rolls_from();
  EXPECT_NEAR(energy(roller_at(roller, 0.0)) - energy(roller_at(roller, 2.0 * t)), roller.lost_energy(),
              1e-13);
  const RollerState before = roller_at(roller, t * (1.0 - 1e-12));
  const RollerState after = roller_at(roller, t * (1.0 + 1e-12));
  EXPECT_NEAR(before.position, after.position, 1e-11);
  EXPECT_NEAR(before.speed, after.speed, 1e-11);
  EXPECT_NEAR(before.spin, after.spin, 1e-10);
}

TEST(InclineRolling, ThresholdEnergyAndTorque) {
  InclineRolling ball{.friction = 0.5, .theta = 0.5};
  EXPECT_NEAR(ball.needed_friction(), 2.0 / 7.0 * std::tan(0.5), 1e-15);
  const double distance = 3.0;
  EXPECT_NEAR(2.0 * ball.acceleration() * distance, 2.0 * 9.81 * distance * std::sin(0.5) / 1.4, 1e-13);
  for (const double factor : {0.5, 0.999, 1.001, 3.0}) {
    ball.friction = factor * ball.needed_friction();
    EXPECT_EQ(ball.rolls(), factor > 1.0);
    // Newton along the slope, Euler about the centre: friction turns the ball.
    const double friction = 9.81 * std::sin(0.5) - ball.acceleration();
    EXPECT_NEAR(friction, ball.friction_acceleration(), 1e-14);
    EXPECT_NEAR(ball.shape_factor * ball.surface_acceleration(), friction, 1e-14);
    EXPECT_GE(ball.acceleration(), ball.surface_acceleration() - 1e-14);
  }
}

/// Every mode of the block that Newton, Euler and Coulomb allow, from its
/// equations and not from the thresholds. x down the slope, y away from it,
/// the lower edge at the origin, the centre at (-b/2, h/2), m = 1.
std::vector<BlockOnIncline::Start> possible_starts(const BlockOnIncline& k) {
  using Start = BlockOnIncline::Start;
  std::vector<Start> found;
  const double gx = k.gravity * std::sin(k.theta), gy = k.gravity * std::cos(k.theta);
  const double b = k.base, h = k.height, inertia = (b * b + h * h) / 12.0;
  // Flat: the resultant of normal forces gy acts F h / (2 gy) ahead of the centre.
  const auto within_base = [&](double friction) { return friction * h / 2.0 <= gy * b / 2.0; };
  if (gx <= k.friction * gy && within_base(gx)) found.push_back(Start::rests);
  if (gx > k.friction * gy && within_base(k.friction * gy)) found.push_back(Start::slides);
  // Tipping about the fixed edge.
  const double alpha = (gx * h / 2.0 - gy * b / 2.0) / (inertia + (b * b + h * h) / 4.0);
  const double friction = gx - alpha * h / 2.0, normal = gy + alpha * b / 2.0;
  if (alpha > 0.0 && friction <= k.friction * normal) found.push_back(Start::tips);
  // Tipping while the edge slides: I alpha = n (mu h - b)/2, n = gy + alpha b/2, a = gx - mu n - alpha h/2.
  const double lever = (k.friction * h - b) / 2.0;
  const double sliding_alpha = lever * gy / (inertia - lever * b / 2.0);
  const double sliding_normal = gy + sliding_alpha * b / 2.0;
  const double slip = gx - k.friction * sliding_normal - sliding_alpha * h / 2.0;
  if (sliding_alpha > 0.0 && sliding_normal > 0.0 && slip > 0.0) found.push_back(Start::tips_and_slides);
  return found;
}

TEST(BlockOnIncline, ThresholdsAreThoseOfTheEquationsOfMotion) {
  std::array<int, 4> seen{};
  for (double theta = 0.05; theta < 1.3; theta += 0.037) {
    for (double base = 0.1; base < 2.0; base += 0.083) {
      for (double mu = 0.03; mu < 2.0; mu += 0.061) {
        const BlockOnIncline block{.base = base, .height = 1.0, .friction = mu, .theta = theta};
        const auto possible = possible_starts(block);
        ASSERT_EQ(possible.size(), 1u) << theta << ' ' << base << ' ' << mu;
        ASSERT_EQ(possible[0], block.start()) << theta << ' ' << base << ' ' << mu;
        ++seen[static_cast<std::size_t>(block.start())];
      }
    }
  }
  for (const int count : seen) EXPECT_GT(count, 100);
}

TEST(StoppingDistance, IsTheWorkOfFriction) {
  EXPECT_NEAR(0.3 * 9.81 * stopping_distance(4.0, 0.3, 9.81), 0.5 * 16.0, 1e-14);
  EXPECT_NEAR(stopping_distance(4.0, 0.3, 9.81), 0.5 * 4.0 * stopping_time(4.0, 0.3, 9.81), 1e-15);
}

TEST(Turntable, FollowsTheRollingConstraint) {
  // Integrates the ball's own equations, with the contact force that keeps it on the table's velocity.
  using Ball = OdeVector<6>;  // x, y, vx, vy, omega_x, omega_y
  const double table = 1.7, b = 0.4;
  const auto field = [&](double, const Ball& s) -> Ball {
    // (v - omega x z)' = table z x v for unit radius, with
    // omega' = -(1/b) z x v' : one linear equation for v'.
    Eigen::Matrix2d coefficient = Eigen::Matrix2d::Identity() * (1.0 + 1.0 / b);
    const Eigen::Vector2d a = coefficient.inverse() * (table * Eigen::Vector2d(-s[3], s[2]));
    return (Ball() << s[2], s[3], a.x(), a.y(), a.y() / b, -a.x() / b).finished();
  };
  const Eigen::Vector2d x0(1.0, 0.5), v0(0.3, -0.4);
  Ball start;
  // omega from the constraint v + (-omega_y, omega_x) = table z x p.
  start << x0, v0, table * x0.x() - v0.y(), v0.x() + table * x0.y();
  const Ball end = integrate<6>(field, 0.0, start, 9.0);
  EXPECT_LT((end.head<2>() - turntable_position(b, table, x0, v0, 9.0)).norm(), 1e-11);
  const Eigen::Vector2d contact(end[2] - end[5], end[3] + end[4]);
  EXPECT_LT((contact - table * Eigen::Vector2d(-end[1], end[0])).norm(), 1e-11);
  const double period = 2.0 * std::numbers::pi / (2.0 / 7.0 * table);
  EXPECT_LT((turntable_position(b, table, x0, v0, period) - x0).norm(), 1e-13);
  EXPECT_LT((turntable_position(b, 0.0, x0, v0, 2.0) - x0 - 2.0 * v0).norm(), 1e-15);
}

TEST(PainleveRod, IsWhereTheTipsResponseChangesSign) {
  for (const double theta : {0.4, 0.9, 1.2}) {
    // Tip at r from the centre of a rod of half length 1 (m = 1,
    // I = 1/3); force (-mu, 1), sliding to +x away from the centre.
    const double x = std::cos(theta), y = -std::sin(theta);
    const auto response = [&](double mu) { return 1.0 + 3.0 * x * (x * 1.0 - y * -mu); };
    const double mu = painleve_friction(theta);
    EXPECT_NEAR(response(mu), 0.0, 1e-13);
    EXPECT_GT(response(0.9 * mu), 0.0);
    EXPECT_LT(response(1.1 * mu), 0.0);
  }
  EXPECT_NEAR(painleve_friction(std::atan(2.0)), 4.0 / 3.0, 1e-15);
}

TEST(SpinAndSlide, AgreesWithTheIntegratedEquations) {
  const SpinAndSlide body;
  const auto field = [&](double, const OdeVector<2>& y) -> OdeVector<2> {
    const double sigma = std::hypot(body.e_t * y[0], body.e_r * y[1]);
    const double limit = body.friction * body.mass * body.gravity;
    return {-3.5 * limit / body.mass * y[0] / sigma,
            -limit * body.e_r * body.e_r / body.spin_inertia * y[1] / sigma};
  };
  const double end = body.end_time();
  for (const double part : {0.1, 0.5, 0.9, 0.99}) {
    const OdeVector<2> y = integrate<2>(field, 0.0, {body.slip, body.spin}, part * end);
    const SpinAndSlide::State exact = body.at(part * end);
    EXPECT_NEAR(exact.slip, y[0], 1e-12) << part;
    EXPECT_NEAR(exact.spin, y[1], 1e-12) << part;
  }
  EXPECT_EQ(body.at(1.0001 * end).spin, 0.0);
  EXPECT_GT(body.at(0.9999 * end).spin, 0.0);
}

TEST(SpinAndSlide, WithoutSpinIsPlainSliding) {
  const SpinAndSlide body{.spin = 0.0};
  EXPECT_NEAR(body.end_time(), 1.0 / (3.5 * 0.2 * 9.81), 1e-13);
  EXPECT_NEAR(body.at(0.05).slip, 1.0 - 3.5 * 0.2 * 9.81 * 0.05, 1e-12);
}

}  // namespace
}  // namespace touchstone::truth
