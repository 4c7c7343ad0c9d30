#include "experiments/solver_comparison/cases.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <sstream>

#include "baselines/isolation.h"
#include "core/model/errors.h"
#include "experiments/harness/record.h"

namespace touchstone::solver_comparison {

using harness::Case;
using harness::CaseResult;
using harness::CaseStatus;
using harness::Record;

namespace {

// Of one problem, whatever the solver, repetitions included. What counts is processor time, in whole seconds
// as the system wants it, so that a busy machine gives the same rows; wall time is a net below it.
constexpr rlim_t kProcessorSeconds = 10;
constexpr std::chrono::duration<double> kWallTime{60};

/// solved: within kSolved, whatever the solver says. Else false_convergence if it claims to have solved it,
/// not_solved if it does not, and no_solution_reported if that is the truth.
std::string outcome(const Answer& answer, bool solvable) {
  if (answer.is_solved()) return "solved";
  if (answer.claims_solved) return "false_convergence";
  return solvable ? "not_solved" : "no_solution_reported";
}

/// The power of ten at or above the residual, not below kSolved: rounding differs between builds of the BLAS.
double magnitude(double residual) {
  if (residual <= kSolved) return kSolved;
  return std::pow(10.0, std::ceil(std::log10(residual)));
}

CaseResult result_of(const Answer& answer, const Task& task) {
  CaseResult result;
  Record record(summary_columns());
  record.set("solvable", std::string(task.solvable ? "yes" : "no"))
      .set("outcome", outcome(answer, task.solvable))
      .set("false_convergence", answer.claims_solved && !answer.is_solved() ? 1 : 0)
      .set("claim", answer.claim)
      .set("residual_at_most", magnitude(answer.residual))
      .set("iterations", answer.iterations);
  if (answer.evaluations > 0) record.set("evaluations", answer.evaluations);
  record.set("stages", answer.stages)
      .set("problems", answer.problems)
      .set("solved_problems", answer.solved_problems);
  Record timing(timing_columns());
  timing.set("solve_s", answer.solve_s).set("total_s", answer.total_s);
  result.tables = {{record.row()}, {timing.row()}};
  return result;
}

/// A case that gave no answer; its row still says whether there is a solution.
CaseResult without_answer(CaseStatus status, const std::string& why, const std::string& reason,
                          const Task& task) {
  Record record(summary_columns());
  record.set("solvable", std::string(task.solvable ? "yes" : "no")).set("outcome", why);
  return {status, reason, {{record.row()}}};
}

std::string to_text(const Answer& answer) {
  return fmt::format("{} {} {} {} {} {} {} {} {}\n{}", answer.claims_solved ? 1 : 0, answer.residual,
                     answer.iterations, answer.evaluations, answer.stages, answer.problems,
                     answer.solved_problems, answer.solve_s, answer.total_s, answer.claim);
}

Answer from_text(const std::string& text) {
  Answer answer;
  std::istringstream stream(text);
  std::string residual;
  stream >> answer.claims_solved >> residual >> answer.iterations >> answer.evaluations >> answer.stages >>
      answer.problems >> answer.solved_problems >> answer.solve_s >> answer.total_s;
  answer.residual = std::strtod(residual.c_str(), nullptr);  // which may be "inf"
  stream.ignore(1);
  std::getline(stream, answer.claim);
  return answer;
}

void drop_output() {
  const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null < 0) return;
  ::dup2(null, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
}

bool is_siconos(const std::string& solver) { return solver.starts_with("siconos"); }

void limit_processor_time() {
  constexpr rlimit kLimit{kProcessorSeconds, kProcessorSeconds + 1};
  ::setrlimit(RLIMIT_CPU, &kLimit);
}

/// Whether the system ended the process because of that limit.
bool used_up_its_time(const IsolatedResult& result) {
  return result.outcome == Outcome::timed_out ||
         (result.outcome == Outcome::crashed &&
          result.text.find(fmt::format("signal {} ", SIGXCPU)) != std::string::npos);
}

/// Those that solve steps, and take no more than some seconds for a trajectory.
bool is_for_trajectories(const std::string& solver) {
  return solver == "implicit_stepper" || solver == "elimination" || solver == "path_newton" ||
         solver.starts_with("siconos_mcp");
}

CaseResult run(const std::string& solver, const Task& task) {
  const auto work = [&] {
    limit_processor_time();
    if (!is_siconos(solver)) return to_text(solve_by_ours(solver, task));
    drop_output();
    return to_text(solve_by_siconos(solver, task));
  };
  const IsolatedResult isolated = run_isolated(work, kWallTime);
  if (used_up_its_time(isolated)) {
    const std::string limit = fmt::format("no answer within {} s of processor time", kProcessorSeconds);
    return without_answer(CaseStatus::failed, "time_limit", limit, task);
  }
  switch (isolated.outcome) {
    case Outcome::finished:
      return result_of(from_text(isolated.text), task);
    case Outcome::unsupported:
      return without_answer(CaseStatus::unsupported, "", isolated.text, task);
    case Outcome::crashed:
      return without_answer(CaseStatus::failed, "crashed", isolated.text, task);
    default:
      return without_answer(CaseStatus::failed, "not_solved", isolated.text, task);
  }
}

}  // namespace

const std::vector<std::string>& summary_columns() {
  static const std::vector<std::string> columns = {
      "solvable",    "outcome", "false_convergence", "claim",          "residual_at_most", "iterations",
      "evaluations", "stages",  "problems",          "solved_problems"};
  return columns;
}

const std::vector<std::string>& timing_columns() {
  static const std::vector<std::string> columns = {"solve_s", "total_s"};
  return columns;
}

bool is_for_family(const std::string& solver, const std::string& family) {
  if (family == "trajectory") return is_for_trajectories(solver);
  if (solver == "implicit_stepper") return false;
  if (solver == "elimination") return family == "step";
  if (solver.starts_with("siconos_fc3d")) return family == "frozen_step";
  const bool is_step = family == "step" || family == "frozen_step";
  if (solver == "lemke" || solver == "siconos_lemke" || solver.starts_with("siconos_ncp")) return !is_step;
  return true;
}

bool is_for_task(const std::string& solver, const Task& task) {
  if (solver == "implicit_stepper" && task.start != "extrapolated") return false;
  return is_for_family(solver, task.family);
}

Case make_case(const std::string& solver, std::shared_ptr<const Task> task) {
  Case one;
  one.id = {task->problem,
            solver,
            "",
            {task->family, task->item > 0 ? harness::number_cell(task->item) : "",
             harness::number_cell(static_cast<long>(task->size())), task->start},
            task->h,
            std::numeric_limits<double>::quiet_NaN()};
  one.cost =
      static_cast<double>(task->size()) * static_cast<double>(std::max<std::size_t>(task->parts.size(), 1));
  if (is_siconos(solver) && siconos_version().empty()) {
    one.run = [task] {
      return without_answer(CaseStatus::skipped, "", "the program was built without Siconos", *task);
    };
    return one;
  }
  if (is_siconos(solver)) one.engine_version = siconos_version();
  one.run = [solver, task] { return run(solver, *task); };
  return one;
}

}  // namespace touchstone::solver_comparison
