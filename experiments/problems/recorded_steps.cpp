#include "experiments/problems/recorded_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace touchstone::problems {

namespace {

template <int Dim>
bool same_contacts(const StepProblem<Dim>& a, const StepProblem<Dim>& b) {
  if (a.size() != b.size() || !std::ranges::equal(a.bodies(), b.bodies()) ||
      !std::ranges::equal(a.joints(), b.joints())) {
    return false;
  }
  return std::ranges::equal(a.contacts(), b.contacts(), [](const auto& x, const auto& y) {
    return x.body_1 == y.body_1 && x.body_2 == y.body_2;
  });
}

/// The stepper's own warm start at depth 1: velocities, impulses and multipliers as they were, closest points
/// where they were relative to body 1.
template <int Dim>
Eigen::VectorXd carried_on(const StepProblem<Dim>& last, const Eigen::VectorXd& solution,
                           const StepProblem<Dim>& problem) {
  Eigen::VectorXd z = solution;
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) {
    last.evaluate_state(i, solution);
    const Vector<Dim> moved = problem.body_1_position(i, z) - last.body_1_position(i, solution);
    problem.set_points(i, moved + last.point(i, 0), moved + last.point(i, 1), z);
  }
  return z;
}

template <int Dim>
Eigen::VectorXd from_cold(StepProblem<Dim>& problem) {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(problem.size());
  problem.free_velocity(z);
  for (std::size_t i = 0; i < problem.contacts().size(); ++i) problem.find_points(i, z);
  return z;
}

}  // namespace

template <int Dim>
std::vector<RecordedStep<Dim>> record_steps(const Scene<Dim>& scene, double h,
                                            const std::vector<int>& steps) {
  const auto stepper = std::make_shared<ImplicitStepper<Dim>>(scene, ImplicitOptions{});
  std::vector<RecordedStep<Dim>> recorded;
  for (int step = 1; step <= steps.back(); ++step) {
    const bool wanted = std::ranges::find(steps, step) != steps.end();
    std::optional<StepProblem<Dim>> last;
    Eigen::VectorXd solution;
    if (wanted && step > 1) {
      last.emplace(stepper->problem());
      solution = stepper->solution();
    }
    if (const StepReport report = stepper->step(h); report.status != StepStatus::solved)
      throw std::runtime_error(fmt::format("step {} is not solved: {}", step, report.reason));
    if (!wanted) continue;
    const StepProblem<Dim>& problem = stepper->problem();
    if (last && same_contacts(*last, problem))
      recorded.push_back({step, "warm", stepper, problem, carried_on(*last, solution, problem)});
    StepProblem<Dim> cold = problem;
    const Eigen::VectorXd z = from_cold(cold);
    recorded.push_back({step, "cold", stepper, std::move(cold), z});
  }
  return recorded;
}

template std::vector<RecordedStep<2>> record_steps(const Scene<2>&, double, const std::vector<int>&);
template std::vector<RecordedStep<3>> record_steps(const Scene<3>&, double, const std::vector<int>&);

}  // namespace touchstone::problems
