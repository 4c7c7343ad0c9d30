// Question: does a tippe top turn over, and keep Jellett's constant while it does?
// Success criterion: the implicit NCP solves every step, Eqs. 10-11 to 1e-10; spun about the vertical the top
// inverts past the horizontal, spun about its own tilted axis it never does; the relative drift of Jellett's
// constant falls in proportion to the step. Source: Jellett's constant -L.r, "A Treatise on the Theory of
// Friction" (1872), kept by any motion with one contact on a horizontal plane and no torsion; the two starts
// as in C. M. Gray and B. G. Nickel, "Constants of the motion for nonslipping tippe tops and other tops with
// round pegs", Am. J. Phys. 68 (2000): friction at the sliding contact raises the centre of mass, and where
// nothing slides there is no such torque. Expected: the axis goes from 0.1 rad to beyond 170 degrees in about
// 2 s, friction taking what the rise leaves of the spin's energy.

#include <algorithm>
#include <cmath>

#include "experiments/harness/variants.h"
#include "experiments/scenarios/tippe_top.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

const std::vector<std::string> kSummary = {
    "start_inclination_rad", "largest_inclination_rad", "end_inclination_rad", "horizontal_s",
    "jellett_kg_m2_s",       "largest_jellett_drift",   "jellett_drift_1s",    "center_rise_m"};
const std::vector<std::string> kHistory = {
    "t_s",     "inclination_rad", "spin_vertical_rad_s", "spin_axis_rad_s", "slip_m_s", "jellett_kg_m2_s",
    "total_J", "kinetic_J",       "friction_loss_J",     "energy_drift_J"};

TippeTop top_of(const std::string& variant) {
  TippeTop top;
  top.about_axis = variant == "axis";
  return top;
}

std::vector<Row> rows(const std::string& variant, const CaseRun<3>& run, Record& summary) {
  const TippeTop top = top_of(variant);
  const double constant = top.jellett(run.states.front().front());
  std::vector<Row> history;
  double steepest = 0;
  double drift = 0;
  double horizontal = -1;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const double t = run.samples[i].t_s;
    const BodyState<3>& state = run.states[i].front();
    const Vector<3> omega = state.velocity.tail<3>();
    const double inclination = top.inclination(state);
    const double jellett = top.jellett(state);
    Record row(kHistory);
    row.set("t_s", t).set("inclination_rad", inclination).set("spin_vertical_rad_s", omega.z());
    row.set("spin_axis_rad_s", omega.dot(state.pose.rotation.matrix().col(2)));
    row.set("slip_m_s", top.slip(state)).set("jellett_kg_m2_s", jellett);
    row.set("total_J", run.samples[i].energy.total()).set("kinetic_J", run.samples[i].energy.kinetic);
    row.set("friction_loss_J", run.accounts[i].friction_loss).set("energy_drift_J", run.accounts[i].drift);
    history.push_back(row.row());
    steepest = std::max(steepest, inclination);
    drift = std::max(drift, std::abs(jellett / constant - 1));
    if (horizontal < 0 && inclination > M_PI / 2) horizontal = t;
    if (t == 1.0) summary.set("jellett_drift_1s", std::abs(jellett / constant - 1));
  }
  summary.set("start_inclination_rad", top.inclination(run.states.front().front()));
  summary.set("largest_inclination_rad", steepest)
      .set("end_inclination_rad", top.inclination(run.end.front()));
  if (horizontal >= 0) summary.set("horizontal_s", horizontal);
  summary.set("jellett_kg_m2_s", constant).set("largest_jellett_drift", drift);
  summary.set("center_rise_m",
              run.end.front().pose.position.z() - run.states.front().front().pose.position.z());
  return history;
}

}  // namespace

int main(int argc, char** argv) {
  const VariantExperiment what = {
      .name = "tippe_top",
      .about = "Does a tippe top turn over, and keep Jellett's constant while it does?",
      .examples =
          "  tippe_top                                      what is committed\n"
          "  tippe_top --variants vertical --step-sizes 0.0001 --out /tmp/top\n",
      .variants = {"vertical", "axis"},
      .about_variants =
          "vertical: spun about the vertical, so that it slides; axis: about its own axis, so that it rolls",
      .steps = {"0.001", "0.0005", "0.00025", "0.000125"},
      .quick_steps = {"0.001", "0.0005"},
      .until = 4.0,
      .quick_until = 1.0,
      .summary = kSummary,
      .history = kHistory,
      .scene = [](const std::string& variant) { return tippe_top_scene(top_of(variant)); },
      .tabulate = rows};
  return run_variant_experiment(what, argc, argv);
}
