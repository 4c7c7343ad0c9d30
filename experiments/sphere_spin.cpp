// Question: does torsional friction stop a sphere that spins in place when and as it should?
// Success criterion: a method with the paper's law gives the scheme's own recursion to 1e-12 at every step
// size: the spin falls by mu m g e_r h / I a step, the step that would pass zero ends at exactly 0 with just
// the moment that this takes, and nothing else ever moves. Source: Example 2, Figs. 3 and 4 of Chakraborty,
// Berard, Akella and Trinkle, "An implicit time-stepping method for multibody systems with intermittent
// contact" (2007), h = 0.07 s. Expected: the spin is 1.962 (1 - t) rad/s and ends at t = 1 s; with h = 0.07 s
// that is at 1.05 s, and the moment of the last step is 0.02/0.07 of mu m g e_r, because the sphere brakes
// from 0.98 s to 1 s only. Engines with torsional friction are compared with the same numbers.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "experiments/harness/account_columns.h"
#include "experiments/harness/contact_view.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/scenarios/sphere_spin.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr const char* kScenario = "sphere_spin";
constexpr std::array kTrajectorySteps = {0.07, 0.01};  // [s]; the paper's, and one for the eye
constexpr double kSpins = 1e-6;                        // a spin below it counts as none [rad/s]
const truth::SpinningSphere kSphere;

/// The spin about the vertical at the end of a step and the moment that acted in it.
struct SpinRow {
  double t = 0.0;                            ///< [s]
  Vector<3> velocity = Vector<3>::Zero();    ///< [m/s]
  Vector<3> omega = Vector<3>::Zero();       ///< [rad/s]
  double normal = 0.0;                       ///< [N]
  Vector<3> tangential = Vector<3>::Zero();  ///< [N]
  double torsion = 0.0;                      ///< about the vertical [N m]
};
using Spins = std::vector<SpinRow>;

std::vector<std::string> summary_columns() {
  std::vector<std::string> columns = {"stop_s",
                                      "stopping_moment_Nm",
                                      "largest_spin_error_rad_s",
                                      "largest_discrete_spin_error_rad_s",
                                      "largest_discrete_torsion_error_Nms",
                                      "largest_other_velocity"};
  const std::vector<std::string> account = account_columns();
  columns.insert(columns.end(), account.begin(), account.end());
  return columns;
}

const std::vector<std::string> kSummary = summary_columns();
const std::vector<std::string> kTrajectory = {"t_s",         "vx_m_s",      "vy_m_s",    "vz_m_s",
                                              "wx_rad_s",    "wy_rad_s",    "wz_rad_s",  "normal_N",
                                              "tangent_x_N", "tangent_y_N", "torsion_Nm"};

// --- what is measured

Spins spins_of(const CaseRun<3>& run, const Scene<3>& scene, double h) {
  const int ball = scene.body("ball");
  const int ground = scene.body("ground");
  Spins spins;
  for (const KeptStep<3>& step : run.kept) {
    const Twist<3>& nu = step.state[static_cast<std::size_t>(ball)].velocity;
    SpinRow row{.t = step.t_s, .velocity = nu.head<3>(), .omega = nu.tail<3>()};
    if (const auto contact = strongest_contact(scene, step.state, step.contacts, ball, ground)) {
      row.normal = contact->normal_impulse / h;
      row.tangential = contact->tangential_impulse / h;
      row.torsion = contact->torsional_impulse / h * contact->normal.z();
    }
    spins.push_back(row);
  }
  return spins;
}

/// The scheme's own recursion, row k being after step k.
Spins discrete_spins(double h, double until) {
  Spins spins(1);
  spins[0].omega.z() = kSphere.omega;
  const long steps = step_count(until, h);
  for (int k = 1; k <= steps; ++k) {
    const truth::SpinStep step = truth::spin_after_steps(kSphere, h, k);
    SpinRow row{.t = until * k / static_cast<double>(steps), .normal = kSphere.mass * kSphere.gravity};
    row.omega.z() = step.omega;
    row.torsion = step.moment;
    spins.push_back(row);
  }
  return spins;
}

/// The continuous motion at the ends of the steps.
Spins smooth_spins(double h, double until) {
  Spins spins = discrete_spins(h, until);
  for (SpinRow& row : spins) {
    row.omega.z() = truth::spin_at(kSphere, row.t);
    row.torsion = row.t < kSphere.stop_time() ? -std::copysign(kSphere.full_moment(), kSphere.omega) : 0.0;
  }
  return spins;
}

/// The first time from which on it does not spin, and the moment of the step that ends there, if it is told.
void set_stop(Record& record, const Spins& spins) {
  const auto still_spins = [](const SpinRow& row) { return std::abs(row.omega.z()) > kSpins; };
  const auto last = std::find_if(spins.rbegin(), spins.rend(), still_spins);
  if (last == spins.rbegin()) return;
  record.set("stop_s", last.base()->t);
  if (last.base()->torsion != 0.0) record.set("stopping_moment_Nm", last.base()->torsion);
}

/// @param spins  of a run, which may have ended early
void set_errors(Record& record, const Spins& spins, double h, double until) {
  const Spins discrete = discrete_spins(h, until);
  const Spins smooth = smooth_spins(h, until);
  double spin = 0.0;
  double discrete_spin = 0.0;
  double torsion = 0.0;  // impulse, which is what a step solves for [N m s]
  double other = 0.0;
  bool tells_torsion = false;
  for (std::size_t k = 0; k < spins.size(); ++k) {
    const SpinRow& row = spins[k];
    spin = std::max(spin, std::abs(row.omega.z() - smooth[k].omega.z()));
    discrete_spin = std::max(discrete_spin, std::abs(row.omega.z() - discrete[k].omega.z()));
    torsion = std::max(torsion, h * std::abs(row.torsion - discrete[k].torsion));
    other = std::max({other, row.velocity.cwiseAbs().maxCoeff(), row.omega.head<2>().cwiseAbs().maxCoeff()});
    tells_torsion = tells_torsion || row.torsion != 0.0;
  }
  record.set("largest_spin_error_rad_s", spin)
      .set("largest_discrete_spin_error_rad_s", discrete_spin)
      .set("largest_other_velocity", other);
  if (tells_torsion) record.set("largest_discrete_torsion_error_Nms", torsion);
}

// --- rows

std::vector<Row> trajectory_rows(const Spins& spins, double h) {
  if (std::find(kTrajectorySteps.begin(), kTrajectorySteps.end(), h) == kTrajectorySteps.end()) return {};
  std::vector<Row> rows;
  for (const SpinRow& spin : spins) {
    Row row = {number_cell(spin.t)};
    for (const double v : spin.velocity) row.push_back(number_cell(v));
    for (const double w : spin.omega) row.push_back(number_cell(w));
    for (const double force : {spin.normal, spin.tangential.x(), spin.tangential.y(), spin.torsion}) {
      row.push_back(number_cell(force));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Record measured(const Spins& spins, double h, double until) {
  Record summary(kSummary);
  set_stop(summary, spins);
  set_errors(summary, spins, h, until);
  return summary;
}

std::vector<std::vector<Row>> method_rows(const CaseRun<3>& run, const Scene<3>& scene, double h,
                                          double until) {
  const Spins spins = spins_of(run, scene, h);
  Record summary = measured(spins, h, until);
  set_account(summary, run);
  return {{summary.row()}, trajectory_rows(spins, h)};
}

// --- cases

using SpinTruth = Spins (*)(double h, double until);

/// The truth that stands under `key` in --methods; null if that is none.
SpinTruth spin_truth(const std::string& key) {
  if (key == "closed_form") return smooth_spins;
  if (key == "discrete_form") return discrete_spins;
  return nullptr;
}

Case truth_case(const MethodSpec& method, SpinTruth truth, double h, double until) {
  if (!method.options.empty())
    throw InputError("--methods", "'" + format_method(method) + "'", "no options: it is a truth");
  static_cast<void>(step_count(until, h));  // refuses before any work
  Case one;
  one.id = {kScenario, method.key, "", {}, h, until};
  one.run = [truth, h, until] {
    const Spins spins = truth(h, until);
    return CaseResult{CaseStatus::ok, "", {{measured(spins, h, until).row()}, trajectory_rows(spins, h)}};
  };
  return one;
}

std::vector<Case> cases(const Selection& selection) {
  const auto scene = std::make_shared<const Scene<3>>(sphere_spin_scene(kSphere));
  std::vector<Case> cases;
  for (const MethodSpec& method : selection.methods) {
    for (const double h : selection.numbers("step-sizes")) {
      if (const SpinTruth truth = spin_truth(method.key)) {
        cases.push_back(truth_case(method, truth, h, selection.until));
        continue;
      }
      MethodCase<3> spec;
      spec.scenario = kScenario;
      spec.scene = scene;
      spec.method = method;
      spec.run = {.h = h, .until = selection.until, .keep_steps = true};
      spec.tabulate = [scene, h, until = selection.until](const CaseRun<3>& run) {
        return method_rows(run, *scene, h, until);
      };
      cases.push_back(make_case(std::move(spec)));
    }
  }
  return cases;
}

std::vector<std::string> default_methods() {
  std::vector<std::string> keys = method_keys<3>();
  keys.insert(keys.end(), {"closed_form", "discrete_form"});
  return keys;
}

CommandLineSpec command_line() {
  return {.name = "sphere_spin",
          .about = "Does torsional friction stop a spinning sphere when and as it should? (Figs. 3 and 4)",
          .examples =
              "  sphere_spin                                    what is committed, every method there is\n"
              "  sphere_spin --methods implicit_ncp,closed_form --step-sizes 0.07 --out /tmp/spin\n",
          .methods = default_methods(),
          .axes = {{"step-sizes",
                    "step sizes h [s]; trajectories are kept at 0.07 and 0.01",
                    AxisKind::positive,
                    {"0.1", "0.07", "0.05", "0.02", "0.01", "0.005", "0.002", "0.001"},
                    {"0.1", "0.07", "0.01"}}},
          .until = 1.4,
          .quick_until = 1.4};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {.command_line = command_line(),
                                 .sweep_columns = {},
                                 .tables = {{"summary", kSummary}, {"trajectory", kTrajectory}},
                                 .seed = std::nullopt,
                                 .cases = cases};
  return run_experiment(experiment, argc, argv);
}
