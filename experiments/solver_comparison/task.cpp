#include "experiments/solver_comparison/task.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/model/errors.h"
#include "experiments/problems/literature.h"
#include "experiments/problems/random_lcp.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::solver_comparison {

namespace {

constexpr long kSeeds = 3;

/// A scene, the step size [s] and which of its steps are recorded: the first with a contact's impulse, and
/// some on the way.
struct Recording {
  const char* scene;
  double h;
  std::vector<int> steps;
};

const std::vector<Recording>& recordings() {
  static const std::vector<Recording> all = {
      {"box_on_incline", 0.01, {2, 10, 50}},
      {"disc_rolling", 0.01, {2, 10, 50}},
      {"ellipsoid_on_ellipsoid", 0.01, {2, 10, 30, 60}},
      {"ellipsoid_rolling", 0.01, {2, 10, 50, 100}},
      {"rattleback", 0.01, {2, 10, 50}},
      {"sphere_on_spheres", 0.01, {2, 10, 50, 100, 150}},
      {"sphere_spin", 0.01, {2, 50, 150}},
      {"ten_bodies", 0.005, {98, 100, 102}},
      {"tippe_top", 0.01, {2, 10, 50}},
  };
  return all;
}

template <int Dim>
void add_steps(const Recording& recording, const Scene<Dim>& scene, std::vector<Task>& tasks) {
  for (const auto& recorded : problems::record_steps(scene, recording.h, recording.steps)) {
    const auto step = std::make_shared<const problems::RecordedStep<Dim>>(recorded);
    Task task;
    task.family = "step";
    task.problem = recording.scene;
    task.item = step->step;
    task.start = step->start;
    task.h = recording.h;
    task.z = step->z;
    task.make = [step] { return std::make_unique<StepProblem<Dim>>(step->problem); };
    task.step = step;
    tasks.push_back(task);
    if constexpr (Dim == 3) {
      if (step->start != "cold") continue;  // the same geometry from either start
      auto frozen = problems::FrozenContactProblem::from(step->problem);
      if (!frozen) continue;
      const auto shared = std::make_shared<const problems::FrozenContactProblem>(std::move(*frozen));
      task.family = "frozen_step";
      task.start = "zero";
      task.z = Eigen::VectorXd::Zero(shared->size());
      task.make = [shared] { return std::make_unique<problems::FrozenContactProblem>(*shared); };
      task.step = {};
      task.frozen = shared;
      tasks.push_back(task);
    }
  }
}

}  // namespace

std::vector<Task> literature_tasks() {
  std::vector<Task> tasks;
  for (const problems::TestProblem& test : problems::all_problems()) {
    for (std::size_t i = 0; i < test.starts.size(); ++i) {
      Task task;
      task.family = "literature";
      task.problem = test.name;
      task.start = std::to_string(i + 1);
      task.linear = test.linear;
      task.z = test.starts[i];
      task.make = [problem = test.problem] { return std::make_unique<problems::FunctionProblem>(*problem); };
      tasks.push_back(std::move(task));
    }
  }
  return tasks;
}

std::vector<Task> random_tasks(const std::vector<int>& sizes) {
  using problems::LcpKind;
  std::vector<Task> tasks;
  for (const LcpKind kind : {LcpKind::p_matrix, LcpKind::degenerate, LcpKind::infeasible}) {
    for (const Eigen::Index n : sizes) {
      for (long seed = 1; seed <= kSeeds; ++seed) {
        const problems::RandomLcp lcp = problems::random_lcp(kind, n, static_cast<std::uint64_t>(seed));
        for (const auto& [start, z] :
             {std::pair<std::string, Eigen::VectorXd>{"zeros", Eigen::VectorXd::Zero(n)},
              std::pair<std::string, Eigen::VectorXd>{"ones", Eigen::VectorXd::Ones(n)}}) {
          Task task;
          task.family = "random_lcp";
          task.problem = to_string(kind);
          task.item = seed;
          task.start = start;
          task.solvable = kind != LcpKind::infeasible;
          task.linear = true;
          task.z = z;
          task.make = [lcp, n] {
            return std::make_unique<problems::FunctionProblem>(n, problems::linear(lcp.m, lcp.q));
          };
          tasks.push_back(std::move(task));
        }
      }
    }
  }
  return tasks;
}

std::vector<std::string> recorded_scenes() {
  std::vector<std::string> names;
  for (const Recording& one : recordings()) names.emplace_back(one.scene);
  return names;
}

std::vector<Task> step_tasks(const std::string& scene) {
  const auto recording = std::ranges::find(recordings(), scene, &Recording::scene);
  if (recording == recordings().end())
    throw InputError("--scenes", scene, fmt::format("{}", fmt::join(recorded_scenes(), ", ")));
  std::vector<Task> tasks;
  const auto read = scene_file::read_scene(fmt::format("{}/{}.toml", SCENES, scene));
  std::visit([&](const auto& found) { add_steps(*recording, found, tasks); }, read);
  return tasks;
}

}  // namespace touchstone::solver_comparison
