// Question: where the motion has a closed form, how far from it is each method, and how fast does it get
// closer as the step falls? Success criterion: the implicit NCP is of first order, seen from both sides, on
// every scenario that it can represent, in the plane and in space, and exact to rounding where the motion is
// at rest. Source: free fall, the bouncing ball, sliding that ends in rolling or in rest, rolling and sliding
// down an incline, spin and slip under the friction ellipsoid; the derivations stand in scenarios/truths.
// Expected: time-stepping is of first order in h wherever something moves. What a formulation does not model
// stays: a friction pyramid's direction, soft contacts' overlap, rounding in single precision.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/harness/record.h"
#include "experiments/scenarios/closed_forms.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr double kSampleEvery = 0.1;  // [s]
/// Below this a relative error is rounding and solver tolerance, and has no order.
constexpr double kRounding = 1e-9;

const std::vector<std::string> kErrorColumns = {"relative_error",
                                                "position_error_m",
                                                "orientation_error_rad",
                                                "velocity_error_m_s",
                                                "angular_velocity_error_rad_s",
                                                "largest_penetration_m",
                                                "largest_residual"};

std::vector<std::string> with(std::vector<std::string> columns, const std::vector<std::string>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}
const std::vector<std::string> kSummary = with({"observed_order", "orders_from"}, kErrorColumns);
const std::vector<std::string> kErrors = with({"step_s", "steps"}, kErrorColumns);

/// Against the closed form: poses at their worst over the samples, velocities at the horizon.
struct Errors {
  double position = 0.0;          // [m]
  double orientation = 0.0;       // [rad]
  double velocity = 0.0;          // [m/s]
  double angular_velocity = 0.0;  // [rad/s]
};

double angle_between(const PlanarRotation& a, const PlanarRotation& b) {
  return std::abs(a.angle() - b.angle());
}
double angle_between(const SpatialRotation& a, const SpatialRotation& b) {
  return a.quaternion().angularDistance(b.quaternion());
}

/// Largest of the errors, each over the size of its quantity in the scenario.
template <int Dim>
double relative(const Errors& errors, const ClosedFormScenario<Dim>& scenario) {
  const double of_pose = std::max(errors.position / scenario.length, errors.orientation / scenario.angle);
  const double of_velocity = std::max(errors.velocity, errors.angular_velocity) / scenario.speed;
  return std::max(of_pose, of_velocity);
}

template <int Dim>
class ErrorMeter {
 public:
  ErrorMeter(const ClosedFormScenario<Dim>& scenario, double until) : scenario_(scenario), until_(until) {}

  void see(double t, const BodyState<Dim>& found) {
    const bool last = t == until_;
    const double samples = t / kSampleEvery;
    if (!last && std::abs(samples - std::round(samples)) > 1e-9) return;
    const BodyState<Dim> truth = scenario_.body_at(t);
    raise(errors_.position, (found.pose.position - truth.pose.position).norm());
    if (scenario_.has_orientation)
      raise(errors_.orientation, angle_between(found.pose.rotation, truth.pose.rotation));
    if (!last) return;
    const Twist<Dim> miss = found.velocity - truth.velocity;
    errors_.velocity = miss.template head<Dim>().norm();
    errors_.angular_velocity = miss.template tail<Dimension<Dim>::angular>().norm();
  }
  [[nodiscard]] const Errors& errors() const { return errors_; }

 private:
  static void raise(double& largest, double value) { largest = std::max(largest, value); }

  const ClosedFormScenario<Dim>& scenario_;
  double until_;
  Errors errors_;
};

/// What one method did with one step size.
struct Attempt {
  double h = 0.0;
  bool finished = false;
  std::string reason;
  long steps = 0;
  Errors errors;
  double relative_error = 0.0;
  double penetration = 0.0;
  double residual = 0.0;
};

template <int Dim>
Attempt attempt(const ClosedFormScenario<Dim>& scenario, const MethodSpec& spec, double h, double until) {
  const auto method = find_method<Dim>(spec.key).make(scenario.scene, spec.options);
  ErrorMeter<Dim> meter(scenario, until);
  const CaseRun<Dim> run =
      run_case<Dim>(*method, {.h = h, .until = until, .samples = 1, .report = {}},
                    [&](double t, std::span<const BodyState<Dim>> state) { meter.see(t, state[0]); });
  Attempt made;
  made.h = h;
  made.finished = run.status == CaseStatus::ok;
  made.reason = run.reason;
  made.steps = run.steps;
  made.errors = meter.errors();
  made.relative_error = relative(meter.errors(), scenario);
  made.penetration = run.largest_penetration;
  made.residual = run.residual.largest();
  return made;
}

/// Slope of log(error) over log(h) by least squares over the attempts whose error is more than rounding.
/// @returns slope and number of attempts; NaN with fewer than three
std::pair<double, long> observed_order(const std::vector<Attempt>& attempts) {
  std::vector<std::pair<double, double>> points;
  for (const Attempt& one : attempts) {
    if (one.relative_error > kRounding) points.emplace_back(std::log(one.h), std::log(one.relative_error));
  }
  const auto count = static_cast<double>(points.size());
  if (count < 3) return {std::numeric_limits<double>::quiet_NaN(), static_cast<long>(points.size())};
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const auto& [x, y] : points) sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  return {(count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x),
          static_cast<long>(points.size())};
}

void set_errors(Record& record, const Attempt& one, bool has_orientation) {
  record.set("relative_error", one.relative_error).set("position_error_m", one.errors.position);
  if (has_orientation) record.set("orientation_error_rad", one.errors.orientation);
  record.set("velocity_error_m_s", one.errors.velocity)
      .set("angular_velocity_error_rad_s", one.errors.angular_velocity)
      .set("largest_penetration_m", one.penetration)
      .set("largest_residual", one.residual);
}

/// All step sizes of one method on one scenario, the last attempt being the finest.
template <int Dim>
CaseResult run_all(const ClosedFormScenario<Dim>& scenario, const MethodSpec& spec,
                   const std::vector<double>& steps, double until) {
  CaseResult result;
  std::vector<Attempt> attempts;
  std::vector<Row> rows;
  for (const double h : steps) {
    const Attempt one = attempt(scenario, spec, h, until);
    if (!one.finished) {
      return {CaseStatus::failed, "h = " + number_cell(h) + " s: " + one.reason, {{}, std::move(rows)}};
    }
    Record record(kErrors);
    record.set("step_s", h).set("steps", one.steps);
    set_errors(record, one, scenario.has_orientation);
    rows.push_back(record.row());
    attempts.push_back(one);
  }
  Record summary(kSummary);
  const auto [order, count] = observed_order(attempts);
  summary.set("observed_order", order).set("orders_from", count);
  set_errors(summary, attempts.back(), scenario.has_orientation);
  return {CaseStatus::ok, "", {{summary.row()}, std::move(rows)}};
}

template <int Dim>
bool has_method(const std::string& key) {
  const auto table = methods<Dim>();
  return std::any_of(table.begin(), table.end(), [&](const auto& entry) { return entry.key == key; });
}

bool selected(const Selection& selection, const std::string& axis, const std::string& value) {
  const std::vector<std::string>& wanted = selection.texts(axis);
  return std::find(wanted.begin(), wanted.end(), value) != wanted.end();
}

template <int Dim>
void add_cases(const Selection& selection, std::vector<Case>& cases) {
  if (!selected(selection, "dimensions", std::to_string(Dim))) return;
  std::vector<double> steps = selection.numbers("step-sizes");
  std::sort(steps.begin(), steps.end(), std::greater<>());
  double cost = 0;
  for (const double h : steps) cost += static_cast<double>(step_count(selection.until, h));
  for (auto& made : closed_form_scenarios<Dim>()) {
    if (!selected(selection, "scenarios", made.key)) continue;
    const auto scenario = std::make_shared<const ClosedFormScenario<Dim>>(std::move(made));
    for (const MethodSpec& method : selection.methods) {
      if (!has_method<Dim>(method.key)) continue;
      Case one;
      one.id = {
          scenario->key,         method.key,   format_options(options_in_force<Dim>(scenario->scene, method)),
          {std::to_string(Dim)}, steps.back(), selection.until};
      one.cost = cost * (method.key.starts_with("simbody") ? 20.0 : 1.0);  // as measured
      one.engine_version = find_method<Dim>(method.key).version();
      one.run = [=, until = selection.until] { return run_all<Dim>(*scenario, method, steps, until); };
      cases.push_back(std::move(one));
    }
  }
}

std::vector<Case> all_cases(const Selection& selection) {
  for (const MethodSpec& method : selection.methods) {
    if (!has_method<2>(method.key)) static_cast<void>(find_method<3>(method.key));  // throws if it is unknown
  }
  std::vector<Case> cases;
  add_cases<2>(selection, cases);
  add_cases<3>(selection, cases);
  return cases;
}

std::vector<std::string> all_methods() {
  std::vector<std::string> keys;
  for (const auto& entry : methods<2>()) keys.emplace_back(entry.key);
  for (const auto& entry : methods<3>()) {
    if (!has_method<2>(std::string(entry.key))) keys.emplace_back(entry.key);
  }
  return keys;
}

std::vector<std::string> all_scenarios() {
  std::vector<std::string> keys;
  for (const auto& one : closed_form_scenarios<3>()) keys.push_back(one.key);
  return keys;
}

CommandLineSpec command_line() {
  const std::vector<std::string> scenarios = all_scenarios();
  return {.name = "closed_forms",
          .about = "Where the motion has a closed form, how far from it is each method, and of what order?",
          .examples =
              "  closed_forms                                    what is committed\n"
              "  closed_forms --quick --out /tmp/quick           a first look\n"
              "  closed_forms --scenarios bounce --dimensions 2  one scenario in the plane\n"
              "  closed_forms --methods ode_step:erp=0.8         one method with another option\n",
          .methods = all_methods(),
          .axes = {{"scenarios", "which closed forms", AxisKind::text, scenarios, scenarios, 1, scenarios},
                   {"dimensions",
                    "2: in the plane, 3: in space",
                    AxisKind::text,
                    {"2", "3"},
                    {"2", "3"},
                    1,
                    {"2", "3"}},
                   {"step-sizes",
                    "step sizes h [s], all in one case",
                    AxisKind::positive,
                    {"0.02", "0.01", "0.005", "0.0025"},
                    {"0.02", "0.01", "0.005"}}},
          .until = 1.0,
          .quick_until = 1.0};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {.command_line = command_line(),
                                 .sweep_columns = {"dimension"},
                                 .tables = {{"summary", kSummary}, {"errors", kErrors}},
                                 .seed = std::nullopt,
                                 .cases = all_cases};
  return run_experiment(experiment, argc, argv);
}
