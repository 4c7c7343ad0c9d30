#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <LinearComplementarityProblem.h>
#include <MCP_cst.h>
#include <MixedComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <fmt/format.h>
#include <lcp_cst.h>

#include <cstdlib>
#include <memory>

#include "baselines/blas.h"
#include "baselines/registry.h"
#include "core/complementarity/residual.h"
#include "core/model/errors.h"
#include "experiments/solver_comparison/orthant_form.h"
#include "experiments/solver_comparison/siconos_path_search.h"
#include "experiments/solver_comparison/solving.h"
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

/// Asked of every solver on its own measure, which differs from the natural residual by a factor; looser if
/// that will do (measure()).
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

void compute_f(void* env, int, double* z, double* f) {
  static_cast<OrthantForm*>(env)->evaluate(z, f, nullptr);
}
void compute_jacobian(void* env, int, double* z, NumericsMatrix* jacobian) {
  static_cast<OrthantForm*>(env)->evaluate_jacobian(z, jacobian->matrix0);
}

/// How a solver is called.
struct Setting {
  int id = 0;
  int iterations = kNewtonSteps;
  /// Whether it may keep its workspace from solve to solve, as in a simulation. Otherwise its options are
  /// made anew each time, which is not part of the time.
  bool keeps_workspace = false;
  bool preallocates = false;  ///< must make its workspace a part of the options
  /// What it keeps refers to itself in a way that its own clean-up does not survive.
  bool leaks_options = false;
  bool forgets_first_f = false;  ///< see write_first_f()
};

/// Calls a driver of Siconos, all of which are called alike, for a problem in its own form.
template <typename Problem>
class Driver {
 public:
  using Function = int (*)(Problem*, double*, double*, SolverOptions*);

  Driver(Function function, const Setting& setting) : function_(function), setting_(setting) {}

  /// Makes ready what a solve needs, which is no part of its time.
  /// @param start  of the solve
  void prepare(Problem& problem, double tolerance, const Eigen::VectorXd& start) {
    if (!options_ || !setting_.keeps_workspace) make_options();
    options_->dparam[SICONOS_DPARAM_TOL] = tolerance;
    other_.setZero(start.size());
    if (setting_.forgets_first_f) {
      x_ = start;
      options_->iparam[SICONOS_IPARAM_MAX_ITER] = 0;
      static_cast<void>(function_(&problem, x_.data(), other_.data(), options_.get()));
      write_first_f(*options_, start, other_);
      options_->iparam[SICONOS_IPARAM_MAX_ITER] = setting_.iterations;
    }
  }

  /// @param x  the start on entry
  Answer operator()(Problem& problem, Eigen::VectorXd& x) {
    int info = 0;
    Answer answer;
    answer.solve_s = time_of([&] { info = function_(&problem, x.data(), other_.data(), options_.get()); });
    answer.claims_solved = info == 0;
    answer.claim = info == 0 ? "solved" : fmt::format("info {}", info);
    answer.iterations = options_->iparam[SICONOS_IPARAM_ITER_DONE];
    return answer;
  }

 private:
  void make_options() {
    if (setting_.leaks_options) static_cast<void>(options_.release());
    options_.reset(solver_options_create(setting_.id));
    options_->iparam[SICONOS_IPARAM_MAX_ITER] = setting_.iterations;
    if (setting_.keeps_workspace || setting_.preallocates) options_->iparam[SICONOS_IPARAM_PREALLOC] = 1;
  }

  Function function_;
  Setting setting_;
  OptionsPointer options_;
  Eigen::VectorXd other_;  ///< F, slack or velocities at x
  Eigen::VectorXd x_;      ///< where no iteration is done
};

/// What a problem in Siconos's form is made of, and refers to.
struct Bound {
  /// @param reorders  whether the unknowns are those of OrthantForm, and not the problem's own
  Bound(const Task& task, bool reorders)
      : problem(task.make()),
        counting(*problem),
        form(counting),
        start(reorders ? form.from(task.z) : task.z),
        back(reorders) {}
  Bound(const Bound&) = delete;

  /// One solve by the driver of a problem that refers to this.
  template <typename Problem>
  Answer solve(Driver<Problem>& driver, Problem& posed, double tolerance) {
    driver.prepare(posed, tolerance, start);
    counting.restart();
    x = start;
    Answer answer = driver(posed, x);
    answer.evaluations = counting.count();
    answer.residual = natural_residual(*problem, back ? form.to(x) : x).value;
    return answer;
  }

  std::unique_ptr<::touchstone::MixedComplementarityProblem> problem;
  CountingProblem counting;
  OrthantForm form;
  Eigen::VectorXd start, x;
  bool back = true;      ///< to the problem's own unknowns
  MatrixPointer matrix;  ///< the Jacobian, or data
  Eigen::VectorXd q, mu;
};

/// Solves by a driver the problem that `pose` makes of what is bound.
template <typename Problem, typename Pose>
Solving solving(std::shared_ptr<Bound> bound, typename Driver<Problem>::Function function,
                const Setting& setting, const Pose& pose) {
  return [bound, driver = std::make_shared<Driver<Problem>>(function, setting), pose](double tolerance) {
    Problem posed = pose(*bound);
    return bound->solve(*driver, posed, tolerance);
  };
}

std::shared_ptr<Bound> bind_function(const Task& task) {
  auto bound = std::make_shared<Bound>(task, true);
  const auto n = static_cast<int>(bound->form.size());
  bound->matrix.reset(NM_create(NM_DENSE, n, n));
  return bound;
}

Solving by_mcp(int id, const Task& task) {
  return solving<::MixedComplementarityProblem>(
      bind_function(task), &mcp_driver, {.id = id, .keeps_workspace = true}, [](Bound& bound) {
        return ::MixedComplementarityProblem{.n1 = static_cast<int>(bound.form.equations()),
                                             .n2 = static_cast<int>(bound.form.inequalities()),
                                             .compute_Fmcp = &compute_f,
                                             .compute_nabla_Fmcp = &compute_jacobian,
                                             .nabla_Fmcp = bound.matrix.get(),
                                             .env = &bound.form};
      });
}

Solving by_ncp(const char* name, const Task& task) {
  auto bound = bind_function(task);
  if (bound->form.equations() > 0) throw Unsupported("the problem has equations");
  return solving<NonlinearComplementarityProblem>(
      std::move(bound), &ncp_driver,
      // Without a workspace among its options the path search crashes as it cleans up.
      {.id = solver_options_name_to_id(name),
       .preallocates = true,
       .leaks_options = true,
       .forgets_first_f = name == SICONOS_NCP_PATHSEARCH_STR},
      [](Bound& posed) {
        return NonlinearComplementarityProblem{.n = static_cast<unsigned>(posed.form.size()),
                                               .compute_F = &compute_f,
                                               .compute_nabla_F = &compute_jacobian,
                                               .nabla_F = posed.matrix.get(),
                                               .env = &posed.form};
      });
}

Solving by_lemke(const Task& task) {
  auto bound = std::make_shared<Bound>(task, true);
  if (bound->form.equations() > 0) throw Unsupported("the problem has equations");
  if (!task.linear) throw Unsupported("the problem is not linear");
  const Eigen::Index n = bound->form.size();
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd m(n, n);
  bound->q.resize(n);
  bound->form.evaluate(origin.data(), bound->q.data(), m.data());
  bound->matrix = dense(m);
  return solving<LinearComplementarityProblem>(
      std::move(bound), &linearComplementarity_driver, {.id = SICONOS_LCP_LEMKE, .iterations = kSweeps},
      [](Bound& posed) {
        return LinearComplementarityProblem{static_cast<int>(posed.q.size()), posed.matrix.get(),
                                            posed.q.data()};
      });
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

Solving by_friction(const FrictionSolver& solver, const Task& task) {
  if (!task.frozen) throw Unsupported("it is no frictional contact problem");
  auto bound = std::make_shared<Bound>(task, false);
  bound->matrix = dense(task.frozen->w());
  bound->q = task.frozen->q();
  bound->mu = task.frozen->mu();
  return solving<FrictionContactProblem>(
      std::move(bound), &fc3d_driver, {.id = solver.id, .iterations = solver.sweeps ? kSweeps : kNewtonSteps},
      [](Bound& posed) {
        return FrictionContactProblem{3, static_cast<int>(posed.mu.size()), posed.matrix.get(),
                                      posed.q.data(), posed.mu.data()};
      });
}

Solving bind(const std::string& solver, const Task& task) {
  for (const FrictionSolver& one : kFrictionSolvers) {
    if (solver == one.key) return by_friction(one, task);
  }
  if (solver == "siconos_mcp_fb") return by_mcp(SICONOS_MCP_NEWTON_FB_FBLSA, task);
  if (solver == "siconos_mcp_min") return by_mcp(SICONOS_MCP_NEWTON_MIN_FBLSA, task);
  if (solver == "siconos_lemke") return by_lemke(task);
  if (solver == "siconos_ncp_fb") return by_ncp(SICONOS_NCP_NEWTON_FB_FBLSA_STR, task);
  if (solver == "siconos_ncp_min") return by_ncp(SICONOS_NCP_NEWTON_MIN_FBLSA_STR, task);
  return by_ncp(SICONOS_NCP_PATHSEARCH_STR, task);
}

}  // namespace

std::string siconos_version() { return find_method<3>("siconos_nsn").version(); }

Answer solve_by_siconos(const std::string& solver, const Task& task) {
  numerics_set_verbose(0);
  use_same_blas_everywhere();
  return measure_task(task, kTolerance, kLoosest, [&](const Task& one) { return bind(solver, one); });
}

}  // namespace touchstone::solver_comparison
