#pragma once

#include <functional>

#include "experiments/solver_comparison/answer.h"

namespace touchstone::solver_comparison {

/// One solve from the start, at a tolerance on the solver's own measure. `residual` and what the solver says
/// are set, and `solve_s` is what this one solve took; it may keep between calls whatever it allocated.
using Solving = std::function<Answer(double tolerance)>;

/// Where measure() stops to look for a tolerance that will do.
constexpr double kLoosest = 1e-8;

/// The answer at the loosest tolerance that the judge lets pass, from `tolerance` by powers of ten to
/// `loosest`, so that nobody is asked for more than the others because his measure is another one; at
/// `tolerance` if that is not solved. `solve_s` is the least of some repetitions.
/// @param enough  what they may take together [s], see least_time()
[[nodiscard]] Answer measure(const Solving& solve, double tolerance, double loosest, double enough);

/// measure() of a task, or of every step of a trajectory, each bound to the solver by `bind`.
[[nodiscard]] Answer measure_task(const Task& task, double tolerance, double loosest,
                                  const std::function<Solving(const Task&)>& bind);

/// Of a trajectory: sums of its steps' answers, and the median of their times.
[[nodiscard]] Answer combine(const std::vector<Answer>& steps);

}  // namespace touchstone::solver_comparison
