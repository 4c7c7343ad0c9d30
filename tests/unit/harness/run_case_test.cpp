#include "experiments/harness/run_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"

namespace touchstone::harness {
namespace {

/// A body in free flight without gravity, exact to rounding, that does as it is told after step `k`.
class Glider : public Method<2> {
 public:
  using Act = std::function<StepReport(int k, BodyState<2>& body)>;

  explicit Glider(Act act = {}) : act_(std::move(act)) {
    Body<2> body;
    body.name = "glider";
    body.mass = 2.0;
    body.velocity = {1.0, 0.0, 0.5};
    body.shape.geometry = Sphere<2>{1.0};
    scene_.bodies = {body};
    state_ = initial_state(scene_);
  }

  Capabilities capabilities() const override { return {}; }
  const Scene<2>& scene() const override { return scene_; }
  std::span<const BodyState<2>> state() const override { return state_; }
  std::span<const ContactImpulse<2>> contacts() const override { return {}; }
  Options effective_options() const override { return {}; }
  StepReport step(double h) override {
    state_[0].pose = advanced(scene_.bodies[0].pose, state_[0].velocity, h * ++steps_);
    return act_ ? act_(steps_, state_[0]) : StepReport{StepStatus::solved, 2};
  }

 private:
  Scene<2> scene_;
  std::vector<BodyState<2>> state_;
  Act act_;
  int steps_ = 0;
};

constexpr double kKinetic = 0.5 * (2.0 * 1.0 + 1.0 * 0.25);

TEST(StepCount, HitsTheHorizonOrRefuses) {
  EXPECT_EQ(step_count(10, 0.01), 1000);
  EXPECT_EQ(step_count(10, 0.0001), 100000);
  EXPECT_EQ(step_count(0.3, 0.1), 3);
  EXPECT_EQ(step_count(1e4, 1e-4), 100000000);
  EXPECT_THROW(step_count(10, 0.03), InputError);
  EXPECT_THROW(step_count(0.01, 0.02), InputError);
  EXPECT_THROW(step_count(1, 0), InputError);
  EXPECT_THROW(step_count(1, -0.1), InputError);
  EXPECT_THROW(step_count(1, std::nan("")), InputError);
  try {
    step_count(10, 0.03);
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--until: got 10, allowed: a multiple of the step size 0.03 s, at least one step");
  }
}

TEST(RunCase, GoesToTheHorizonAndKeepsItsAccount) {
  Glider glider;
  const CaseRun<2> run = run_case(glider, {.h = 0.01, .until = 10, .report = {1, 10}});
  EXPECT_EQ(run.status, CaseStatus::ok);
  EXPECT_EQ(run.reason, "");
  EXPECT_EQ(run.steps, 1000);
  EXPECT_EQ(run.iterations, 2000);
  EXPECT_EQ(run.failed_steps, 0);
  EXPECT_DOUBLE_EQ(run.end[0].pose.position.x(), 10.0);
  EXPECT_DOUBLE_EQ(run.initial.kinetic, kKinetic);
  EXPECT_EQ(run.final.kinetic, run.initial.kinetic);
  EXPECT_EQ(run.largest_drift_J, 0.0);
  EXPECT_LT(run.residual.largest(), 1e-11);
  ASSERT_TRUE(run.reported[0] && run.reported[1]);
  EXPECT_DOUBLE_EQ(run.reported[0]->kinetic, kKinetic);
}

TEST(RunCase, KeepsStatesAndTheLedgerAtTheSamplesIfAsked) {
  const auto brake = [](int, BodyState<2>& body) {
    body.velocity *= 0.9;
    return StepReport{};
  };
  Glider plain(brake);
  const CaseRun<2> without = run_case(plain, {.h = 0.1, .until = 2, .samples = 4});
  EXPECT_TRUE(without.states.empty());
  EXPECT_TRUE(without.accounts.empty());
  EXPECT_EQ(without.account.drift, 0);

  Glider glider(brake);
  const CaseRun<2> run =
      run_case(glider, {.h = 0.1, .until = 2, .samples = 4, .states = true, .ledger = true});
  EXPECT_EQ(run.planned_steps, 20);
  EXPECT_TRUE(run.impulses);
  ASSERT_EQ(run.samples.size(), 5u);
  ASSERT_EQ(run.states.size(), 5u);
  ASSERT_EQ(run.accounts.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const double speed = std::pow(0.9, 5 * static_cast<double>(i));
    EXPECT_NEAR(run.states[i][0].velocity[0], speed, 1e-14);
    // What no contact took is drift.
    EXPECT_NEAR(run.accounts[i].drift, kKinetic * (speed * speed - 1), 1e-14);
    EXPECT_EQ(run.accounts[i].friction_loss, 0);
  }
  EXPECT_EQ(run.account.drift, run.accounts.back().drift);
}

TEST(RunCase, SamplesFromTheStartToTheHorizonAtTimesThatAllStepsShare) {
  Glider coarse;
  Glider fine;
  const auto a = run_case(coarse, {.h = 0.05, .until = 10}).samples;
  const auto b = run_case(fine, {.h = 0.0005, .until = 10}).samples;
  ASSERT_EQ(a.size(), 201u);
  ASSERT_EQ(b.size(), 201u);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].t_s, b[i].t_s);
  EXPECT_EQ(a[3].t_s, 0.15);
  EXPECT_EQ(a.back().t_s, 10.0);
}

TEST(RunCase, ReportsNothingBetweenStepsOrBeyondTheHorizon) {
  Glider glider;
  const CaseRun<2> run = run_case(glider, {.h = 0.04, .until = 2, .report = {0.1, 2, 5}});
  EXPECT_FALSE(run.reported[0]);
  EXPECT_TRUE(run.reported[1]);
  EXPECT_FALSE(run.reported[2]);
}

TEST(RunCase, AFailedStepEndsTheCaseWithStatusAndReason) {
  Glider glider([](int k, BodyState<2>&) -> StepReport {
    if (k == 4) return {StepStatus::not_converged, 50, 1.0, "ray termination"};
    return {};
  });
  const CaseRun<2> run = run_case(glider, {.h = 0.5, .until = 5, .report = {1, 5}});
  EXPECT_EQ(run.status, CaseStatus::failed);
  EXPECT_EQ(run.reason, "step 4 from t = 1.5 s: not_converged: ray termination");
  EXPECT_EQ(run.failed_steps, 1);
  EXPECT_EQ(run.steps, 3);
  EXPECT_EQ(run.iterations, 50);
  EXPECT_TRUE(run.reported[0]) << "what came before is kept";
  EXPECT_FALSE(run.reported[1]);
}

TEST(RunCase, AStateThatIsNotFiniteEndsItWhateverTheMethodSays) {
  for (const bool velocity : {true, false}) {
    Glider glider([=](int k, BodyState<2>& body) -> StepReport {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      if (k == 2) (velocity ? body.velocity[2] : body.pose.position[1]) = nan;
      return {};
    });
    const CaseRun<2> run = run_case(glider, {.h = 0.5, .until = 5});
    EXPECT_EQ(run.status, CaseStatus::failed);
    EXPECT_EQ(run.reason, "step 2 from t = 0.5 s: non_finite: state after the step");
  }
}

TEST(RunCase, DriftIsTheLargestOnTheWayNotTheLast) {
  Glider glider([](int k, BodyState<2>& body) -> StepReport {
    body.velocity[0] = k == 3 ? 2.0 : 1.0;
    return {};
  });
  const CaseRun<2> run = run_case(glider, {.h = 0.5, .until = 5});
  EXPECT_DOUBLE_EQ(run.largest_drift_J, 3.0);
  EXPECT_EQ(run.final.kinetic, run.initial.kinetic);
  EXPECT_GT(run.residual.dynamics, 0.1) << "a velocity from nowhere";
}

TEST(RunCase, TheJudgeSeesAPositionThatDoesNotFollowTheVelocity) {
  Glider glider([](int k, BodyState<2>& body) -> StepReport {
    if (k == 3) body.pose.position[0] += 0.25;
    return {};
  });
  EXPECT_GT(run_case(glider, {.h = 0.5, .until = 5}).residual.kinematics, 0.2);
}

/// A glider that is not one run, or has an estimate: 0.25 m off after the first step, 0.125 m after that.
class Unsure final : public Glider {
 public:
  explicit Unsure(bool one_run)
      : Glider([](int, BodyState<2>&) { return StepReport{}; }), one_run_(one_run) {}
  Capabilities capabilities() const override { return {.one_run = one_run_}; }
  std::span<const StateError<2>> error_estimate() const override { return error_; }
  StepReport step(double h) override {
    error_[0].position[0] = error_[0].position[0] == 0 ? 0.25 : 0.125;
    error_[0].velocity = {0, 3, -4};
    return Glider::step(h);
  }

 private:
  std::vector<StateError<2>> error_{1};
  bool one_run_;
};

TEST(RunCase, KeepsTheMethodsOwnEstimateOfItsError) {
  Unsure unsure(true);
  const CaseRun<2> run = run_case(unsure, {.h = 0.5, .until = 5});
  ASSERT_TRUE(run.estimated_end && run.estimated_largest);
  EXPECT_EQ(run.estimated_end->position_m, 0.125);
  EXPECT_EQ(run.estimated_largest->position_m, 0.25);
  EXPECT_EQ(run.estimated_largest->velocity_m_s, 3);
  EXPECT_EQ(run.estimated_largest->angular_velocity_rad_s, 4);
  EXPECT_EQ(run.estimated_largest->turn_rad, 0);
  Glider sure;
  EXPECT_FALSE(run_case(sure, {.h = 0.5, .until = 5}).estimated_end);
}

TEST(RunCase, HasNoResidualOfAStepWhereStatesAreNotOfOneRun) {
  Unsure unsure(false);
  const CaseRun<2> run = run_case(unsure, {.h = 0.5, .until = 5});
  EXPECT_EQ(run.status, CaseStatus::ok);
  EXPECT_TRUE(std::isnan(run.residual.largest()));
  EXPECT_TRUE(std::isnan(run.residual.dynamics));
}

TEST(RunCase, KeepsEveryStepOnlyIfItIsToKeepThem) {
  Glider glider;
  const CaseRun<2> run = run_case(glider, {.h = 0.5, .until = 2, .report = {}, .keep_steps = true});
  ASSERT_EQ(run.kept.size(), 5u);
  for (std::size_t k = 0; k < run.kept.size(); ++k) {
    EXPECT_EQ(run.kept[k].t_s, 0.5 * static_cast<double>(k));
    EXPECT_DOUBLE_EQ(run.kept[k].state.at(0).pose.position.x(), run.kept[k].t_s);
  }
  Glider other;
  EXPECT_TRUE(run_case(other, {.h = 0.5, .until = 2}).kept.empty());
}

TEST(RunCase, BooksWhatNoImpulseExplainsAsDrift) {
  Glider glider([](int k, BodyState<2>& body) -> StepReport {
    if (k == 3) body.velocity[0] = 2.0;
    return {};
  });
  const CaseRun<2> run = run_case(glider, {.h = 0.5, .until = 5, .report = {}, .keep_steps = true});
  EXPECT_DOUBLE_EQ(run.account.drift, 3.0);
  EXPECT_EQ(run.account.friction_loss, 0.0);
  EXPECT_EQ(run.account.impact_loss, 0.0);
}

TEST(RunCase, StopsBetweenStepsWhenInterrupted) {
  const InterruptScope scope;
  int last = 0;
  Glider glider([&](int k, BodyState<2>&) -> StepReport {
    last = k;
    if (k == 3) ::raise(SIGINT);
    return {};
  });
  EXPECT_THROW(run_case(glider, {.h = 0.5, .until = 5}), Interrupted);
  EXPECT_EQ(last, 3);
}

}  // namespace
}  // namespace touchstone::harness
