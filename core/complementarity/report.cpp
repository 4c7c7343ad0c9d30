#include "core/complementarity/report.h"

#include <fmt/format.h>

namespace touchstone {

std::string_view to_string(SolveStatus status) {
  switch (status) {
    case SolveStatus::not_run:
      return "not_run";
    case SolveStatus::solved:
      return "solved";
    case SolveStatus::iteration_limit:
      return "iteration_limit";
    case SolveStatus::stalled:
      return "stalled";
    case SolveStatus::local_minimum:
      return "local_minimum";
    case SolveStatus::singular_jacobian:
      return "singular_jacobian";
    case SolveStatus::ray_termination:
      return "ray_termination";
    case SolveStatus::pivot_limit:
      return "pivot_limit";
    case SolveStatus::non_finite:
      return "non_finite";
  }
  return "unknown";
}

std::string_view to_string(SolverKind kind) {
  return kind == SolverKind::path_newton ? "path_newton" : "semismooth_newton";
}

std::string_view to_string(StageStart start) {
  switch (start) {
    case StageStart::given:
      return "given";
    case StageStart::crash:
      return "crash";
    case StageStart::proximal:
      return "proximal";
    case StageStart::perturbed:
      return "perturbed";
  }
  return "unknown";
}

std::string describe(const SolveReport& report, const MixedComplementarityProblem& problem) {
  const std::string worst = report.worst_row < 0 ? std::string("no row") : problem.row_name(report.worst_row);
  std::string text = fmt::format("{} after {} iterations, {} pivots, {} evaluations: residual {:.3e} in {}",
                                 to_string(report.status), report.iterations, report.pivots,
                                 report.evaluations, report.residual, worst);
  for (const SolveStage& stage : report.stages.values()) {
    const std::string term = stage.weight > 0 ? fmt::format(" with weight {:.1e}", stage.weight) : "";
    text += fmt::format("; {} from the {} start{}: {} at {:.3e}", to_string(stage.solver),
                        to_string(stage.start), term, to_string(stage.status), stage.residual);
  }
  return text;
}

}  // namespace touchstone
