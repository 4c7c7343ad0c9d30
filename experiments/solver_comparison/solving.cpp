#include "experiments/solver_comparison/solving.h"

#include <algorithm>

#include "experiments/solver_comparison/timing.h"

namespace touchstone::solver_comparison {

Answer measure(const Solving& solve, double tolerance, double loosest, double enough) {
  Answer answer = solve(tolerance);
  double used = tolerance;
  // Twice, so that a product of tens that rounding made larger counts too.
  for (double looser = 10 * tolerance; answer.is_solved() && looser < 2 * loosest; looser *= 10) {
    Answer other = solve(looser);
    if (!other.is_solved()) break;
    answer = std::move(other);
    used = looser;
  }
  answer.solve_s = least_time(answer.solve_s, enough, [&] { return solve(used).solve_s; });
  answer.total_s = answer.solve_s;
  answer.solved_problems = answer.is_solved() ? 1 : 0;
  return answer;
}

Answer measure_task(const Task& task, double tolerance, double loosest,
                    const std::function<Solving(const Task&)>& bind) {
  constexpr double kEnough = 2e-3, kEnoughOfMany = 3e-4;  // [s]
  if (task.parts.empty()) return measure(bind(task), tolerance, loosest, kEnough);
  std::vector<Answer> steps;
  for (const Task& part : task.parts) steps.push_back(measure(bind(part), tolerance, loosest, kEnoughOfMany));
  return combine(steps);
}

Answer combine(const std::vector<Answer>& steps) {
  Answer all = steps.front();
  all.problems = 0;
  all.solved_problems = 0;
  all.iterations = 0;
  all.evaluations = 0;
  all.total_s = 0;
  std::vector<double> times;
  for (const Answer& step : steps) {
    if (!step.is_solved() && all.is_solved()) all.claim = step.claim;
    all.claims_solved = all.claims_solved && step.claims_solved;
    all.residual = std::max(all.residual, step.residual);
    all.iterations += step.iterations;
    all.evaluations += step.evaluations;
    all.total_s += step.total_s;
    ++all.problems;
    all.solved_problems += step.is_solved() ? 1 : 0;
    times.push_back(step.solve_s);
  }
  all.solve_s = median(std::move(times));
  return all;
}

}  // namespace touchstone::solver_comparison
