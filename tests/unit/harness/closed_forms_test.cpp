// The closed_forms program and its scenarios: that each closed form obeys the scene's own mechanics, and that
// the program's errors and orders are what the methods' theory says.

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/harness/csv.h"
#include "experiments/harness/judge.h"
#include "experiments/scenarios/closed_forms.h"
#include "experiments/scenarios/table.h"
#include "tests/unit/harness/cells.h"
#include "tests/unit/harness/process.h"

namespace touchstone {
namespace {

using harness::Row;
using harness::Table;
using test::Finished;
using test::number;
using test::Scratch;
using test::slurp;

constexpr double kDifference = 1e-5;  // [s], of central differences

template <int Dim>
std::vector<BodyState<Dim>> state_at(const ClosedFormScenario<Dim>& scenario, double t) {
  std::vector<BodyState<Dim>> state = initial_state(scenario.scene);
  state[0] = scenario.body_at(t);
  return state;
}

Angular<2> turn(const PlanarRotation& from, const PlanarRotation& to) {
  return Angular<2>(to.angle() - from.angle());
}
Angular<3> turn(const SpatialRotation& from, const SpatialRotation& to) {
  const Eigen::AngleAxisd step(to.quaternion() * from.quaternion().conjugate());
  return step.angle() * step.axis();
}

/// Times off every event, so that differences do not reach across one.
constexpr double kTimes[] = {0.05, 0.23, 0.37, 0.48, 0.63, 0.77, 0.95};

template <int Dim>
void expect_velocities_are_the_rates_of_poses() {
  for (const auto& scenario : closed_form_scenarios<Dim>()) {
    for (const double t : kTimes) {
      const auto before = scenario.body_at(t - kDifference);
      const auto now = scenario.body_at(t);
      const auto after = scenario.body_at(t + kDifference);
      const Vector<Dim> rate = (after.pose.position - before.pose.position) / (2 * kDifference);
      EXPECT_LE((rate - now.velocity.template head<Dim>()).norm(), 1e-6) << scenario.key << " at " << t;
      if (!scenario.has_orientation) continue;
      const Angular<Dim> spin = turn(before.pose.rotation, after.pose.rotation) / (2 * kDifference);
      EXPECT_LE((spin - now.velocity.template tail<Dimension<Dim>::angular>()).norm(), 1e-6)
          << scenario.key << " at " << t;
    }
  }
}

/// What the plane must give for the body to move so is a force that a plane with friction can give: never
/// pulling, within the cone, and its moment about the centre is that of a force at the contact.
template <int Dim>
void expect_forces_of_a_plane_with_friction() {
  for (const auto& scenario : closed_form_scenarios<Dim>()) {
    const Body<Dim>& body = scenario.scene.bodies[0];
    const Vector<Dim> normal = std::get<HalfSpace<Dim>>(scenario.scene.bodies[1].shape.geometry).normal;
    const auto& law = scenario.scene.contact_law;
    for (const double t : kTimes) {
      const Twist<Dim> rate =
          (scenario.body_at(t + kDifference).velocity - scenario.body_at(t - kDifference).velocity) /
          (2 * kDifference);
      const Vector<Dim> force = body.mass * (rate.template head<Dim>() - scenario.scene.gravity);
      const double pressing = force.dot(normal);
      const Vector<Dim> friction = force - pressing * normal;
      constexpr double kTolerance = 1e-5;
      EXPECT_GE(pressing, -kTolerance) << scenario.key << " at " << t;
      EXPECT_LE(friction.norm(), law.mu * pressing + kTolerance) << scenario.key << " at " << t;
      if (!std::holds_alternative<Sphere<Dim>>(body.shape.geometry)) continue;
      const Angular<Dim> moment = body.inertia * rate.template tail<Dimension<Dim>::angular>();
      Angular<Dim> left = moment - lever(Vector<Dim>(-normal)).transpose() * friction;
      if constexpr (Dim == 3) {
        if (law.e_r > 0) left -= left.dot(normal) * normal;  // torsion
      }
      EXPECT_LE(left.norm(), kTolerance) << scenario.key << " at " << t;
    }
  }
}

/// Nothing overlaps, the scene starts as the closed form does, and energy is only lost.
template <int Dim>
void expect_no_overlap_and_no_gain() {
  for (const auto& scenario : closed_form_scenarios<Dim>()) {
    const Judge<Dim> judge(scenario.scene);
    const auto start = initial_state(scenario.scene);
    EXPECT_EQ(start[0].pose.position, scenario.body_at(0).pose.position) << scenario.key;
    EXPECT_EQ(start[0].velocity, scenario.body_at(0).velocity) << scenario.key;
    double energy = judge.energy(start).total();
    for (const double t : kTimes) {
      const auto state = state_at(scenario, t);
      EXPECT_LE(judge.largest_penetration(state), 1e-12) << scenario.key << " at " << t;
      const double now = judge.energy(state).total();
      EXPECT_LE(now, energy + 1e-9) << scenario.key << " at " << t;
      energy = now;
    }
  }
}

TEST(ClosedFormScenarios, VelocitiesAreTheRatesOfPoses) {
  expect_velocities_are_the_rates_of_poses<2>();
  expect_velocities_are_the_rates_of_poses<3>();
}

TEST(ClosedFormScenarios, NeedOnlyForcesThatAPlaneWithFrictionGives) {
  expect_forces_of_a_plane_with_friction<2>();
  expect_forces_of_a_plane_with_friction<3>();
}

TEST(ClosedFormScenarios, OverlapNothingAndGainNoEnergy) {
  expect_no_overlap_and_no_gain<2>();
  expect_no_overlap_and_no_gain<3>();
}

TEST(ClosedFormScenarios, StandInTheTableOfScenariosSorted) {
  for (const auto& one : closed_form_scenarios<3>()) {
    EXPECT_TRUE(std::any_of(scenarios().begin(), scenarios().end(), [&](const auto& entry) {
      return entry.key == one.key;
    })) << one.key;
  }
  EXPECT_TRUE(std::is_sorted(scenarios().begin(), scenarios().end(),
                             [](const auto& a, const auto& b) { return a.key < b.key; }));
}

TEST(ClosedForms, ErrorsAreWhatTheStepperMakesInClosedForm) {
  const Scratch scratch;
  const Finished run =
      test::run({CLOSED_FORMS, "--out", (scratch / "out").string(), "--methods", "implicit_ncp",
                 "--scenarios", "free_fall,block_rest", "--step-sizes", "0.02,0.01,0.005"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Table summary = harness::read_csv(scratch / "out/summary.csv");
  const Table errors = harness::read_csv(scratch / "out/errors.csv");
  for (const char* dimension : {"2", "3"}) {
    // v' = v + h g, x' = x + h v' falls g h t / 2 too far, and its speed is exact.
    for (const auto& [cell, h] :
         {std::pair{"0.02", 0.02}, std::pair{"0.01", 0.01}, std::pair{"0.005", 0.005}}) {
      const std::vector<std::pair<std::string, std::string>> row = {
          {"scenario", "free_fall"}, {"dimension", dimension}, {"step_s", cell}};
      EXPECT_NEAR(number(errors, row, "position_error_m"), 9.81 * h / 2, 1e-12);
      EXPECT_LE(number(errors, row, "velocity_error_m_s"), 1e-12);
      EXPECT_LE(number(errors, row, "orientation_error_rad"), 1e-7);
    }
    EXPECT_NEAR(number(summary, {{"scenario", "free_fall"}, {"dimension", dimension}}, "observed_order"), 1.0,
                1e-6);
    EXPECT_EQ(number(summary, {{"scenario", "block_rest"}, {"dimension", dimension}}, "orders_from"), 0);
  }
}

TEST(ClosedForms, GivesTheSameBytesFromOneAndTwoThreadsWhateverIsIsolated) {
  const Scratch scratch;
  const std::vector<std::vector<std::string>> ways = {{"--jobs", "1"},
                                                      {"--jobs", "2"},
                                                      {"--jobs", "1", "--isolate", "never"},
                                                      {"--jobs", "2", "--isolate", "always"}};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    std::vector<std::string> words = {CLOSED_FORMS,  "--quick",
                                      "--out",       (scratch / std::to_string(i)).string(),
                                      "--methods",   "bullet_si,implicit_ncp,ode_quickstep",
                                      "--scenarios", "bounce,slide_to_roll"};
    words.insert(words.end(), ways[i].begin(), ways[i].end());
    ASSERT_EQ(test::run(words).code, 0);
    for (const char* name : {"summary.csv", "errors.csv", "summary.meta.json"}) {
      EXPECT_FALSE(slurp(scratch / "0" / name).empty());
      EXPECT_EQ(slurp(scratch / "0" / name), slurp(scratch / std::to_string(i) / name)) << name;
    }
  }
}

}  // namespace
}  // namespace touchstone
