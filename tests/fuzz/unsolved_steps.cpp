// Why steps are not solved: for each step of tests/fuzz/hard/unsolved.csv, whether its contacts wedge
// (wedge.h), whether any mode of its contacts, as equations, has a root that is a solution (mode_search.h),
// and what it takes for the step to be solved: a shorter step, or less friction. The self-stress foretells
// the latter: the contacts stop to wedge where the largest friction that it calls for no longer fits into the
// cones.
//   unsolved_steps --starts 30 --seed 2506
// A step counts as without a solution, as far as this tells, if the contacts wedge with a drift that they
// cannot close and no mode has a root. Exit codes: 0 all are such steps, 1 some are not, 2 bad usage.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>

#include "core/stepper/implicit_stepper.h"
#include "experiments/scene_file/scene_file.h"
#include "tests/fuzz/wedge.h"
#include "tests/support/mode_search.h"

namespace {

using namespace touchstone;

constexpr double kSolution = 1e-10;   ///< violation of a root that would be certified
constexpr double kSelfStress = 1e-4;  ///< imbalance: what a load of 1e5 leaves of the momentum of a step
constexpr int kHalvings = 14;         ///< of the step, at most
constexpr int kBisections = 10;       ///< of the friction

struct Listed {
  std::string seed;
  double h = 0.0;  ///< [s]
};

std::vector<Listed> listed(const std::string& file) {
  std::ifstream in(file);
  std::vector<Listed> steps;
  std::string line;
  std::getline(in, line);  // seed,h,reason,residual,state
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string seed, h;
    std::getline(cells, seed, ',');
    std::getline(cells, h, ',');
    steps.push_back({seed, std::stod(h)});
  }
  return steps;
}

template <int Dim>
bool is_solved(const Scene<Dim>& scene, double h) {
  ImplicitStepper<Dim> stepper(scene, {});
  return stepper.step(h).status == StepStatus::solved;
}

/// Contacts of `problem` between bodies that are too far apart to touch in the step.
template <int Dim>
std::vector<bool> far_contacts(const Scene<Dim>& scene, double h, const StepProblem<Dim>& problem) {
  ContactCandidates<Dim> candidates(scene);
  const auto state = initial_state(scene);
  candidates.select(state, h);
  static_cast<void>(candidates.leave_out_far(state, h));
  std::vector<bool> far;
  for (const ContactPair<Dim>& contact : problem.contacts()) {
    far.push_back(std::none_of(candidates.pairs().begin(), candidates.pairs().end(), [&](const auto& pair) {
      return pair.selected && pair.contact.body_1 == contact.body_1 && pair.contact.body_2 == contact.body_2;
    }));
  }
  return far;
}

/// Of many contacts those without an impulse where the step's searches ended are held open as well.
template <int Dim>
void hold_more(const StepProblem<Dim>& problem, const Eigen::VectorXd& end, std::vector<bool>& held_open) {
  constexpr long kMany = 5;        // 3^5 modes
  constexpr double kLoad = 1e-12;  // in m V: rounding of an open contact
  if (std::count(held_open.begin(), held_open.end(), false) <= kMany) return;
  for (std::size_t i = 0; i < held_open.size(); ++i) {
    if (end[problem.layout().contact(i).normal] < kLoad) held_open[i] = true;
  }
}

template <int Dim>
Scene<Dim> with_friction(Scene<Dim> scene, double factor) {
  scene.contact_law.mu *= factor;
  for (auto& pair : scene.pair_laws) pair.law.mu *= factor;
  return scene;
}

/// Largest part of the friction with which the step is solved, to 2^-kBisections.
template <int Dim>
double most_friction(const Scene<Dim>& scene, double h) {
  double solved = 0;
  double unsolved = 1;
  for (int k = 0; k < kBisections; ++k) {
    const double factor = (solved + unsolved) / 2;
    (is_solved(with_friction(scene, factor), h) ? solved : unsolved) = factor;
  }
  return solved;
}

template <int Dim>
void print_wedge(const Scene<Dim>& scene, const StepProblem<Dim>& problem, const Wedge& wedge) {
  fmt::print("  wedge      ");
  for (const std::size_t i : wedge.contacts) {
    const ContactPair<Dim>& contact = problem.contacts()[i];
    const auto name = [&](int body) {
      const Body<Dim>& b = scene.bodies[static_cast<std::size_t>(body)];
      return b.name + (b.fixed ? " (fixed)" : "");
    };
    fmt::print("{}{} on {}", i == wedge.contacts.front() ? "" : "; ", name(contact.body_1),
               name(contact.body_2));
  }
  fmt::print("\n  path         impulses of {:.0e} m V at epsilon = {:.2e}\n", wedge.impulse, wedge.epsilon);
  fmt::print("  self-stress  out of balance by {:.0e}, uses {:.3f} of the friction\n", wedge.imbalance,
             wedge.use_of_cone);
  fmt::print("  drift        {:.3e} V, with ten times the load it changes by {:.0e} (rows to {:.0e})\n",
             wedge.drift, wedge.drift_change, wedge.residual);
}

/// Whether the step is of the class without a solution.
template <int Dim>
bool explain(const Scene<Dim>& scene, double h, int starts) {
  ImplicitStepper<Dim> stepper(scene, {});
  const StepReport report = stepper.step(h);
  fmt::print("  step       {}\n", report.status == StepStatus::solved
                                      ? "solved"
                                      : fmt::format("{}, residual {:.0e}", report.reason, report.residual));
  if (report.status == StepStatus::solved) return false;
  StepProblem<Dim> problem = stepper.problem();
  ModeSearchOptions search{.starts = starts, .from = {stepper.solution()}};
  search.held_open = far_contacts(scene, h, problem);
  const auto far = std::count(search.held_open.begin(), search.held_open.end(), true);
  hold_more(problem, search.from.front(), search.held_open);
  Eigen::VectorXd end;
  const std::optional<Wedge> wedge = find_wedge(problem, end);
  if (wedge) {
    print_wedge(scene, problem, *wedge);
    search.from.push_back(end);
  }
  int halvings = 1;
  while (halvings <= kHalvings && !is_solved(scene, std::ldexp(h, -halvings))) ++halvings;
  fmt::print("  {} with h / {}\n", halvings <= kHalvings ? "solved" : "not solved",
             1 << std::min(halvings, kHalvings));
  fmt::print("  solved with up to {:.3f} of the friction\n", most_friction(scene, h));
  std::fflush(stdout);
  const auto began = std::chrono::steady_clock::now();
  const ModeReport modes = search_modes(problem, search);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  fmt::print("  contacts   {}, {} of them far, {} held open\n", search.held_open.size(), far,
             std::count(search.held_open.begin(), search.held_open.end(), true));
  fmt::print("  modes      {} of {} solved as equations, {} roots, {:.0f} s\n", modes.solved_modes,
             modes.modes, modes.roots, seconds);
  fmt::print("  best root  {}: misses {} by {:.1e}\n", modes.best_mode, modes.missed, modes.least_violation);
  return wedge && wedge->imbalance < kSelfStress && wedge->use_of_cone < 1 && wedge->drift < -kSolution &&
         modes.least_violation > kSolution;
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder = HARD_STEPS;
  std::string only;
  int starts = 10;
  CLI::App app("Explains the contact steps that are not solved", "unsolved_steps");
  app.add_option("--folder", folder, "with unsolved.csv and a scene for each step")->capture_default_str();
  app.add_option("--seed", only, "this step alone");
  app.add_option("--starts", starts, "random starts for each mode of the contacts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  int without = 0;
  int all = 0;
  for (const Listed& step : listed(folder + "/unsolved.csv")) {
    if (!only.empty() && step.seed != only) continue;
    fmt::print("step {}, h = {:.3e} s\n", step.seed, step.h);
    const auto any = scene_file::read_scene(fmt::format("{}/step_{}.toml", folder, step.seed));
    const bool is_without =
        std::visit([&](const auto& scene) { return explain(scene, step.h, starts); }, any);
    fmt::print("  class      {}\n\n", is_without ? "wedged, no solution found in any mode" : "NOT EXPLAINED");
    std::fflush(stdout);
    ++all;
    without += is_without ? 1 : 0;
  }
  fmt::print("{} of {} steps wedge and have no solution in any mode\n", without, all);
  return without == all && all > 0 ? 0 : 1;
}
