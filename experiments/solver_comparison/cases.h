#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/harness/case.h"
#include "experiments/solver_comparison/answer.h"

/// From tasks and solvers to cases.
namespace touchstone::solver_comparison {

/// Columns of `summary`.
[[nodiscard]] const std::vector<std::string>& summary_columns();

/// Whether a solver is listed with a family of problems. Where it is but a problem of the family is not for
/// it the case says `unsupported`.
[[nodiscard]] bool is_for_family(const std::string& solver, const std::string& family);

/// Siconos's solvers run in a process of their own, for at most ten seconds, with their output dropped.
[[nodiscard]] harness::Case make_case(const std::string& solver, std::shared_ptr<const Task> task);

}  // namespace touchstone::solver_comparison
