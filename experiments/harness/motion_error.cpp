#include "experiments/harness/motion_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone::harness {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string at_time(const std::string& quantity, double t, const std::string& unit) {
  return quantity + "_" + number_cell(t) + "s" + unit;
}

double velocity_of(const std::optional<MotionError>& error) { return error ? error->velocity : kNone; }

}  // namespace

MotionError motion_error(const BodyState<3>& state, const TrueMotion& truth) {
  Twist<3> velocity;
  velocity << truth.velocity, truth.omega;
  const Eigen::Quaterniond left = truth.orientation.conjugate() * state.pose.rotation.quaternion();
  return {(state.velocity - velocity).cwiseAbs().maxCoeff(), (state.pose.position - truth.position).norm(),
          2.0 * std::asin(std::min(1.0, left.vec().norm()))};
}

ReportedErrors reported_errors(const CaseRun<3>& run, int body, const std::vector<double>& times,
                               const MotionTruth& truth) {
  constexpr double kSameTime = 1e-9;  // [s]; both are decimals rounded to doubles
  ReportedErrors errors(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto step = std::find_if(run.kept.begin(), run.kept.end(), [&](const KeptStep<3>& kept) {
      return std::abs(kept.t_s - times[i]) <= kSameTime;
    });
    const std::optional<TrueMotion> motion = truth(times[i]);
    if (step == run.kept.end() || !motion) continue;
    errors[i] = motion_error(step->state[static_cast<std::size_t>(body)], *motion);
  }
  return errors;
}

double largest_velocity_error(const ReportedErrors& errors) {
  double largest = 0.0;
  for (const auto& error : errors) {
    if (!error) return kNone;
    largest = std::max(largest, error->velocity);
  }
  return largest;
}

double observed_order(double coarse_error, double coarse_h, double error, double h) {
  const double order = std::log(coarse_error / error) / std::log(coarse_h / h);
  return std::isfinite(order) ? order : kNone;
}

std::vector<std::string> error_columns(const std::vector<double>& times) {
  std::vector<std::string> columns;
  for (const double t : times) {
    for (const std::string& column :
         {at_time("velocity_error", t, ""), at_time("order", t, ""), at_time("position_error", t, "_m"),
          at_time("rotation_error", t, "_rad")}) {
      columns.push_back(column);
    }
  }
  columns.insert(columns.end(), {"largest_velocity_error", "largest_velocity_error_order"});
  return columns;
}

void set_errors(Record& record, const std::vector<double>& times, const ReportedErrors& errors) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!errors[i]) continue;
    record.set(at_time("velocity_error", times[i], ""), errors[i]->velocity)
        .set(at_time("position_error", times[i], "_m"), errors[i]->position)
        .set(at_time("rotation_error", times[i], "_rad"), errors[i]->rotation);
  }
  record.set("largest_velocity_error", largest_velocity_error(errors));
}

void set_orders(Record& record, const std::vector<double>& times, const ReportedErrors& coarse,
                double coarse_h, const ReportedErrors& errors, double h) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    record.set(at_time("order", times[i], ""),
               observed_order(velocity_of(coarse[i]), coarse_h, velocity_of(errors[i]), h));
  }
  record.set("largest_velocity_error_order",
             observed_order(largest_velocity_error(coarse), coarse_h, largest_velocity_error(errors), h));
}

}  // namespace touchstone::harness
