// Question: does a rattleback turn back when it is spun in one sense, and not when it is spun in the other?
// Success criterion: the implicit NCP solves every step, Eqs. 10-11 to 1e-10; spun clockwise it reverses once
// within the horizon and spun counter-clockwise never, at every step size, as the rolling body does; the time
// of the reversal tends to the rolling body's in proportion to the step. Source: the nonholonomic ODE of
// rolling without slip, integrated to 1e-13 (experiments/scenarios/truths/ellipsoid_rolling.h); shape and
// mass of T. R. Kane and D. A. Levinson, "Realistic mathematical modeling of the rattleback" (1982).
// Expected: the energy of the truth is constant; a step takes some of it out of the rocking, so the spin
// after the reversal is less than the truth's and grows towards it as h falls.

#include <algorithm>
#include <cmath>

#include "experiments/harness/variants.h"
#include "experiments/scenarios/rattleback.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr int kSamples = 2000;  // the rocking takes about 0.1 s

const std::vector<std::string> kSummary = {"start_spin_rad_s", "end_spin_rad_s",       "reversals",
                                           "reversal_s",       "truth_reversals",      "truth_reversal_s",
                                           "reversal_error_s", "truth_end_spin_rad_s", "truth_needed_mu"};
const std::vector<std::string> kHistory = {
    "t_s", "spin_rad_s", "roll_rad_s", "pitch_rad_s", "truth_spin_rad_s", "total_J", "energy_drift_J"};

Rattleback back_of(const std::string& variant) {
  Rattleback back;
  back.spin = std::copysign(back.spin, variant == "clockwise" ? -1.0 : 1.0);
  return back;
}

struct Truth {
  std::vector<double> spins;
  Reversals reversals;
  double needed_mu = 0;
};

Truth truth_at(const Rattleback& back, const std::vector<double>& times) {
  Truth truth;
  const truth::EllipsoidResult rolled = truth::roll_ellipsoid(back.rolling(), times, 1e-13);
  for (const truth::EllipsoidSample& sample : rolled.samples) {
    truth.spins.push_back(sample.omega.z());
    truth.needed_mu = std::max(truth.needed_mu, sample.needed_friction());
  }
  if (rolled.status == truth::EllipsoidStatus::completed) {
    truth.reversals = count_reversals(times, truth.spins);
  } else {
    truth.reversals.count = -1;  // no gate takes this for a truth
  }
  return truth;
}

void set_reversals(Record& record, const Reversals& mine, const Truth& truth) {
  record.set("reversals", mine.count).set("truth_reversals", truth.reversals.count);
  if (mine.first >= 0) record.set("reversal_s", mine.first);
  if (truth.reversals.first >= 0) record.set("truth_reversal_s", truth.reversals.first);
  if (mine.first >= 0 && truth.reversals.first >= 0) {
    record.set("reversal_error_s", std::abs(mine.first - truth.reversals.first));
  }
  record.set("truth_needed_mu", truth.needed_mu);
}

std::vector<Row> rows(const std::string& variant, const CaseRun<3>& run, Record& summary) {
  std::vector<double> times;
  std::vector<double> spins;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    times.push_back(run.samples[i].t_s);
    spins.push_back(run.states[i].front().velocity[5]);
  }
  const Truth truth = truth_at(back_of(variant), times);
  std::vector<Row> history;
  for (std::size_t i = 0; i < times.size(); i += 2) {
    const BodyState<3>& state = run.states[i].front();
    const Vector<3> omega_body = state.pose.rotation.matrix().transpose() * state.velocity.tail<3>();
    Record row(kHistory);
    row.set("t_s", times[i]).set("spin_rad_s", spins[i]);
    row.set("roll_rad_s", omega_body.x()).set("pitch_rad_s", omega_body.y());
    if (i < truth.spins.size()) row.set("truth_spin_rad_s", truth.spins[i]);
    row.set("total_J", run.samples[i].energy.total()).set("energy_drift_J", run.accounts[i].drift);
    history.push_back(row.row());
  }
  summary.set("start_spin_rad_s", spins.front()).set("end_spin_rad_s", spins.back());
  set_reversals(summary, count_reversals(times, spins), truth);
  if (truth.spins.size() == times.size()) summary.set("truth_end_spin_rad_s", truth.spins.back());
  return history;
}

}  // namespace

int main(int argc, char** argv) {
  const VariantExperiment what = {
      .name = "rattleback",
      .about = "Does a rattleback turn back when it is spun in one sense, and not in the other?",
      .examples =
          "  rattleback                                     what is committed\n"
          "  rattleback --variants clockwise --step-sizes 1e-5 --out /tmp/back\n",
      .variants = {"clockwise", "counterclockwise"},
      .about_variants = "the sense in which it is spun, seen from above",
      .steps = {"0.0002", "0.0001", "0.00005", "0.000025"},
      .quick_steps = {"0.0005", "0.00025"},
      .until = 5.0,
      .quick_until = 0.5,
      .samples = kSamples,
      .summary = kSummary,
      .history = kHistory,
      .scene = [](const std::string& variant) { return rattleback_scene(back_of(variant)); },
      .tabulate = rows};
  return run_variant_experiment(what, argc, argv);
}
