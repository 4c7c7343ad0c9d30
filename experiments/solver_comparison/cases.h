#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/solver_comparison/answer.h"

/// From tasks and solvers to cases.
namespace touchstone::solver_comparison {

/// Columns of `summary` and `solve_timing`.
[[nodiscard]] const std::vector<std::string>& summary_columns();
[[nodiscard]] const std::vector<std::string>& timing_columns();

/// Whether a solver is listed with a family of problems. Where it is but a problem of the family is not for
/// it the case says `unsupported`.
[[nodiscard]] bool is_for_family(const std::string& solver, const std::string& family);

/// The same of one task of the family: `implicit_stepper` has its own start alone.
[[nodiscard]] bool is_for_task(const std::string& solver, const Task& task);

/// A solver runs in a process of its own with a limit on processor time, Siconos's with their output dropped.
[[nodiscard]] harness::Case make_case(const std::string& solver, std::shared_ptr<const Task> task);

}  // namespace touchstone::solver_comparison
