#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/complementarity/linear_path.h"
#include "core/complementarity/residual.h"
#include "core/complementarity/solver_chain.h"
#include "core/model/errors.h"
#include "core/stepper/condensed_newton.h"
#include "core/stepper/implicit_stepper.h"
#include "experiments/solver_comparison/solving.h"
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

/// A solver that is kept until it is asked for at another tolerance.
template <typename Solver>
class AtTolerance {
 public:
  /// @param options  of the solver, by tolerance
  template <typename MakeOptions>
  Solver& at(double tolerance, const MakeOptions& options) {
    if (!solver_ || tolerance != tolerance_) solver_.emplace(options(tolerance));
    tolerance_ = tolerance;
    return *solver_;
  }

 private:
  double tolerance_ = 0.0;
  std::optional<Solver> solver_;
};

/// @param options  of the solver, by tolerance
template <typename Solver, typename MakeOptions>
Solving by_solver(const Task& task, const MakeOptions& options) {
  struct State {
    explicit State(const Task& made) : problem(made.make()), counting(*problem) {}
    std::unique_ptr<MixedComplementarityProblem> problem;
    CountingProblem counting;
    AtTolerance<Solver> solver;
    Eigen::VectorXd z;
  };
  return [state = std::make_shared<State>(task), start = task.z, options](double tolerance) {
    Solver& solver = state->solver.at(tolerance, options);
    state->counting.restart();
    state->z = start;
    SolveReport report;
    const double seconds = time_of([&] { report = solver.solve(state->counting, state->z); });
    Answer answer = answer_of(report, *state->problem, state->z);
    answer.evaluations = state->counting.count();
    answer.stages = std::max(report.stages.count(), 1);
    answer.solve_s = seconds;
    return answer;
  };
}

template <int Dim>
Solving by_elimination(const problems::RecordedStep<Dim>& step) {
  struct State {
    explicit State(const StepProblem<Dim>& posed) : problem(posed) {}
    StepProblem<Dim> problem;
    AtTolerance<CondensedNewton<Dim>> solver;
    Eigen::VectorXd z;
  };
  return [state = std::make_shared<State>(step.problem), start = step.z](double tolerance) {
    CondensedNewton<Dim>& solver =
        state->solver.at(tolerance, [](double value) { return CondensedOptions{.tolerance = value}; });
    state->z = start;
    SolveReport report;
    const double seconds = time_of([&] { report = solver.solve(state->problem, state->z); });
    Answer answer = answer_of(report, state->problem, state->z);
    answer.solve_s = seconds;
    return answer;
  };
}

Solving by_elimination(const Task& task) {
  if (const auto* planar = std::get_if<StepPointer<2>>(&task.step)) return by_elimination(**planar);
  if (const auto* spatial = std::get_if<StepPointer<3>>(&task.step)) return by_elimination(**spatial);
  throw Unsupported("it eliminates the unknowns of a step");
}

/// Pivots on data, whatever the tolerance.
Solving by_lemke(const Task& task) {
  if (!task.linear) throw Unsupported("the problem is not linear");
  struct State {
    std::unique_ptr<MixedComplementarityProblem> problem;
    Eigen::VectorXd origin, q;
    Eigen::MatrixXd m;
    LinearPath path;
  };
  const Eigen::Index n = task.size();
  const auto state = std::make_shared<State>();
  state->problem = task.make();
  const MixedComplementarityProblem& problem = *state->problem;
  // Any origin does; this one is within the bounds.
  state->origin = Eigen::VectorXd::Zero(n).cwiseMax(problem.lower()).cwiseMin(problem.upper());
  state->q.resize(n);
  state->m.resize(n, n);
  problem.evaluate(state->origin, state->q, &state->m);
  return [state, start = task.z](double) {
    const MixedComplementarityProblem& linear = *state->problem;
    Eigen::VectorXd z = start;
    LinearPathResult result;
    Answer answer;
    answer.solve_s = time_of([&] {
      result = state->path.lemke(state->m, state->q, linear.lower(), linear.upper(), state->origin, z);
    });
    answer.claims_solved = result.solved();
    answer.claim = std::string(to_string(result.status));
    answer.residual = natural_residual(linear, z).value;
    answer.iterations = result.pivots;
    answer.evaluations = 1;  // of the data
    return answer;
  };
}

/// The stepper as it is, with its own tolerance: candidates, start, search and memory, all of step().
template <int Dim>
std::vector<Answer> by_stepping(const Motion<Dim>& motion) {
  constexpr int kPasses = 15;
  std::vector<Answer> steps;
  for (int pass = 0; pass < kPasses; ++pass) {
    ImplicitStepper<Dim> stepper(motion.scene, {});
    static_cast<void>(stepper.step(motion.h));
    for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(motion.steps); ++i) {
      StepReport report;
      const double seconds = time_of([&] { report = stepper.step(motion.h); });
      if (pass > 0) {
        steps[i].total_s = steps[i].solve_s = std::min(steps[i].solve_s, seconds);
        continue;
      }
      Answer answer;
      answer.claims_solved = report.status == StepStatus::solved;
      answer.claim = answer.claims_solved ? "solved" : report.reason;
      answer.residual = natural_residual(stepper.problem(), stepper.solution()).value;
      answer.iterations = report.iterations;
      answer.solve_s = seconds;
      steps.push_back(answer);
    }
  }
  return steps;
}

std::vector<Answer> by_stepping(const Task& task) {
  if (const auto* planar = std::get_if<MotionPointer<2>>(&task.motion)) return by_stepping(**planar);
  if (const auto* spatial = std::get_if<MotionPointer<3>>(&task.motion)) return by_stepping(**spatial);
  throw Unsupported("it goes through a motion");
}

Solving bind(const std::string& solver, const Task& task) {
  if (solver == "elimination") return by_elimination(task);
  if (solver == "lemke") return by_lemke(task);
  if (solver == "path_newton") {
    return by_solver<PathNewton>(task, [](double tolerance) {
      PathNewtonOptions options;
      options.search.tolerance = tolerance;
      return options;
    });
  }
  if (solver == "semismooth_newton") {
    return by_solver<SemismoothNewton>(task, [](double tolerance) {
      SemismoothNewtonOptions options;
      options.search.tolerance = tolerance;
      return options;
    });
  }
  if (solver == "solver_chain") {
    return by_solver<SolverChain>(task, [](double tolerance) {
      SolverChainOptions options;
      options.set_tolerance(tolerance);
      return options;
    });
  }
  throw std::logic_error("no solver " + solver);
}

}  // namespace

std::vector<std::string> our_solvers() {
  return {"elimination", "implicit_stepper", "lemke", "path_newton", "semismooth_newton", "solver_chain"};
}

std::vector<std::string> siconos_solvers() {
  return {"siconos_fc3d_admm",   "siconos_fc3d_nsgs", "siconos_fc3d_nsn_ac",    "siconos_fc3d_nsn_fb",
          "siconos_fc3d_nsn_nm", "siconos_lemke",     "siconos_mcp_fb",         "siconos_mcp_min",
          "siconos_ncp_fb",      "siconos_ncp_min",   "siconos_ncp_path_search"};
}

Answer solve_by_ours(const std::string& solver, const Task& task) {
  if (solver == "implicit_stepper") return combine(by_stepping(task));
  return measure_task(task, kSolved, kLoosest, [&](const Task& one) { return bind(solver, one); });
}

}  // namespace touchstone::solver_comparison
