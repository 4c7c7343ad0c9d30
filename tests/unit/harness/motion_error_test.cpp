// Errors against a truth and the order at which they fall.

#include "experiments/harness/motion_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::harness {
namespace {

const TrueMotion kTruth = {
    {1, 2, 3}, {0.1, 0.2, 0.3}, {4, 5, 6}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector<3>::UnitY()))};

BodyState<3> true_state() {
  BodyState<3> state;
  state.pose = {kTruth.position, SpatialRotation(kTruth.orientation)};
  state.velocity << kTruth.velocity, kTruth.omega;
  return state;
}

CaseRun<3> run_of(const std::vector<double>& times) {
  CaseRun<3> run;
  for (const double t : times) run.kept.push_back({t, {true_state()}, {}});
  return run;
}

TEST(MotionError, IsOfEachQuantityByItself) {
  BodyState<3> state = true_state();
  EXPECT_LT(motion_error(state, kTruth).velocity, 1e-15);
  state.velocity[4] -= 0.25;
  state.velocity[1] += 0.125;
  state.pose.position += Vector<3>(0, 3, 4);
  state.pose.rotation = state.pose.rotation.turned({0.02, 0, 0});
  const MotionError error = motion_error(state, kTruth);
  EXPECT_DOUBLE_EQ(error.velocity, 0.25);
  EXPECT_DOUBLE_EQ(error.position, 5.0);
  EXPECT_NEAR(error.rotation, 0.02, 1e-14);
}

TEST(MotionError, ARotationIsTheSameForBothSignsOfItsQuaternion) {
  TrueMotion other = kTruth;
  other.orientation.coeffs() *= -1.0;
  EXPECT_LT(motion_error(true_state(), other).rotation, 1e-7);
}

TEST(ReportedErrors, AreNoneBetweenStepsAndBeyondRunOrTruth) {
  const auto truth = [](double t) { return t <= 2 ? std::optional(kTruth) : std::nullopt; };
  const ReportedErrors errors = reported_errors(run_of({0, 0.1 + 0.2, 2, 3}), 0, {0.3, 1, 2, 3, 4}, truth);
  EXPECT_TRUE(errors[0]) << "0.1 + 0.2 is 0.3 but for rounding";
  EXPECT_FALSE(errors[1]);
  EXPECT_TRUE(errors[2]);
  EXPECT_FALSE(errors[3]);
  EXPECT_FALSE(errors[4]);
  EXPECT_TRUE(std::isnan(largest_velocity_error(errors))) << "one is missing";
  EXPECT_EQ(largest_velocity_error({MotionError{.velocity = 1}, MotionError{.velocity = 3}}), 3.0);
}

TEST(ObservedOrder, IsTheExponentOfThePowerLaw) {
  EXPECT_DOUBLE_EQ(observed_order(0.4, 0.1, 0.2, 0.05), 1.0);
  EXPECT_NEAR(observed_order(3 * std::pow(0.05, 1.7), 0.05, 3 * std::pow(0.02, 1.7), 0.02), 1.7, 1e-12);
  EXPECT_LT(observed_order(0.1, 0.1, 0.2, 0.05), 0.0);
  EXPECT_TRUE(std::isnan(observed_order(0.1, 0.1, 0.0, 0.05)));
  EXPECT_TRUE(std::isnan(observed_order(0.0, 0.1, 0.1, 0.05)));
  EXPECT_TRUE(std::isnan(observed_order(0.1, 0.1, 0.1, 0.1)));
}

TEST(ErrorColumns, HoldWhatIsSet) {
  const std::vector<double> times = {0.5, 2};
  const std::vector<std::string> columns = error_columns(times);
  Record record(columns);
  const ReportedErrors fine = {MotionError{.velocity = 0.01}, MotionError{.velocity = 0.03}};
  const ReportedErrors coarse = {MotionError{.velocity = 0.02}, std::nullopt};
  set_errors(record, times, fine);
  set_orders(record, times, coarse, 0.2, fine, 0.1);
  const auto cell = [&](const std::string& name) {
    const auto at = std::find(columns.begin(), columns.end(), name);
    EXPECT_NE(at, columns.end()) << name;
    return record.row().at(static_cast<std::size_t>(at - columns.begin()));
  };
  EXPECT_EQ(cell("velocity_error_0.5s"), "0.01");
  EXPECT_EQ(cell("order_0.5s"), "1");
  EXPECT_EQ(cell("velocity_error_2s"), "0.03");
  EXPECT_EQ(cell("order_2s"), "") << "the coarse run has no error there";
  EXPECT_EQ(cell("largest_velocity_error"), "0.03");
  EXPECT_EQ(cell("largest_velocity_error_order"), "");
}

}  // namespace
}  // namespace touchstone::harness
