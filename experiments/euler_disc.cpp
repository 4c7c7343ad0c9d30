// Question: does a coin that rolls on its rim with its centre at rest keep to the closed form of that motion?
// Success criterion: the implicit NCP solves every step, Eqs. 10-11 to 1e-10; energy never rises; the drift
// of energy and the errors of inclination and precession fall in proportion to the step. Source: the steady
// motion Omega^2 (I1 sin cos - I3 sin^2 d/a) = m g (a cos - d sin) of
// experiments/scenarios/truths/gyroscopes.h; for a thin disc Omega^2 sin(alpha) = 4 g / a, as H. K. Moffatt,
// "Euler's disk and its finite-time singularity", Nature 404 (2000), has it. Expected: nothing takes energy
// from the coin, so it rolls for ever; a step takes some, in proportion to h, and the coin sinks through
// steady motions, faster and faster round, as a real one does. Torsion (variant `torsion`) takes energy too,
// until the coin no longer turns about its contact; then it rolls on, off the steady motion and round a
// circle.

#include <algorithm>
#include <cmath>

#include "experiments/harness/variants.h"
#include "experiments/scenarios/euler_disc.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;

constexpr double kTorsion = 0.05;    // e_r of the variant `torsion` [m]
constexpr double kFlat = 0.0174533;  // 1 degree [rad]: below it the precession is too fast for the step

const std::vector<std::string> kSummary = {
    "inclination_1s_rad",   "inclination_error_1s_rad", "precession_1s_rad_s", "precession_error_1s",
    "end_inclination_rad",  "end_precession_rad_s",     "largest_off_steady",  "flat_s",
    "largest_energy_rise_J"};
const std::vector<std::string> kHistory = {"t_s",
                                           "inclination_rad",
                                           "precession_rad_s",
                                           "steady_precession_rad_s",
                                           "contact_spin_rad_s",
                                           "center_speed_m_s",
                                           "total_J",
                                           "friction_loss_J",
                                           "impact_loss_J",
                                           "energy_drift_J"};

EulerDiscScene scene_of(const std::string& variant) {
  EulerDiscScene scene;
  if (variant == "torsion") scene.torsion = kTorsion;
  return scene;
}

/// Nearly flat the rates lose their meaning: the coin rests.
bool rolls(const EulerDiscMotion& motion) { return motion.inclination >= kFlat; }

void set_one_second(Record& record, const EulerDiscScene& scene, const EulerDiscMotion& motion) {
  const double truth = scene.disc.precession(scene.inclination);
  record.set("inclination_1s_rad", motion.inclination).set("precession_1s_rad_s", motion.precession);
  if (scene.torsion > 0) return;  // no closed form
  record.set("inclination_error_1s_rad", std::abs(motion.inclination - scene.inclination))
      .set("precession_error_1s", std::abs(motion.precession / truth - 1));
}

std::vector<Row> rows(const std::string& variant, const CaseRun<3>& run, Record& summary) {
  const EulerDiscScene scene = scene_of(variant);
  std::vector<Row> history;
  double off_steady = 0;
  double rise = 0;
  double flat = -1;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const Sample& sample = run.samples[i];
    const EulerDiscMotion motion = euler_disc_motion(run.states[i].front());
    const EnergyAccount& account = run.accounts[i];
    Record row(kHistory);
    row.set("t_s", sample.t_s).set("inclination_rad", motion.inclination);
    row.set("contact_spin_rad_s", motion.contact_spin).set("center_speed_m_s", motion.center_speed);
    row.set("total_J", sample.energy.total()).set("friction_loss_J", account.friction_loss);
    row.set("impact_loss_J", account.impact_loss).set("energy_drift_J", account.drift);
    if (rolls(motion) && flat < 0) {
      const double steady = scene.disc.precession(motion.inclination);
      row.set("precession_rad_s", motion.precession).set("steady_precession_rad_s", steady);
      off_steady = std::max(off_steady, std::abs(motion.precession / steady - 1));
    } else if (flat < 0) {
      flat = sample.t_s;
    }
    if (i > 0) rise = std::max(rise, sample.energy.total() - run.samples[i - 1].energy.total());
    if (sample.t_s == 1.0) set_one_second(summary, scene, motion);
    history.push_back(row.row());
  }
  const EulerDiscMotion end = euler_disc_motion(run.end.front());
  summary.set("end_inclination_rad", end.inclination).set("largest_off_steady", off_steady);
  if (flat < 0) summary.set("end_precession_rad_s", end.precession);
  if (flat >= 0) summary.set("flat_s", flat);
  summary.set("largest_energy_rise_J", rise);
  return history;
}

}  // namespace

int main(int argc, char** argv) {
  const VariantExperiment what = {
      .name = "euler_disc",
      .about =
          "Does a coin that rolls on its rim with its centre at rest keep to the closed form of that motion?",
      .examples =
          "  euler_disc                                     what is committed\n"
          "  euler_disc --variants rolling --step-sizes 0.002 --until 5 --out /tmp/coin\n",
      .variants = {"rolling", "torsion"},
      .about_variants =
          "rolling: no friction torque; torsion: with a friction torque about the contact's normal",
      .steps = {"0.002", "0.001", "0.0005", "0.00025"},
      .quick_steps = {"0.002", "0.001"},
      .until = 4.0,
      .quick_until = 1.0,
      .summary = kSummary,
      .history = kHistory,
      .scene = [](const std::string& variant) { return euler_disc_scene(scene_of(variant)); },
      .tabulate = rows};
  return run_variant_experiment(what, argc, argv);
}
