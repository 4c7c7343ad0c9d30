// The coin, the tippe top and the rattleback: their constants and reversals, and that what a step adds to
// them falls in proportion to it.
#include <gtest/gtest.h>

#include "core/stepper/implicit_stepper.h"
#include "experiments/scenarios/euler_disc.h"
#include "experiments/scenarios/rattleback.h"
#include "experiments/scenarios/tippe_top.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/regression/orders.h"
#include "tests/regression/sanitized.h"

namespace touchstone {
namespace {

using testing::expect_first_order;
using testing::kSanitized;

/// The example scene of the same name has the body that the experiment has.
void expect_example(const std::string& name, const Scene<3>& scene) {
  const auto example =
      std::get<Scene<3>>(scene_file::read_scene(std::string(EXAMPLE_SCENES) + "/" + name + ".toml"));
  ASSERT_EQ(example.bodies.size(), scene.bodies.size());
  const Body<3>& a = example.bodies[0];
  const Body<3>& b = scene.bodies[0];
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_LE((a.inertia - b.inertia).norm(), 1e-12 * b.inertia.norm());
  EXPECT_LE((a.velocity - b.velocity).norm(), 1e-12 * b.velocity.norm());
  EXPECT_LE((a.pose.position - b.pose.position).norm(), 1e-15);
  EXPECT_LE((a.pose.rotation.matrix() - b.pose.rotation.matrix()).norm(), 1e-14);
  EXPECT_EQ(example.contact_law.mu, scene.contact_law.mu);
  EXPECT_EQ(example.contact_law.e_r, scene.contact_law.e_r);
}

TEST(DemonstrationScenes, AreThoseOfTheExampleFiles) {
  expect_example("euler_disc", euler_disc_scene());
  expect_example("tippe_top", tippe_top_scene());
  expect_example("rattleback", rattleback_scene());
}

template <class Look>
void run(const Scene<3>& scene, double h, double until, const Look& look) {
  ImplicitStepper<3> stepper(scene, {});
  const int steps = static_cast<int>(std::lround(until / h));
  for (int k = 1; k <= steps; ++k) {
    ASSERT_EQ(stepper.step(h).status, StepStatus::solved) << "step " << k;
    look(h * k, stepper.state()[0]);
  }
}

TEST(EulersDisc, TendsToTheSteadyMotionWithTheFirstPower) {
  const EulerDiscScene parameters;
  const double until = kSanitized ? 0.2 : 1.0;
  std::vector<double> inclination;
  std::vector<double> energy;
  for (const double h : {0.002, 0.001, 0.0005, 0.00025}) {
    EulerDiscMotion end;
    double height = 0;
    run(euler_disc_scene(parameters), h, until, [&](double, const BodyState<3>& coin) {
      end = euler_disc_motion(coin);
      height = coin.pose.position.z();
    });
    inclination.push_back(parameters.inclination - end.inclination);
    energy.push_back(parameters.disc.center_height(parameters.inclination) - height);
  }
  expect_first_order(inclination);
  expect_first_order(energy);
}

TEST(EulersDisc, PrecessesAsItsScenesClosedFormSays) {
  const EulerDiscScene parameters;
  const BodyState<3> start = initial_state(euler_disc_scene(parameters))[0];
  const EulerDiscMotion motion = euler_disc_motion(start);
  EXPECT_NEAR(motion.inclination, parameters.inclination, 1e-14);
  EXPECT_NEAR(motion.precession, parameters.disc.precession(parameters.inclination), 1e-12);
  EXPECT_EQ(motion.center_speed, 0);
}

TEST(TippeTop, KeepsJellettsConstantToTheFirstPowerWhileItTurnsOver) {
  const TippeTop top;
  const double constant = top.jellett(initial_state(tippe_top_scene(top))[0]);
  std::vector<double> drift;
  for (const double h : {0.001, 0.0005, 0.00025}) {
    double last = 0;
    double steepest = 0;
    const double until = kSanitized ? 0.5 : 3.0;
    run(tippe_top_scene(top), h, until, [&](double, const BodyState<3>& state) {
      last = std::abs(top.jellett(state) / constant - 1);
      steepest = std::max(steepest, top.inclination(state));
    });
    drift.push_back(last);
    EXPECT_GT(steepest, kSanitized ? 0.3 : M_PI / 2);
  }
  expect_first_order(drift);
}

TEST(TippeTop, DoesNotTurnOverWhereItRolls) {
  const TippeTop top{.about_axis = true};
  run(tippe_top_scene(top), 0.0005, kSanitized ? 0.3 : 3.0, [&](double, const BodyState<3>& state) {
    ASSERT_LE(top.inclination(state), 0.15);
    ASSERT_LE(top.slip(state), 1e-9);
  });
}

TEST(TippeTop, TorsionBreaksJellettsConstant) {
  // The control: the same top with a friction torque about the normal loses what it must keep without.
  const TippeTop top;
  Scene<3> scene = tippe_top_scene(top);
  scene.contact_law.e_r = 0.002;
  const double constant = top.jellett(initial_state(scene)[0]);
  double last = 0;
  run(scene, 0.0005, 0.5,
      [&](double, const BodyState<3>& state) { last = top.jellett(state) / constant - 1; });
  EXPECT_LT(last, -0.05);
}

Reversals reversals_of(const Rattleback& back, double h, double until) {
  std::vector<double> times = {0};
  std::vector<double> spins = {back.spin};
  run(rattleback_scene(back), h, until, [&](double t, const BodyState<3>& state) {
    times.push_back(t);
    spins.push_back(state.velocity[5]);
  });
  return count_reversals(times, spins);
}

TEST(RattlebackSense, TurnsBackOnceWhenSpunClockwiseAndNotTheOtherWay) {
  const double until = kSanitized ? 3.2 : 5.0;
  EXPECT_EQ(reversals_of({.spin = -5}, 0.0002, until).count, 1);
  EXPECT_EQ(reversals_of({.spin = 5}, 0.0002, until).count, 0);
}

TEST(RattlebackSense, TheTimeOfTheReversalTendsToTheRollingBodys) {
  std::vector<double> times;
  for (int k = 0; k <= 3000; ++k) times.push_back(0.001 * k);
  std::vector<double> spins;
  const auto truth = truth::roll_ellipsoid(Rattleback{}.rolling(), times, 1e-13);
  ASSERT_EQ(truth.status, truth::EllipsoidStatus::completed);
  for (const auto& sample : truth.samples) spins.push_back(sample.omega.z());
  const double exact = count_reversals(times, spins).first;
  ASSERT_GT(exact, 0);
  std::vector<double> errors;
  for (const double h : {0.0001, 0.00005, 0.000025}) {
    if (kSanitized && h < 0.00005) break;
    errors.push_back(reversals_of({}, h, 2.6).first - exact);
  }
  // The spin swings by 0.5 rad/s about its mean as the body rocks, which moves its zero by up to 0.02 s.
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_GT(errors[i], 0) << "a step damps the rocking, so it turns back later";
    EXPECT_NEAR(errors[i - 1] / errors[i], 2, 0.5);
  }
}

TEST(CountReversals, CountsSensesAndNotRocking) {
  EXPECT_EQ(count_reversals({}, {}).count, 0);
  EXPECT_EQ(count_reversals({0, 1, 2}, {5, 3, 1}).count, 0);
  EXPECT_EQ(count_reversals({0, 1, 2, 3}, {5, -0.4, 0.4, -0.4}).count, 0) << "within a tenth of the first";
  const Reversals once = count_reversals({0, 1, 2, 3, 4}, {5, 1, -1, -3, -2});
  EXPECT_EQ(once.count, 1);
  EXPECT_DOUBLE_EQ(once.first, 1.5);
  EXPECT_EQ(count_reversals({0, 1, 2, 3}, {-5, 1, -1, 4}).count, 3);
  EXPECT_LT(count_reversals({0, 1}, {-5, -4}).first, 0);
}

}  // namespace
}  // namespace touchstone
