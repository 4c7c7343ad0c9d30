#include "experiments/solver_comparison/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/model/errors.h"
#include "experiments/problems/literature.h"
#include "experiments/problems/random_lcp.h"
#include "experiments/problems/trajectory.h"
#include "experiments/scene_file/scene_file.h"

namespace touchstone::solver_comparison {

namespace {

constexpr long kSeeds = 3;

/// A scene, the step size [s] and which of its steps are recorded: the first with a contact's impulse, and
/// some on the way; and so many from the start as a trajectory, 0 for none.
struct Recording {
  const char* scene;
  double h;
  std::vector<int> steps;
  int trajectory;
};

const std::vector<Recording>& recordings() {
  static const std::vector<Recording> all = {
      {"box_on_incline", 0.01, {2, 10, 50}, 100},
      {"disc_rolling", 0.01, {2, 10, 50}, 100},
      {"ellipsoid_on_ellipsoid", 0.01, {2, 10, 30, 60}, 100},
      {"ellipsoid_rolling", 0.01, {2, 10, 50, 100}, 100},
      {"rattleback", 0.01, {2, 10, 50}, 100},
      {"sphere_on_spheres", 0.01, {2, 10, 50, 100, 150}, 370},
      {"sphere_spin", 0.01, {2, 50, 150}, 150},
      {"ten_bodies", 0.005, {98, 100, 102}, 0},
      {"tippe_top", 0.01, {2, 10, 50}, 100},
  };
  return all;
}

template <int Dim>
Task step_task(const Recording& recording, const problems::RecordedStep<Dim>& recorded) {
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
  return task;
}

template <int Dim>
void add_steps(const Recording& recording, const Scene<Dim>& scene, std::vector<Task>& tasks) {
  for (const auto& recorded : problems::record_steps(scene, recording.h, recording.steps)) {
    Task task = step_task(recording, recorded);
    tasks.push_back(task);
    if constexpr (Dim == 3) {
      if (recorded.start != "cold") continue;  // the same geometry from either start
      auto frozen = problems::FrozenContactProblem::from(recorded.problem);
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

template <int Dim>
void add_trajectory(const Recording& recording, const Scene<Dim>& scene, std::vector<Task>& tasks) {
  const auto motion =
      std::make_shared<const Motion<Dim>>(Motion<Dim>{scene, recording.h, recording.trajectory});
  std::map<std::string, Task> of_start;
  for (const auto& recorded : problems::record_trajectory(scene, recording.h, recording.trajectory)) {
    const Task part = step_task(recording, recorded);
    Task& whole = of_start.try_emplace(part.start, part).first->second;
    whole.parts.push_back(part);
  }
  for (auto& [start, whole] : of_start) {
    whole.family = "trajectory";
    whole.item = 0;
    whole.motion = motion;
    tasks.push_back(std::move(whole));
  }
}

const Recording& recording_of(const std::string& scene) {
  const auto found = std::ranges::find(recordings(), scene, &Recording::scene);
  if (found == recordings().end())
    throw InputError("--scenes", scene, fmt::format("{}", fmt::join(recorded_scenes(), ", ")));
  return *found;
}

auto read(const Recording& recording) {
  return scene_file::read_scene(fmt::format("{}/{}.toml", SCENES, recording.scene));
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
  const Recording& recording = recording_of(scene);
  std::vector<Task> tasks;
  std::visit([&](const auto& found) { add_steps(recording, found, tasks); }, read(recording));
  return tasks;
}

std::vector<Task> trajectory_tasks(const std::string& scene) {
  const Recording& recording = recording_of(scene);
  std::vector<Task> tasks;
  if (recording.trajectory == 0) return tasks;
  std::visit([&](const auto& found) { add_trajectory(recording, found, tasks); }, read(recording));
  return tasks;
}

}  // namespace touchstone::solver_comparison
