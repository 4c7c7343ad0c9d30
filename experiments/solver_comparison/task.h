#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/complementarity/problem.h"
#include "experiments/problems/frozen_contact.h"
#include "experiments/problems/recorded_steps.h"

/// What the solvers are compared on.
namespace touchstone::solver_comparison {

template <int Dim>
using StepPointer = std::shared_ptr<const problems::RecordedStep<Dim>>;

/// A motion that the stepper itself goes through.
template <int Dim>
struct Motion {
  Scene<Dim> scene;
  double h = 0.0;  ///< [s]
  int steps = 0;   ///< of which the first is not timed
};
template <int Dim>
using MotionPointer = std::shared_ptr<const Motion<Dim>>;

/// A problem with a start, or a trajectory of such problems.
struct Task {
  std::string family;   ///< literature, random_lcp, step, frozen_step, trajectory
  std::string problem;  ///< its name; of a step, its scene
  long item = 0;        ///< seed of a random problem, number of a step
  std::string start;
  double h = std::numeric_limits<double>::quiet_NaN();  ///< of a step [s]
  bool solvable = true;
  bool linear = false;  ///< F is M z + q
  Eigen::VectorXd z;    ///< the start
  /// The problem, a new one at each call: evaluations may write to a workspace.
  std::function<std::unique_ptr<MixedComplementarityProblem>()> make;
  /// The same as a step, which elimination asks for.
  std::variant<std::monostate, StepPointer<2>, StepPointer<3>> step;
  /// The same as data of a frictional contact problem.
  std::shared_ptr<const problems::FrozenContactProblem> frozen;
  /// Steps of a trajectory, each a problem with its start; what is above is then those of the first.
  std::vector<Task> parts;
  /// The same trajectory as a motion.
  std::variant<std::monostate, MotionPointer<2>, MotionPointer<3>> motion;

  [[nodiscard]] Eigen::Index size() const { return z.size(); }
};

[[nodiscard]] std::vector<Task> literature_tasks();
/// Three seeds of each kind. @param sizes  numbers of unknowns, >= 3
[[nodiscard]] std::vector<Task> random_tasks(const std::vector<int>& sizes);
/// Steps of a scene file in SCENES (experiments/scenes), `step` and `frozen_step`.
[[nodiscard]] std::vector<Task> step_tasks(const std::string& scene);
/// The first seconds of a scene, every step: family `trajectory`, one task for each kind of start: `last`,
/// the last solution; `extrapolated`, as the stepper starts. None for a scene of several moving bodies.
[[nodiscard]] std::vector<Task> trajectory_tasks(const std::string& scene);
/// The scenes that steps are recorded of.
[[nodiscard]] std::vector<std::string> recorded_scenes();

}  // namespace touchstone::solver_comparison
