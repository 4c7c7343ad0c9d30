// Example 1 of the paper: a disc that rolls on a plane keeps its energy for ever, and what follows from the
// law alone for a disc that slides or falls first.
#include <gtest/gtest.h>

#include <cmath>

#include "baselines/registry.h"
#include "core/complementarity/residual.h"
#include "core/stepper/implicit_stepper.h"
#include "experiments/harness/judge.h"
#include "experiments/scenarios/disc_rolling.h"

namespace touchstone {
namespace {

using Solver = ImplicitOptions::Solver;

struct Worst {
  double drift = 0.0;     ///< of kinetic energy, relative to its start
  double residual = 0.0;  ///< the judge's
  double own = 0.0;       ///< natural residual of Eqs. 10-11 as printed
};

Worst roll(const ImplicitOptions& options, double h, int steps) {
  ImplicitStepper<2> stepper(disc_rolling_scene(), options);
  const Judge<2> judge(stepper.scene());
  const double start = judge.energy(stepper.state()).kinetic;
  StepProblem<2> printed(stepper.scene());
  std::vector<BodyState<2>> before;
  Worst worst;
  for (int k = 0; k < steps; ++k) {
    before.assign(stepper.state().begin(), stepper.state().end());
    EXPECT_EQ(stepper.step(h).status, StepStatus::solved);
    const StepResidual residual = judge.step_residual(before, stepper.state(), stepper.contacts(), h);
    worst.residual = std::max(worst.residual, residual.largest());
    worst.drift = std::max(worst.drift, std::abs(judge.energy(stepper.state()).kinetic / start - 1));
    printed.prepare(before, h, stepper.problem().contacts());
    printed.set_form(FrictionForm::fritz_john);
    worst.own = std::max(worst.own, natural_residual(printed, stepper.solution()).value);
  }
  return worst;
}

class DiscRolling : public testing::TestWithParam<std::tuple<Solver, GapFunction>> {
 protected:
  static ImplicitOptions options() {
    return {.solver = std::get<0>(GetParam()), .gap = std::get<1>(GetParam())};
  }
};

TEST_P(DiscRolling, KeepsItsEnergyAndSolvesThePapersSystemAtEveryStep) {
  for (const double h : {0.05, 0.01, 0.005, 0.001}) {
    const Worst worst = roll(options(), h, static_cast<int>(std::lround(10 / h)));
    EXPECT_LE(worst.drift, 1e-12) << "h = " << h;
    EXPECT_LE(worst.residual, 1e-12) << "h = " << h;
    EXPECT_LE(worst.own, 1e-12) << "h = " << h;
  }
}

TEST_P(DiscRolling, SlidesAtTheDiscreteLawAndRollsAtTwoThirdsOfItsSpeed) {
  // From no spin: v falls by mu g h a step while it slides, omega rises by mu m g R h / I; it rolls at v0 /
  // (1 + I/(m R^2)).
  Scene<2> scene = disc_rolling_scene();
  scene.bodies[0].velocity << -3, 0, 0;
  ImplicitStepper<2> stepper(scene, options());
  const double h = 0.01;
  const double mu_g = 0.4 * 9.81;
  for (int k = 1; k <= 60; ++k) {
    ASSERT_EQ(stepper.step(h).status, StepStatus::solved);
    const Twist<2> nu = stepper.state()[0].velocity;
    const double sliding_speed = -3 + mu_g * h * k;
    const double sliding_spin = 2 * mu_g * h * k;
    const bool slides = sliding_speed + sliding_spin < 0;
    EXPECT_NEAR(nu[0], slides ? sliding_speed : -2.0, 1e-11) << k;
    EXPECT_NEAR(nu[2], slides ? sliding_spin : 2.0, 1e-11) << k;
    EXPECT_NEAR(nu[1], 0, 1e-12);
  }
}

TEST_P(DiscRolling, FallsFreelyAndStopsOnThePlaneWithoutPenetrating) {
  Scene<2> scene = disc_rolling_scene();
  scene.bodies[0].pose.position = {0, 1.5};
  ImplicitStepper<2> stepper(scene, options());
  const Judge<2> judge(stepper.scene());
  const double h = 0.01;
  double y = 1.5;
  double v = 0;
  bool landed = false;
  for (int k = 1; k <= 100; ++k) {
    ASSERT_EQ(stepper.step(h).status, StepStatus::solved);
    v -= 9.81 * h;
    y += h * v;
    landed = landed || y < 1;
    const BodyState<2>& disc = stepper.state()[0];
    EXPECT_NEAR(disc.pose.position.y(), landed ? 1.0 : y, 1e-12) << k;
    EXPECT_LE(judge.largest_penetration(stepper.state()), 1e-12);
  }
  EXPECT_TRUE(landed);
  EXPECT_NEAR(stepper.state()[0].velocity[1], 0, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(SolversAndGaps, DiscRolling,
                         testing::Combine(testing::Values(Solver::condensed, Solver::path,
                                                          Solver::semismooth),
                                          testing::Values(GapFunction::workspace, GapFunction::distance)));

TEST(DiscRollingLong, DriftsByLessThan1e10InAMillionSteps) {
  ImplicitStepper<2> stepper(disc_rolling_scene(), {});
  const Judge<2> judge(stepper.scene());
  const double start = judge.energy(stepper.state()).kinetic;
  double drift = 0;
  for (int k = 0; k < 1000000; ++k) {
    ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
    drift = std::max(drift, std::abs(judge.energy(stepper.state()).kinetic / start - 1));
  }
  EXPECT_LE(drift, 1e-10);
}

TEST(DiscRollingControl, APolygonWithFrozenGeometryLosesEnergy) {
  // The negative control of the energy test: the same step with contact points, normals and gaps of its
  // start.
  const auto method = find_method<2>("stewart_trinkle").make(disc_rolling_scene(), {{"edges", "1000"}});
  const Judge<2> judge(method->scene());
  const double start = judge.energy(method->state()).kinetic;
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(method->step(0.01).status, StepStatus::solved);
  EXPECT_GT(std::abs(judge.energy(method->state()).kinetic / start - 1), 0.1);
}

}  // namespace
}  // namespace touchstone
