// Question: which complementarity problems does each solver solve, with how much work, and which does it only
// say that it has solved? Success criterion: ours solve every problem that has a solution from every listed
// start, report every one that has none, and claim nothing falsely; elimination is at least five times faster
// than the fastest single solver of Siconos that solves the same steps (a measurement of each run; from the
// same start it is about four times faster, see README.md). Source: problems of the literature (Kojima &
// Shindo, Josephy, Billups, Murphy et al., Murty; see problems/literature.h), random linear problems of known
// solution, steps of the example scenes, and whole trajectories; profiles after Dolan & More, "Benchmarking
// optimization software with performance profiles" (2002). The judge is the natural residual of
// core/complementarity for everybody: solved is at most 1e-10 there. Expected: one Newton method alone is
// trapped by a few problems that a chain of solvers gets through; Lemke's method solves monotone linear
// problems and no other kind; from an extrapolated start everybody takes a step or two.

#include <fmt/format.h>

#include <algorithm>

#include "core/model/errors.h"
#include "experiments/harness/experiment.h"
#include "experiments/solver_comparison/cases.h"
#include "experiments/solver_comparison/profile.h"

namespace {

using namespace touchstone;
using namespace touchstone::harness;
using namespace touchstone::solver_comparison;

std::vector<std::string> all_solvers() {
  std::vector<std::string> keys = our_solvers();
  for (const std::string& key : siconos_solvers()) keys.push_back(key);
  return keys;
}

std::vector<std::string> all_families() {
  return {"literature", "random_lcp", "step", "frozen_step", "trajectory"};
}

CommandLineSpec command_line() {
  return {
      .name = "solver_comparison",
      .about = "Which complementarity problems does each solver solve, and with how much work?",
      .examples =
          "  solver_comparison                                   what is committed, with Siconos\n"
          "  solver_comparison --quick --out /tmp/quick          a first look\n"
          "  solver_comparison --families step --scenes sphere_on_spheres --list\n"
          "  solver_comparison --methods path_newton,siconos_mcp_fb\n",
      .methods = all_solvers(),
      .axes = {{"families", "which problems: literature, random_lcp, step, frozen_step, trajectory",
                AxisKind::text, all_families(), all_families(), 1, all_families()},
               {"sizes", "unknowns of the random problems", AxisKind::integer, {"5", "20", "50"}, {"5"}, 3},
               {"scenes",
                "example scenes whose steps are recorded",
                AxisKind::text,
                recorded_scenes(),
                {"disc_rolling", "sphere_on_spheres"},
                1,
                recorded_scenes()}}};
}

std::vector<Task> tasks_of(const Selection& selection) {
  const std::vector<std::string>& families = selection.texts("families");
  const auto wanted = [&](const std::string& family) {
    return std::ranges::find(families, family) != families.end();
  };
  std::vector<Task> tasks;
  const auto add = [&](std::vector<Task> more) {
    for (Task& task : more) {
      if (wanted(task.family)) tasks.push_back(std::move(task));
    }
  };
  if (wanted("literature")) add(literature_tasks());
  if (wanted("random_lcp")) add(random_tasks(selection.integers("sizes")));
  if (wanted("step") || wanted("frozen_step")) {
    for (const std::string& scene : selection.texts("scenes")) add(step_tasks(scene));
  }
  if (wanted("trajectory")) {
    for (const std::string& scene : selection.texts("scenes")) add(trajectory_tasks(scene));
  }
  return tasks;
}

std::vector<Case> cases_of(const Selection& selection) {
  const std::vector<std::string> known = all_solvers();
  for (const MethodSpec& method : selection.methods) {
    if (std::ranges::find(known, method.key) == known.end() || !method.options.empty())
      throw InputError("--methods", format_method(method), fmt::format("{}", fmt::join(known, ", ")));
  }
  std::vector<Case> cases;
  for (const Task& task : tasks_of(selection)) {
    const auto shared = std::make_shared<const Task>(task);
    for (const MethodSpec& method : selection.methods) {
      if (is_for_task(method.key, task)) cases.push_back(make_case(method.key, shared));
    }
  }
  return cases;
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path out;  // where tables are to be found afterwards
  const Experiment experiment = {
      .command_line = command_line(),
      .sweep_columns = {"family", "item", "size", "start"},
      .tables = {{"summary", summary_columns()}, {"solve_timing", timing_columns()}},
      .seed = std::nullopt,
      .cases = [&](const Selection& selection) {
        if (!selection.list && selection.shard.whole()) out = selection.out;
        return cases_of(selection);
      }};
  const int code = run_experiment(experiment, argc, argv);
  if (code <= 1 && !out.empty()) fmt::print("{}", write_profiles(out));
  return code;
}
