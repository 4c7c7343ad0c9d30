// Question: at which slope and friction does a box that is put on an incline stay, slide, tip over, or both?
// Success criterion: the implicit NCP, in space and in the plane, is on the right side of the thresholds in
// every cell of a map of slope, friction and aspect ratio, cells that lie 0.05 % beside a threshold included,
// after five steps and at the horizon; flat sliding has the closed form's acceleration to 1e-9 of g; Eqs.
// 10-11 hold to 1e-10 at every step. Source: the equations of plane motion at the release, solved in each
// mode (experiments/scenarios/truths/box_on_incline.h). Expected: the box touches flat on flat, where closest
// points are not unique, and the step's torque balance finds where the resultant acts; so one contact tells
// sliding from tipping. Methods with contacts at the corners do as well if their friction does not creep;
// soft contacts creep, so "stays" is where they are wrong.

#include <algorithm>
#include <cmath>

#include "experiments/harness/account_columns.h"
#include "experiments/harness/experiment.h"
#include "experiments/harness/method_case.h"
#include "experiments/scenarios/box_on_incline.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;
using Start = truth::BlockOnIncline::Start;

constexpr const char* kScenario = "box_on_incline";
constexpr long kReleaseSteps = 5;
/// Run in space and in the plane; every other method in space if it has it.
constexpr const char* kReference = "implicit_ncp";

const std::vector<std::string> kSummary =
    with_account({"truth_mode", "truth_slip_m_s2", "truth_tip_rad_s2", "release_mode", "release_right",
                  "release_slip_m_s2", "release_tip_rad_s2", "release_error", "end_mode", "end_right",
                  "end_slip_m_s", "end_tip_rad_s"});

template <int Dim>
bool has_method(const std::string& key) {
  const auto table = methods<Dim>();
  return std::any_of(table.begin(), table.end(), [&](const auto& entry) { return entry.key == key; });
}

/// Every method there is, by key.
std::vector<std::string> all_methods() {
  std::vector<std::string> keys;
  for (const auto& entry : methods<3>()) keys.emplace_back(entry.key);
  for (const auto& entry : methods<2>()) {
    if (!has_method<3>(std::string(entry.key))) keys.emplace_back(entry.key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Whether a box that tips slides too is a question of the release only: as it turns that changes.
Start without_slip_of_tipping(Start mode) { return mode == Start::tips_and_slides ? Start::tips : mode; }

void set_truth(Record& record, const truth::BlockRelease& truth) {
  record.set("truth_mode", to_string(truth.mode))
      .set("truth_slip_m_s2", truth.edge_along)
      .set("truth_tip_rad_s2", truth.angular);
}

/// Mean accelerations over the first steps, by how much of g they miss the truth's, and the side that they
/// tell.
void set_release(Record& record, const InclineCell& cell, const truth::BlockRelease& truth,
                 const InclineMotion& motion, double t) {
  const truth::BlockOnIncline block = cell.block();
  const Start mode = incline_mode(cell, motion, t);
  const double slip = motion.slip / t;
  const double tip = motion.tip / t;
  const double error = std::max(std::abs(slip - truth.edge_along),
                                std::abs(tip - truth.angular) * std::hypot(block.base, block.height) / 2) /
                       block.gravity;
  record.set("release_mode", to_string(mode)).set("release_right", mode == truth.mode ? 1 : 0);
  record.set("release_slip_m_s2", slip).set("release_tip_rad_s2", tip).set("release_error", error);
}

void set_end(Record& record, const InclineCell& cell, const truth::BlockRelease& truth,
             const InclineMotion& motion, double t) {
  const Start mode = without_slip_of_tipping(incline_mode(cell, motion, t));
  record.set("end_mode", to_string(mode))
      .set("end_right", mode == without_slip_of_tipping(truth.mode) ? 1 : 0);
  record.set("end_slip_m_s", motion.slip).set("end_tip_rad_s", motion.tip);
}

/// A case that did not get so far is not right there.
template <int Dim>
std::vector<std::vector<Row>> rows(const InclineCell& cell, const CaseRun<Dim>& run) {
  const truth::BlockRelease truth = truth::release(cell.block());
  Record record(kSummary);
  set_truth(record, truth);
  const auto motion_at = [&](std::size_t k) { return incline_motion(cell, run.states[k].front()); };
  record.set("release_right", 0).set("end_right", 0);
  if (run.steps >= kReleaseSteps) {
    set_release(record, cell, truth, motion_at(kReleaseSteps), run.samples[kReleaseSteps].t_s);
  }
  if (run.status == CaseStatus::ok) {
    set_end(record, cell, truth, motion_at(run.states.size() - 1), run.samples.back().t_s);
  }
  set_account(record, run);
  return {{record.row()}};
}

template <int Dim>
Case make_cell_case(const MethodSpec& method, const InclineCell& cell, double h, double until) {
  MethodCase<Dim> spec;
  spec.scenario = kScenario;
  spec.scene = std::make_shared<Scene<Dim>>(box_on_incline_scene<Dim>(cell));
  spec.method = method;
  spec.sweep = {Dim == 3 ? "space" : "plane",
                number_cell(cell.aspect),
                number_cell(cell.tangent),
                number_cell(cell.mu),
                cell.threshold,
                cell.threshold.empty() ? "" : number_cell(cell.offset)};
  const auto steps = static_cast<int>(step_count(until, h));
  spec.run = {.h = h, .until = until, .samples = steps, .states = true, .ledger = true};
  spec.tabulate = [cell](const CaseRun<Dim>& run) { return rows(cell, run); };
  return make_case(std::move(spec));
}

std::vector<Case> cases(const Selection& selection) {
  const InclineGrid grid = {selection.numbers("aspects"), selection.numbers("slopes"),
                            selection.numbers("frictions"), selection.numbers("offsets")};
  std::vector<Case> cases;
  for (const double h : selection.numbers("step-sizes")) {
    if (step_count(selection.until, h) < kReleaseSteps) {
      throw InputError("--until", selection.until, "at least five steps");
    }
    for (const MethodSpec& method : selection.methods) {
      const bool in_space = has_method<3>(method.key);
      for (const InclineCell& cell : incline_cells(grid)) {
        if (in_space) cases.push_back(make_cell_case<3>(method, cell, h, selection.until));
        if (!in_space || method.key == kReference) {
          cases.push_back(make_cell_case<2>(method, cell, h, selection.until));
        }
      }
    }
  }
  return cases;
}

CommandLineSpec command_line() {
  return {
      .name = "box_on_incline",
      .about = "At which slope and friction does a box on an incline stay, slide, tip over, or both?",
      .examples =
          "  box_on_incline                                 what is committed: every method there is\n"
          "  box_on_incline --quick --out /tmp/quick        a first look\n"
          "  box_on_incline --methods implicit_ncp --offsets 1e-4,1e-3 --out /tmp/close\n"
          "  box_on_incline --methods mujoco_elliptic --until 1 --out /tmp/later\n",
      .methods = all_methods(),
      .axes =
          {{"aspects", "length over height of the box", AxisKind::positive, {"0.4", "0.8", "1.2"}, {"0.8"}},
           {"slopes",
            "tangents of the slope's angle",
            AxisKind::positive,
            {"0.1", "0.3", "0.5", "0.9", "1.3", "1.7"},
            {"0.3", "1.3"}},
           {"frictions",
            "coefficients of friction",
            AxisKind::positive,
            {"0.15", "0.35", "0.55", "0.85", "1.25", "1.6"},
            {"0.15", "0.85", "1.25"}},
           {"offsets",
            "relative distances of the cells beside a threshold, on either side",
            AxisKind::positive,
            {"0.0005"},
            {"0.0005"}},
           {"step-sizes", "step sizes h [s]", AxisKind::positive, {"0.001"}, {"0.001"}}},
      .until = 0.06,
      .quick_until = 0.01};
}

}  // namespace

int main(int argc, char** argv) {
  const Experiment experiment = {.command_line = command_line(),
                                 .sweep_columns = {"space", "aspect", "tangent", "mu", "threshold", "offset"},
                                 .tables = {{"summary", kSummary}},
                                 .seed = std::nullopt,
                                 .cases = cases};
  return run_experiment(experiment, argc, argv);
}
