#include "experiments/problems/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "core/stepper/step_start.h"

namespace touchstone::problems {

namespace {

template <int Dim>
std::vector<std::size_t> contact_numbers(const StepProblem<Dim>& problem) {
  std::vector<std::size_t> numbers(problem.contacts().size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

/// With sigma = |w|, the row that elimination takes first of all, so that others need not begin with it.
template <int Dim>
Eigen::VectorXd start(WarmStart<Dim>& memory, int depth, StepProblem<Dim>& problem) {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
  start_from(memory, contact_numbers(problem), depth, problem, z);
  StepBlock<Dim> block;
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    problem.evaluate_state(i, z);
    problem.contact_block(i, false, block);
    z[problem.layout().contact(i).slip] -= block.f[block.at.slip];
  }
  return z;
}

template <int Dim>
void remember(const StepProblem<Dim>& problem, const Eigen::VectorXd& solution,
              std::span<const BodyState<Dim>> state, WarmStart<Dim>& memory) {
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    problem.evaluate_state(i, solution);
    keep_contact(problem, i, solution, problem.impulse(i).normal, memory.next(i));
  }
  memory.accept(problem.contacts(), state);
}

}  // namespace

template <int Dim>
std::vector<RecordedStep<Dim>> record_trajectory(const Scene<Dim>& scene, double h, int count) {
  if (!scene.joints.empty() || std::ranges::count(scene.bodies, false, &Body<Dim>::fixed) != 1)
    throw std::invalid_argument("a trajectory is recorded of one moving body without joints");
  const auto stepper = std::make_shared<ImplicitStepper<Dim>>(scene, ImplicitOptions{});
  WarmStart<Dim> memory(stepper->scene());
  std::vector<RecordedStep<Dim>> recorded;
  for (int step = 1; step <= count; ++step) {
    if (const StepReport report = stepper->step(h); report.status != StepStatus::solved)
      throw std::runtime_error(fmt::format("step {} is not solved: {}", step, report.reason));
    memory.match(stepper->problem().contacts());
    const auto add = [&](const char* name, int depth) {
      StepProblem<Dim> problem = stepper->problem();
      const Eigen::VectorXd z = start(memory, depth, problem);
      recorded.push_back({step, name, stepper, std::move(problem), z});
    };
    if (step > 1) {
      add("last", 1);
      add("extrapolated", WarmStart<Dim>::kDepth);
    }
    remember(stepper->problem(), stepper->solution(), stepper->state(), memory);
  }
  return recorded;
}

template std::vector<RecordedStep<2>> record_trajectory(const Scene<2>&, double, int);
template std::vector<RecordedStep<3>> record_trajectory(const Scene<3>&, double, int);

}  // namespace touchstone::problems
