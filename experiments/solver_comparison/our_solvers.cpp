#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/residual.h"
#include "core/complementarity/solver_chain.h"
#include "core/model/errors.h"
#include "core/stepper/condensed_newton.h"
#include "experiments/solver_comparison/answer.h"
#include "experiments/solver_comparison/timing.h"

namespace touchstone::solver_comparison {

namespace {

Answer answer_of(const SolveReport& report, const MixedComplementarityProblem& problem,
                 const Eigen::VectorXd& z) {
  Answer answer;
  answer.claims_solved = report.solved();
  answer.claim = std::string(to_string(report.status));
  answer.residual = natural_residual(problem, z).value;
  answer.iterations = report.iterations;
  answer.evaluations = report.evaluations;
  return answer;
}

Answer by_solver(ComplementaritySolver& solver, const Task& task) {
  const auto problem = task.make();
  const CountingProblem counting(*problem);
  Eigen::VectorXd z = task.z;
  SolveReport report;
  const double first = time_of([&] { report = solver.solve(counting, z); });
  Answer answer = answer_of(report, *problem, z);
  answer.evaluations = counting.count();
  answer.stages = std::max(report.stages.count(), 1);
  answer.solve_s = typical_time(first, [&] {
    z = task.z;
    return time_of([&] { static_cast<void>(solver.solve(*problem, z)); });
  });
  return answer;
}

template <int Dim>
Answer by_elimination(const problems::RecordedStep<Dim>& step) {
  StepProblem<Dim> problem = step.problem;
  CondensedNewton<Dim> solver({.tolerance = kSolved});
  Eigen::VectorXd z = step.z;
  SolveReport report;
  const double first = time_of([&] { report = solver.solve(problem, z); });
  Answer answer = answer_of(report, problem, z);
  answer.solve_s = typical_time(first, [&] {
    z = step.z;
    return time_of([&] { static_cast<void>(solver.solve(problem, z)); });
  });
  return answer;
}

Answer by_elimination(const Task& task) {
  if (const auto* planar = std::get_if<StepPointer<2>>(&task.step)) return by_elimination(**planar);
  if (const auto* spatial = std::get_if<StepPointer<3>>(&task.step)) return by_elimination(**spatial);
  throw Unsupported("it eliminates the unknowns of a step");
}

Answer by_lemke(const Task& task) {
  if (!task.linear) throw Unsupported("the problem is not linear");
  const auto problem = task.make();
  const CountingProblem counting(*problem);
  const Eigen::Index n = task.size();
  // Any origin does; this one is within the bounds.
  const Eigen::VectorXd origin =
      Eigen::VectorXd::Zero(n).cwiseMax(problem->lower()).cwiseMin(problem->upper());
  Eigen::VectorXd q(n), z = task.z;
  Eigen::MatrixXd m(n, n);
  counting.evaluate(origin, q, &m);
  LinearPath path;
  LinearPathResult result;
  const auto solve = [&] { result = path.lemke(m, q, problem->lower(), problem->upper(), origin, z); };
  const double first = time_of(solve);
  Answer answer;
  answer.claims_solved = result.solved();
  answer.claim = std::string(to_string(result.status));
  answer.residual = natural_residual(*problem, z).value;
  answer.iterations = result.pivots;
  answer.evaluations = counting.count();
  answer.solve_s = typical_time(first, [&] { return time_of(solve); });
  return answer;
}

}  // namespace

std::vector<std::string> our_solvers() {
  return {"elimination", "lemke", "path_newton", "semismooth_newton", "solver_chain"};
}

std::vector<std::string> siconos_solvers() {
  return {"siconos_fc3d_admm",   "siconos_fc3d_nsgs", "siconos_fc3d_nsn_ac",    "siconos_fc3d_nsn_fb",
          "siconos_fc3d_nsn_nm", "siconos_lemke",     "siconos_mcp_fb",         "siconos_mcp_min",
          "siconos_ncp_fb",      "siconos_ncp_min",   "siconos_ncp_path_search"};
}

Answer solve_by_ours(const std::string& solver, const Task& task) {
  if (solver == "elimination") return by_elimination(task);
  if (solver == "lemke") return by_lemke(task);
  SolverChainOptions options;
  options.set_tolerance(kSolved);
  if (solver == "path_newton") {
    PathNewton path(options.path);
    return by_solver(path, task);
  }
  if (solver == "semismooth_newton") {
    SemismoothNewton semismooth(options.semismooth);
    return by_solver(semismooth, task);
  }
  if (solver == "solver_chain") {
    SolverChain chain(options);
    return by_solver(chain, task);
  }
  throw std::logic_error("no solver " + solver);
}

}  // namespace touchstone::solver_comparison
