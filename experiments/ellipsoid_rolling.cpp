// Question: how near to the true motion does a step of h bring an ellipsoid that rolls without slip, on a
// plane and on another ellipsoid, where the gap has no closed form?
// Success criterion: against the nonholonomic ODE, integrated to 1e-11, the implicit NCP is of first order in
// h; its energy, which should stay, drifts by half as much at half the step; it neither slips nor penetrates,
// and solves Eqs. 10-11, to 1e-10 at every step. Source: after section V of Chakraborty, Berard, Akella and
// Trinkle, "An implicit time-stepping method for multibody systems with intermittent contact" (2007):
// "changing the a, b, c parameters would allow us to model ellipsoids rolling on ellipsoids". Expected: the
// control, which freezes the contact's geometry at the start of the step (stewart_trinkle), slips, and
// penetrates or hovers, at every motion. How far it is from the truth, in units of the NCP's error, depends
// on the motion, because to first order in h the energy of either changes by
//   E(t) - E(0) = -(h/2) int (A + B) dt   frozen,    -(h/2) int (A - B) dt   NCP,
//   A = m |a|^2 + tau . I^-1 tau - gamma . I^-1 gamma,  gamma = omega x I omega,  B = N psi''
// (N normal force, tau its moment and friction's, psi'' of the gap under constant nu; tests/oracle checks
// it). On a flat side, where the body would rock to and fro, B < 0: over a swing A + B cancels and A - B adds
// up; the frozen step is as symplectic Euler, the NCP as implicit Euler, which damps. On a sharp side, whose
// radius of curvature is less than the height of the centre, B > 0: with lambda the rate at which the body
// would fall off it, A - B is constant, on the way over it a small gain, and A + B grows as
// cosh(2 lambda t). Bodies left alone are mostly on their flat sides. In one that spins fast above its
// contact the frozen geometry is out of date.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "experiments/harness/account_columns.h"
#include "experiments/harness/contact_view.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/harness/motion_error.h"
#include "experiments/scenarios/ellipsoid_rolling.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr const char* kTruth = "rolling_ode";
constexpr const char* kReference = "implicit_ncp";  // what the other methods' errors are compared with
constexpr double kPathStep = 0.01;                  // [s]
constexpr int kPathSamples = 100;
const std::vector<double> kReportTimes = {0.5, 1, 1.5, 2};  // [s]

std::vector<std::string> summary_columns() {
  std::vector<std::string> columns = error_columns(kReportTimes);
  columns.insert(columns.end(), {"error_over_ncp", "relative_energy_drift", "relative_energy_drift_order",
                                 "drift_over_ncp", "largest_slip_m_s", "slip_over_ncp",
                                 "penetration_over_ncp", "largest_needed_friction", "steps_without_contact"});
  const std::vector<std::string> account = account_columns();
  columns.insert(columns.end(), account.begin(), account.end());
  return columns;
}

const std::vector<std::string> kSummary = summary_columns();
const std::vector<std::string> kPath = {"t_s",         "x_m",         "y_m",         "z_m",
                                        "contact_x_m", "contact_y_m", "contact_z_m", "total_J"};

// --- scenarios and their truths

struct Setting {
  std::string key;
  double mu = 1.0;  ///< more than the rolling needs
  truth::RollingEllipsoid rolling;
};

std::vector<Setting> settings() {
  return {{"ellipsoid_rolling", 1.0, ellipsoid_on_plane()},
          {"ellipsoid_spinning", 1.0, ellipsoid_spinning()},
          {"ellipsoid_over_its_end", 1.0, ellipsoid_over_its_end()},
          {"ellipsoid_on_ellipsoid", 0.8, ellipsoid_on_ellipsoid()}};
}

std::vector<std::string> scenario_keys() {
  std::vector<std::string> keys;
  for (const Setting& setting : settings()) keys.push_back(setting.key);
  return keys;
}

/// A scenario with its scene and its true motion at the times that a table may ask for.
class Scenario {
 public:
  Scenario(const Setting& setting, double until)
      : key(setting.key), scene(std::make_shared<Scene<3>>(ellipsoid_scene(setting.rolling, setting.mu))) {
    std::vector<double> times;
    for (const double t : kReportTimes) {
      if (t <= until) times.push_back(t);
    }
    for (int k = 0; k <= kPathSamples; ++k) times.push_back(until * k / kPathSamples);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    samples_ = truth::roll_ellipsoid(setting.rolling, times).samples;
  }

  std::string key;
  std::shared_ptr<const Scene<3>> scene;

  [[nodiscard]] std::optional<TrueMotion> at(double t) const {
    for (const truth::EllipsoidSample& s : samples_) {
      if (s.t == t) return TrueMotion{s.position, s.velocity, s.omega, s.orientation};
    }
    return std::nullopt;
  }
  [[nodiscard]] const std::vector<truth::EllipsoidSample>& samples() const { return samples_; }

 private:
  std::vector<truth::EllipsoidSample> samples_;
};

// --- what is measured

/// What is read off the contact over all steps.
struct ContactMeasures {
  double slip = 0.0;             ///< largest [m/s]
  double needed_friction = 0.0;  ///< largest
  int steps_without = 0;
};

/// Of one run, all that is compared with other runs.
struct Measures {
  ReportedErrors errors;
  double drift = 0.0;  ///< largest |E(t) - E(0)| over all steps, over the initial kinetic energy
  ContactMeasures contact;
  double penetration = 0.0;  ///< largest over all steps [m]
};

/// The contact at the end of a step; bodies are in the scene's order.
std::optional<ContactView> contact_of(const Scenario& scenario, const KeptStep<3>& step) {
  return strongest_contact(*scenario.scene, step.state, step.contacts, 0, 1);
}

ContactMeasures contact_measures(const CaseRun<3>& run, const Scenario& scenario) {
  ContactMeasures found;
  for (std::size_t k = 1; k < run.kept.size(); ++k) {
    const auto contact = contact_of(scenario, run.kept[k]);
    if (!contact) {
      ++found.steps_without;
      continue;
    }
    found.slip = std::max(found.slip, contact->slip);
    found.needed_friction =
        std::max(found.needed_friction, contact->tangential_impulse.norm() / contact->normal_impulse);
  }
  return found;
}

Measures measures(const CaseRun<3>& run, const Scenario& scenario) {
  const auto motion = [&scenario](double t) { return scenario.at(t); };
  const int body = scenario.scene->body("ellipsoid");
  return {reported_errors(run, body, kReportTimes, motion), run.largest_drift_J / run.initial.kinetic,
          contact_measures(run, scenario), run.largest_penetration};
}

/// `value` over what the reference has of it, both of numbers about 1; a reference that is 0 is not better
/// than these are rounded.
double over(double value, double reference) {
  return value / std::max(reference, std::numeric_limits<double>::epsilon());
}

/// The factors by which the run is worse than the reference.
void set_factors(Record& record, const Measures& found, const Measures& reference) {
  record
      .set("error_over_ncp", largest_velocity_error(found.errors) / largest_velocity_error(reference.errors))
      .set("drift_over_ncp", found.drift / reference.drift)
      .set("slip_over_ncp", over(found.contact.slip, reference.contact.slip))
      .set("penetration_over_ncp", over(found.penetration, reference.penetration));
}

// --- rows

std::vector<Row> path_rows(const CaseRun<3>& run, const Scenario& scenario) {
  const std::size_t every = std::max<std::size_t>(1, (run.kept.size() - 1) / kPathSamples);
  const Judge<3> judge(*scenario.scene);
  std::vector<Row> rows;
  for (std::size_t k = 0; k < run.kept.size(); k += every) {
    const KeptStep<3>& step = run.kept[k];
    Row row = {number_cell(step.t_s)};
    for (const double x : step.state[0].pose.position) row.push_back(number_cell(x));
    const auto contact = contact_of(scenario, step);
    for (int i = 0; i < 3; ++i) row.push_back(contact ? number_cell(contact->point[i]) : "");
    row.push_back(number_cell(judge.energy(step.state).total()));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Row> path_rows(const std::vector<truth::EllipsoidSample>& samples) {
  std::vector<Row> rows;
  for (const truth::EllipsoidSample& s : samples) {
    Row row = {number_cell(s.t)};
    for (const double x : s.position) row.push_back(number_cell(x));
    for (const double x : s.contact_point) row.push_back(number_cell(x));
    row.push_back(number_cell(s.energy));
    rows.push_back(std::move(row));
  }
  return rows;
}

Case truth_case(const MethodSpec& method, std::shared_ptr<const Scenario> scenario, double until) {
  if (!method.options.empty())
    throw InputError("--methods", "'" + format_method(method) + "'", "no options: it is a truth");
  Case one;
  one.id = {scenario->key, kTruth, "", {}, std::numeric_limits<double>::quiet_NaN(), until};
  one.run = [scenario] {
    double friction = 0.0;
    double drift = 0.0;
    const auto& samples = scenario->samples();
    for (const truth::EllipsoidSample& s : samples) {
      friction = std::max(friction, s.needed_friction());
      drift = std::max(drift, std::abs(s.energy - samples.front().energy));
    }
    Record summary(kSummary);
    const Judge<3> judge(*scenario->scene);
    const double kinetic = judge.energy(initial_state(*scenario->scene)).kinetic;
    summary.set("relative_energy_drift", drift / kinetic).set("largest_needed_friction", friction);
    return CaseResult{CaseStatus::ok, "", {{summary.row()}, path_rows(samples)}};
  };
  return one;
}

// --- cases

/// What is run: a method with its options in one scenario with one step.
struct Point {
  MethodSpec method;
  std::shared_ptr<const Scenario> scenario;
  double h = 0.0;
  double until = 0.0;
  std::optional<double> coarser;  ///< the next larger step of the sweep, which orders are measured against
};

Measures beside(const Point& point, const MethodSpec& method, double h) {
  return measures(run_beside(*point.scenario->scene, method, h, point.until), *point.scenario);
}

std::vector<std::vector<Row>> method_rows(const CaseRun<3>& run, const Point& point) {
  const Measures found = measures(run, *point.scenario);
  Record summary(kSummary);
  set_errors(summary, kReportTimes, found.errors);
  summary.set("relative_energy_drift", found.drift);
  if (point.coarser) {
    const Measures coarse = beside(point, point.method, *point.coarser);
    set_orders(summary, kReportTimes, coarse.errors, *point.coarser, found.errors, point.h);
    summary.set("relative_energy_drift_order",
                observed_order(coarse.drift, *point.coarser, found.drift, point.h));
  }
  if (point.method.key != kReference) set_factors(summary, found, beside(point, {kReference, {}}, point.h));
  summary.set("largest_slip_m_s", found.contact.slip)
      .set("largest_needed_friction", found.contact.needed_friction)
      .set("steps_without_contact", found.contact.steps_without);
  set_account(summary, run);
  if (point.h != kPathStep) return {{summary.row()}, {}};
  return {{summary.row()}, path_rows(run, *point.scenario)};
}

Case method_case(const Point& point) {
  MethodCase<3> spec;
  spec.scenario = point.scenario->key;
  spec.scene = point.scenario->scene;
  spec.method = point.method;
  spec.run = {.h = point.h, .until = point.until, .report = {}, .keep_steps = true};
  spec.tabulate = [point](const CaseRun<3>& run) { return method_rows(run, point); };
  return make_case(std::move(spec));
}

std::vector<Case> cases(const Selection& selection) {
  std::vector<double> steps = selection.numbers("step-sizes");
  std::sort(steps.begin(), steps.end());
  const std::vector<std::string>& wanted = selection.texts("scenarios");
  std::vector<Case> cases;
  for (const Setting& setting : settings()) {
    if (std::find(wanted.begin(), wanted.end(), setting.key) == wanted.end()) continue;
    const auto scenario = std::make_shared<const Scenario>(setting, selection.until);
    for (const MethodSpec& method : selection.methods) {
      if (method.key == kTruth) {
        cases.push_back(truth_case(method, scenario, selection.until));
        continue;
      }
      for (std::size_t i = 0; i < steps.size(); ++i) {
        Point point{method, scenario, steps[i], selection.until, std::nullopt};
        if (i + 1 < steps.size()) point.coarser = steps[i + 1];
        cases.push_back(method_case(point));
      }
    }
  }
  return cases;
}

CommandLineSpec command_line() {
  return {.name = "ellipsoid_rolling",
          .about = "How near to the true motion is an ellipsoid that rolls with a step of h?",
          .examples =
              "  ellipsoid_rolling                              what is committed\n"
              "  ellipsoid_rolling --scenarios ellipsoid_rolling --step-sizes 0.02,0.01 --out /tmp/roll\n",
          .methods = {"implicit_ncp", "implicit_ncp_extrapolated", "stewart_trinkle", kTruth},
          .axes = {{"step-sizes",
                    "step sizes h [s]; paths are kept at 0.01",
                    AxisKind::positive,
                    {"0.05", "0.02", "0.01", "0.005", "0.002", "0.001", "0.0005"},
                    {"0.02", "0.01"}},
                   {"scenarios", "which scenarios: on a plane, but for ellipsoid_on_ellipsoid",
                    AxisKind::text, scenario_keys(), scenario_keys(), 1, scenario_keys()}},
          .until = 2.0,
          .quick_until = 2.0};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {.command_line = command_line(),
                                 .sweep_columns = {},
                                 .tables = {{"summary", kSummary}, {"path", kPath}},
                                 .seed = std::nullopt,
                                 .cases = cases};
  return run_experiment(experiment, argc, argv);
}
