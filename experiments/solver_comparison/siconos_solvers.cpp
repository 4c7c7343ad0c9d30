#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <LinearComplementarityProblem.h>
#include <MCP_cst.h>
#include <MixedComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <lcp_cst.h>
#include <malloc.h>

#include <cstdlib>
#include <memory>

#include "baselines/registry.h"
#include "core/complementarity/residual.h"
#include "core/model/errors.h"
#include "experiments/solver_comparison/answer.h"
#include "experiments/solver_comparison/orthant_form.h"
#include "experiments/solver_comparison/timing.h"

// Debian's package leaves out the header of this problem. The layout is that of Siconos 4.4
// (numerics/src/NCP/NonlinearComplementarityProblem.h), as what newNCP() allocates and where ncp_driver() and
// its solvers read confirm.
struct NonlinearComplementarityProblem {
  unsigned n;
  void (*compute_F)(void* env, int n, double* z, double* f);
  void (*compute_nabla_F)(void* env, int n, double* z, NumericsMatrix* jacobian);
  NumericsMatrix* nabla_F;
  void* env;
};
static_assert(sizeof(void*) != 8 || sizeof(NonlinearComplementarityProblem) == 40);

extern "C" {
extern const char* const SICONOS_NCP_NEWTON_FB_FBLSA_STR;
extern const char* const SICONOS_NCP_NEWTON_MIN_FBLSA_STR;
extern const char* const SICONOS_NCP_PATHSEARCH_STR;
}

namespace touchstone::solver_comparison {

namespace {

/// Asked of every solver on its own measure, which differs from the natural residual by a factor of order 1.
constexpr double kTolerance = 0.1 * kSolved;
constexpr int kNewtonSteps = 1000;
constexpr int kSweeps = 20000;

struct DeleteOptions {
  void operator()(SolverOptions* options) const {
    solver_options_delete(options);
    std::free(options);
  }
};
using OptionsPointer = std::unique_ptr<SolverOptions, DeleteOptions>;

struct DeleteMatrix {
  void operator()(NumericsMatrix* matrix) const {
    NM_clear(matrix);
    std::free(matrix);
  }
};
using MatrixPointer = std::unique_ptr<NumericsMatrix, DeleteMatrix>;

MatrixPointer dense(const Eigen::MatrixXd& matrix) {
  MatrixPointer made(NM_create(NM_DENSE, static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols())));
  Eigen::Map<Eigen::MatrixXd>(made->matrix0, matrix.rows(), matrix.cols()) = matrix;
  return made;
}

OptionsPointer options(int solver, int iterations) {
  OptionsPointer made(solver_options_create(solver));
  made->dparam[SICONOS_DPARAM_TOL] = kTolerance;
  made->iparam[SICONOS_IPARAM_MAX_ITER] = iterations;
  return made;
}

void compute_f(void* env, int, double* z, double* f) {
  static_cast<OrthantForm*>(env)->evaluate(z, f, nullptr);
}
void compute_jacobian(void* env, int n, double* z, NumericsMatrix* jacobian) {
  Eigen::VectorXd f(n);
  static_cast<OrthantForm*>(env)->evaluate(z, f.data(), jacobian->matrix0);
}

/// One run of a solver: new options and start each time, of which only the driver is timed.
struct Run {
  int info = 0;
  long iterations = 0;
  double seconds = 0.0;
  Eigen::VectorXd x;
};

Run run_mcp(int solver, OrthantForm& form, const Eigen::VectorXd& start) {
  Run run{.x = start};
  const OptionsPointer opts = options(solver, kNewtonSteps);
  const auto n = static_cast<int>(form.size());
  const MatrixPointer jacobian(NM_create(NM_DENSE, n, n));
  ::MixedComplementarityProblem problem{.n1 = static_cast<int>(form.equations()),
                                        .n2 = static_cast<int>(form.inequalities()),
                                        .compute_Fmcp = &compute_f,
                                        .compute_nabla_Fmcp = &compute_jacobian,
                                        .nabla_Fmcp = jacobian.get(),
                                        .env = &form};
  Eigen::VectorXd f = Eigen::VectorXd::Zero(form.size());
  run.seconds = time_of([&] { run.info = mcp_driver(&problem, run.x.data(), f.data(), opts.get()); });
  run.iterations = opts->iparam[SICONOS_IPARAM_ITER_DONE];
  return run;
}

Run run_ncp(const char* solver, OrthantForm& form, const Eigen::VectorXd& start) {
  Run run{.x = start};
  OptionsPointer opts = options(solver_options_name_to_id(solver), kNewtonSteps);
  opts->iparam[SICONOS_IPARAM_PREALLOC] = 1;  // without it the path search crashes as it cleans up
  const auto n = static_cast<int>(form.size());
  MatrixPointer jacobian(NM_create(NM_DENSE, n, n));
  NonlinearComplementarityProblem problem{.n = static_cast<unsigned>(n),
                                          .compute_F = &compute_f,
                                          .compute_nabla_F = &compute_jacobian,
                                          .nabla_F = jacobian.get(),
                                          .env = &form};
  Eigen::VectorXd f = Eigen::VectorXd::Zero(form.size());
  run.seconds = time_of([&] { run.info = ncp_driver(&problem, run.x.data(), f.data(), opts.get()); });
  run.iterations = opts->iparam[SICONOS_IPARAM_ITER_DONE];
  // What the solver keeps between solves refers to itself in a way that its own clean-up does not survive.
  static_cast<void>(opts.release());
  return run;
}

Run run_lcp(OrthantForm& form, const Eigen::VectorXd& start) {
  Run run{.x = start};
  const Eigen::Index n = form.size();
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd q(n), slack = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd m(n, n);
  form.evaluate(origin.data(), q.data(), m.data());
  const MatrixPointer matrix = dense(m);
  const OptionsPointer opts = options(SICONOS_LCP_LEMKE, kSweeps);
  LinearComplementarityProblem problem{static_cast<int>(n), matrix.get(), q.data()};
  run.seconds = time_of(
      [&] { run.info = linearComplementarity_driver(&problem, run.x.data(), slack.data(), opts.get()); });
  run.iterations = opts->iparam[SICONOS_IPARAM_ITER_DONE];
  return run;
}

Run run_friction(int solver, bool sweeps, const problems::FrozenContactProblem& frozen,
                 const Eigen::VectorXd& start) {
  Run run{.x = start};
  const OptionsPointer opts = options(solver, sweeps ? kSweeps : kNewtonSteps);
  const MatrixPointer matrix = dense(frozen.w());
  Eigen::VectorXd q = frozen.q(), mu = frozen.mu(), u = Eigen::VectorXd::Zero(q.size());
  FrictionContactProblem problem{3, frozen.contacts(), matrix.get(), q.data(), mu.data()};
  run.seconds = time_of([&] { run.info = fc3d_driver(&problem, run.x.data(), u.data(), opts.get()); });
  run.iterations = opts->iparam[SICONOS_IPARAM_ITER_DONE];
  return run;
}

/// Runs once for the answer, and again for the time if that was short.
template <typename Solve, typename Back>
Answer answer_of(CountingProblem& problem, const Solve& solve, const Back& back) {
  problem.restart();
  const Run run = solve();
  Answer answer;
  answer.evaluations = problem.count();
  answer.claims_solved = run.info == 0;
  answer.claim = run.info == 0 ? "solved" : fmt::format("info {}", run.info);
  answer.residual = natural_residual(problem, back(run.x)).value;
  answer.iterations = run.iterations;
  answer.solve_s = typical_time(run.seconds, [&] { return solve().seconds; });
  return answer;
}

/// The friction solvers: key, id and whether an iteration is a sweep.
struct FrictionSolver {
  const char* key;
  int id;
  bool sweeps;
};
constexpr FrictionSolver kFrictionSolvers[] = {
    {"siconos_fc3d_admm", SICONOS_FRICTION_3D_ADMM, true},
    {"siconos_fc3d_nsgs", SICONOS_FRICTION_3D_NSGS, true},
    {"siconos_fc3d_nsn_ac", SICONOS_FRICTION_3D_NSN_AC, false},
    {"siconos_fc3d_nsn_fb", SICONOS_FRICTION_3D_NSN_FB, false},
    {"siconos_fc3d_nsn_nm", SICONOS_FRICTION_3D_NSN_NM, false},
};

/// OpenBLAS, where that is what is loaded: threads cost more than they bring at these sizes.
void use_one_thread() {
  // POSIX makes the conversion of what dlsym() gives to a function's address a valid one.
  if (void* symbol = ::dlsym(RTLD_DEFAULT, "openblas_set_num_threads"); symbol != nullptr)
    reinterpret_cast<void (*)(int)>(symbol)(1);
}

/// The path search reads storage that it never wrote, so that its answers depend on what the process did
/// before. With this all storage from malloc() is zero at first, as far as glibc lets one ask for that: what
/// it keeps aside of small blocks that were freed would come back as it is, and is therefore used up (and
/// lost, to a process that ends with the solve).
void clear_future_storage() {
  constexpr std::size_t kLargestKept = 1032, kStep = 16, kKeptOfEach = 7;
  for (std::size_t size = 24; size <= kLargestKept; size += kStep) {
    for (std::size_t i = 0; i < kKeptOfEach; ++i) {
      void* volatile lost = std::malloc(size);
      static_cast<void>(lost);
    }
  }
  ::mallopt(M_PERTURB, 0xff);
}

Answer solve_friction(const FrictionSolver& solver, const Task& task,
                      const MixedComplementarityProblem& problem) {
  if (!task.frozen) throw Unsupported("it is no frictional contact problem");
  CountingProblem counting(problem);
  return answer_of(
      counting, [&] { return run_friction(solver.id, solver.sweeps, *task.frozen, task.z); },
      [](const Eigen::VectorXd& reactions) { return reactions; });
}

}  // namespace

std::string siconos_version() { return find_method<3>("siconos_nsn").version(); }

Answer solve_by_siconos(const std::string& solver, const Task& task) {
  numerics_set_verbose(0);
  use_one_thread();
  const auto problem = task.make();
  for (const FrictionSolver& one : kFrictionSolvers) {
    if (solver == one.key) return solve_friction(one, task, *problem);
  }
  CountingProblem counting(*problem);
  OrthantForm form(counting);
  const Eigen::VectorXd start = form.from(task.z);
  const auto back = [&](const Eigen::VectorXd& x) { return form.to(x); };
  const auto answer = [&](const auto& run) { return answer_of(counting, run, back); };
  if (solver == "siconos_mcp_fb")
    return answer([&] { return run_mcp(SICONOS_MCP_NEWTON_FB_FBLSA, form, start); });
  if (solver == "siconos_mcp_min")
    return answer([&] { return run_mcp(SICONOS_MCP_NEWTON_MIN_FBLSA, form, start); });
  if (form.equations() > 0) throw Unsupported("the problem has equations");
  if (solver == "siconos_lemke") {
    if (!task.linear) throw Unsupported("the problem is not linear");
    return answer([&] { return run_lcp(form, start); });
  }
  if (solver == "siconos_ncp_path_search") clear_future_storage();
  const char* name = solver == "siconos_ncp_fb"    ? SICONOS_NCP_NEWTON_FB_FBLSA_STR
                     : solver == "siconos_ncp_min" ? SICONOS_NCP_NEWTON_MIN_FBLSA_STR
                                                   : SICONOS_NCP_PATHSEARCH_STR;
  return answer([&] { return run_ncp(name, form, start); });
}

}  // namespace touchstone::solver_comparison
