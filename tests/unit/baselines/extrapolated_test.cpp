// The combination of two runs, of a method whose error is known because it is put in on purpose.
#include "baselines/formulations/extrapolated.h"

#include <gtest/gtest.h>

#include "baselines/registry.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

const Vector<3> kTruePosition(1, 2, 3);
const Vector<3> kTrueTurn(0.5, -1.0, 2.0);
const Vector<3> kPositionSlope(1, 0, -2);
const Vector<3> kTurnSlope(3, 4, -5);

/// After any step of h the state is the truth and an error of h times a slope; fails on the steps told.
class Wrong final : public Method<3> {
 public:
  explicit Wrong(const Scene<3>& scene, int fails_at)
      : scene_(scene), state_(initial_state(scene)), fails_at_(fails_at) {}

  Capabilities capabilities() const override { return {.torsional_friction = true}; }
  const Scene<3>& scene() const override { return scene_; }
  std::span<const BodyState<3>> state() const override { return state_; }
  std::span<const ContactImpulse<3>> contacts() const override { return contacts_; }
  Options effective_options() const override { return {{"wrong", "yes"}}; }
  StepReport step(double h) override {
    if (++steps_ == fails_at_) return {StepStatus::not_converged, 5, 0.5, "told to"};
    state_[0].pose.position = kTruePosition + h * kPositionSlope;
    state_[0].pose.rotation = SpatialRotation(exp_rotation(h * kTurnSlope) * exp_rotation(kTrueTurn));
    state_[0].velocity = Twist<3>::Constant(7 + h);
    // The second half step's frame is turned by a right angle about the normal.
    ContactImpulse<3> c;
    c.body_b = 1;
    c.normal = Vector<3>::UnitZ();
    c.tangents.col(0) = steps_ == 1 ? Vector<3>::UnitX() : Vector<3>::UnitY();
    c.tangents.col(1) = c.normal.cross(Vector<3>(c.tangents.col(0)));
    c.normal_impulse = steps_;
    c.friction_impulse = {1, 0, 0.25};
    contacts_ = {c};
    return {StepStatus::solved, 3, h};
  }

 private:
  Scene<3> scene_;
  std::vector<BodyState<3>> state_;
  std::vector<ContactImpulse<3>> contacts_;
  int fails_at_;
  int steps_ = 0;
};

template <int fails_at>
std::unique_ptr<Method<3>> make_wrong(const Scene<3>& scene, const Options&) {
  return std::make_unique<Wrong>(scene, fails_at);
}

Scene<3> one_ball() { return scene<3>(0.5, {ball("ball", {0, 0, 1}), ground<3>()}); }

TEST(Extrapolated, TakesAnErrorOfFirstOrderOutOfPoseAndVelocity) {
  Extrapolated<3> method(&make_wrong<0>, one_ball(), {});
  ASSERT_EQ(method.step(0.2).status, StepStatus::solved);
  const BodyState<3>& state = method.state()[0];
  EXPECT_LT((state.pose.position - kTruePosition).norm(), 1e-14);
  EXPECT_LT((state.pose.rotation.matrix() - SpatialRotation(exp_rotation(kTrueTurn)).matrix()).norm(), 1e-14);
  EXPECT_LT((state.velocity - Twist<3>::Constant(7)).norm(), 1e-14);
  const StateError<3>& error = method.error_estimate()[0];  // fine minus coarse
  EXPECT_LT((error.position + 0.1 * kPositionSlope).norm(), 1e-14);
  EXPECT_LT((error.turn + 0.1 * kTurnSlope).norm(), 1e-14);
  EXPECT_LT((error.velocity + Twist<3>::Constant(0.1)).norm(), 1e-14);
  EXPECT_EQ(method.error_estimate().size(), 2U) << "a fixed body has an entry too";
}

TEST(Extrapolated, TellsTheFineRunsImpulsesOfBothHalfSteps) {
  Extrapolated<3> method(&make_wrong<0>, one_ball(), {});
  ASSERT_EQ(method.step(0.2).status, StepStatus::solved);
  ASSERT_EQ(method.contacts().size(), 1U);
  const ContactImpulse<3>& sum = method.contacts()[0];
  EXPECT_EQ(sum.normal_impulse, 1 + 2);
  // 1 along x from the first half, 1 along y from the second, in the second's frame (y, -x).
  EXPECT_LT((sum.friction_impulse - FrictionVector<3>(1, -1, 0.5)).norm(), 1e-15);
}

TEST(Extrapolated, SaysThatItIsNotOneRun) {
  const Extrapolated<3> method(&make_wrong<0>, one_ball(), {});
  EXPECT_FALSE(method.capabilities().one_run);
  EXPECT_FALSE(method.capabilities().contact_impulses);
  EXPECT_TRUE(method.capabilities().torsional_friction) << "the method's own";
  EXPECT_EQ(method.effective_options(), (Options{{"wrong", "yes"}}));
}

TEST(Extrapolated, ReportsTheWorkOfAllStepsAndTheWorstResidual) {
  Extrapolated<3> method(&make_wrong<0>, one_ball(), {});
  const StepReport report = method.step(0.2);
  EXPECT_EQ(report.iterations, 3 * 3);
  EXPECT_EQ(report.residual, 0.2);
}

TEST(Extrapolated, StaysWhereItWasOnceARunHasFailed) {
  // The second half step of the fine run fails, when the coarse run has gone on already.
  Extrapolated<3> method(&make_wrong<2>, one_ball(), {});
  const BodyState<3> before = method.state()[0];
  const StepReport report = method.step(0.2);
  EXPECT_EQ(report.status, StepStatus::not_converged);
  EXPECT_EQ(report.reason, "told to");
  EXPECT_EQ(method.step(0.2).status, StepStatus::not_converged);
  EXPECT_EQ(method.state()[0].pose.position, before.pose.position);
  EXPECT_EQ(method.state()[0].velocity, before.velocity);
}

TEST(Extrapolated, AnglesOfThePlaneAreNotWrapped) {
  Scene<2> scene;
  scene.bodies = {disc("disc", {0, 5}, {0, 0, 400})};
  Extrapolated<2> method(find_method<2>("implicit_ncp").make, scene, {});
  for (int k = 0; k < 10; ++k) ASSERT_EQ(method.step(0.1).status, StepStatus::solved);
  EXPECT_NEAR(method.state()[0].pose.rotation.angle(), 400, 1e-10);
}

}  // namespace
}  // namespace touchstone::testing
