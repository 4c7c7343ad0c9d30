// Joints, alone and with contact: the example scenes of the pendulum and the slider-crank against their
// reduced equations of motion.
#include <gtest/gtest.h>

#include "experiments/harness/ledger.h"
#include "experiments/scenarios/truths/ode.h"
#include "experiments/scenarios/truths/slider_crank.h"
#include "experiments/scenarios/truths/swings_and_bounces.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/regression/judged_run.h"
#include "tests/regression/orders.h"

namespace touchstone {
namespace {

using testing::expect_first_order;
using testing::judged_run;

Scene<2> example(const std::string& name) {
  return std::get<Scene<2>>(scene_file::read_scene(std::string(EXAMPLE_SCENES) + "/" + name + ".toml"));
}

constexpr double kLength = 2.0 / 3.0;  // of the simple pendulum: I / (m d) of a rod of 1 m about its end [m]

/// Angle of the pendulum at t [rad].
double pendulum_angle(double t) {
  using State = truth::OdeVector<2>;
  const auto field = [](double, const State& s) -> State { return {s[1], -9.81 / kLength * std::sin(s[0])}; };
  return truth::integrate<2>(field, 0, State(M_PI / 6, 0), t)[0];
}

TEST(Pendulum, TendsToTheReducedEquationWithTheFirstPower) {
  constexpr double kUntil = 1.0;
  std::vector<double> errors;
  for (const double h : {0.004, 0.002, 0.001, 0.0005}) {
    double angle = 0;
    judged_run(example("pendulum"), h, kUntil,
               [&](double, const auto& s) { angle = s.state()[0].pose.rotation.angle(); });
    errors.push_back(std::abs(angle - pendulum_angle(kUntil)));
  }
  expect_first_order(errors);
}

TEST(Pendulum, HasThePeriodOfTheEllipticIntegral) {
  std::vector<double> errors;
  for (const double h : {0.004, 0.002, 0.001, 0.0005}) {
    // From rest to rest on the other side is half a period; the rate goes through zero from below.
    double crossing = 0;
    double last = -1;
    judged_run(example("pendulum"), h, 1.0, [&](double t, const auto& s) {
      const double rate = s.state()[0].velocity[2];
      if (crossing == 0 && last < 0 && rate >= 0 && t > 0.1) crossing = t - h * rate / (rate - last);
      last = rate;
    });
    errors.push_back(std::abs(2 * crossing - truth::pendulum_period(kLength, 9.81, M_PI / 6)));
  }
  EXPECT_LE(errors.back(), 2e-3);
  EXPECT_LE(errors.back(), errors.front() / 4) << "falls with the step";
}

truth::SliderCrank mechanism(const Scene<2>& scene) {
  truth::SliderCrank crank;
  const auto body = [&](const char* name) {
    return scene.bodies[static_cast<std::size_t>(scene.body(name))];
  };
  crank.crank_length = 0.3, crank.rod_length = 0.8;
  crank.crank_mass = body("crank").mass, crank.crank_inertia = body("crank").inertia(0, 0);
  crank.rod_mass = body("rod").mass, crank.rod_inertia = body("rod").inertia(0, 0);
  crank.slider_mass = body("block").mass;
  crank.theta = M_PI / 2, crank.theta_rate = body("crank").velocity[2];
  return crank;
}

TEST(SliderCrank, TendsToTheReducedEquationWithTheFirstPowerBeforeItHits) {
  const Scene<2> scene = example("slider_crank");
  constexpr double kUntil = 0.16;
  const truth::SliderCrankState truth = truth::run_slider_crank(mechanism(scene), {kUntil})[0];
  ASSERT_LT(truth.slider.x() + 0.08, 1.25 - 0.1) << "the block has not reached the disc yet";
  std::vector<double> slider;
  std::vector<double> angle;
  for (const double h : {0.004, 0.002, 0.001, 0.0005}) {
    judged_run(scene, h, kUntil, [&](double t, const auto& s) {
      if (t < kUntil - h / 2) return;
      const auto at = [&](const char* name) { return s.state()[static_cast<std::size_t>(scene.body(name))]; };
      slider.push_back(std::abs(at("block").pose.position.x() - truth.slider.x()));
      angle.push_back(std::abs(at("crank").pose.rotation.angle() - (truth.theta - M_PI / 2)));
    });
  }
  ASSERT_EQ(slider.size(), 4u);
  expect_first_order(slider);
  expect_first_order(angle);
}

TEST(SliderCrank, KeepsItsJointsThroughTheBlowAndThrowsTheDiscOff) {
  const Scene<2> scene = example("slider_crank");
  const auto disc = static_cast<std::size_t>(scene.body("disc"));
  const Judge<2> judge(scene);
  const std::vector<BodyState<2>> start = initial_state(scene);
  EnergyLedger<2> ledger(scene, judge, start);
  std::vector<BodyState<2>> before = start;
  double fastest = 0;
  judged_run(scene, 0.001, 1.0, [&](double, const auto& s) {
    fastest = std::max(fastest, s.state()[disc].velocity[0]);
    EXPECT_LE(judge.largest_penetration(s.state()), 1e-9);
    const double energy = ledger.energy().total();
    const double drift = ledger.account().drift;
    ledger.book(0.001, before, s.state(), s.contacts(), s.joints());
    EXPECT_LE(ledger.energy().total() - energy, std::max(0.0, ledger.account().drift - drift) + 1e-9)
        << "contacts and joints give nothing";
    before.assign(s.state().begin(), s.state().end());
  });
  EXPECT_GT(ledger.account().impact_loss, 0.1) << "the blow is plastic";
  EXPECT_GT(fastest, 0.3) << "the block hit it";
}

}  // namespace
}  // namespace touchstone
