#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/scene.h"
#include "experiments/harness/record.h"
#include "experiments/harness/run_case.h"

/// How far a body is from where a truth has it, at the times that an experiment reports, and at which order
/// in the step that falls.
namespace touchstone::harness {

/// A body in space as a truth gives it, world frame.
struct TrueMotion {
  Vector<3> position, velocity, omega;
  Eigen::Quaterniond orientation;
};
/// None where the truth does not reach. @param t  [s]
using MotionTruth = std::function<std::optional<TrueMotion>(double t)>;

struct MotionError {
  double velocity = 0.0;  ///< the largest of the six components' errors [m/s, rad/s]
  double position = 0.0;  ///< [m]
  double rotation = 0.0;  ///< angle of the turn that is left over [rad]
};
MotionError motion_error(const BodyState<3>& state, const TrueMotion& truth);

/// One entry a report time; none beyond the run or the truth, or between two steps.
using ReportedErrors = std::vector<std::optional<MotionError>>;

/// @param run   with kept steps
/// @param body  index in the scene
ReportedErrors reported_errors(const CaseRun<3>& run, int body, const std::vector<double>& times,
                               const MotionTruth& truth);

/// The largest velocity error of the report times; NaN if one of them has none.
double largest_velocity_error(const ReportedErrors& errors);

/// p of an error that goes as h^p; NaN where it cannot be told: an error is 0 or NaN, or the steps are equal.
double observed_order(double coarse_error, double coarse_h, double error, double h);

/// Columns of the errors for each report time T: velocity_error_Ts, order_Ts, position_error_Ts_m,
/// rotation_error_Ts_rad; and over all of them largest_velocity_error and its order,
/// largest_velocity_error_order.
std::vector<std::string> error_columns(const std::vector<double>& times);
void set_errors(Record& record, const std::vector<double>& times, const ReportedErrors& errors);
/// @param coarse  errors of a run with the step coarse_h [s]
void set_orders(Record& record, const std::vector<double>& times, const ReportedErrors& coarse,
                double coarse_h, const ReportedErrors& errors, double h);

}  // namespace touchstone::harness
