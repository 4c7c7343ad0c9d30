#pragma once

#include <functional>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/stepper/central_path.h"
#include "core/stepper/condensed_newton.h"
#include "core/stepper/implicit_options.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// The chain of searches by which the problem of one island of a step is solved: elimination with its
/// rescues (condensed_newton.h), Newton's methods from points of central paths (central_path.h), and the full
/// problem's solvers from warm and from cold starts.
template <int Dim>
class IslandSolver {
 public:
  /// Writes the start that is remembered into the problem's entries at the front of z, and chooses the
  /// problem's reference directions for it. May be called several times for one island.
  using Start = std::function<void(Eigen::VectorXd& z)>;

  using GivesWay = std::function<bool()>;

  explicit IslandSolver(const ImplicitOptions& options);

  /// @param problem  of the island, in the projection form of friction, as which it is left
  /// @param z        at least problem.size() entries; the solution if the report says so. The contacts of
  ///                 `problem` are then evaluated there.
  /// @param gives_way  asked where elimination fails: whether the searches after it, which may take long, are
  ///                   left out, because the caller has something better to try
  /// @return         with the iterations of all searches
  [[nodiscard]] SolveReport solve(StepProblem<Dim>& problem, const Start& start, Eigen::VectorXd& z,
                                  const GivesWay& gives_way);

  /// Whether the last island was given up because its central paths ran off to infinity.
  [[nodiscard]] bool is_jammed() const { return jammed_; }
  /// How many islands so far elimination left to the searches after it.
  [[nodiscard]] int fallbacks() const { return fallbacks_; }

 private:
  using Solver = ImplicitOptions::Solver;

  [[nodiscard]] SolveReport solve_condensed(const Start& start, Eigen::VectorXd& z,
                                            const GivesWay& gives_way);
  [[nodiscard]] SolveReport follow_central_paths(Eigen::VectorXd& z);
  [[nodiscard]] SolveReport solve_full_problem(Solver first, bool pivots, const Start& start,
                                               Eigen::VectorXd& z);
  [[nodiscard]] SolveReport run_solver(Solver solver, Eigen::VectorXd& z);
  void start_cold(FindClosest<Dim> find, Eigen::VectorXd& z);
  [[nodiscard]] bool choose_frames();
  [[nodiscard]] SolveReport solve_again(Eigen::VectorXd& z);

  ImplicitOptions options_;
  StepProblem<Dim>* problem_ = nullptr;
  CondensedNewton<Dim> condensed_;
  CentralPath<Dim> central_path_;
  PathNewton path_;
  SemismoothNewton semismooth_;
  bool jammed_ = false;
  int fallbacks_ = 0;
  Eigen::VectorXd best_z_;   ///< of the searches from central paths
  Eigen::VectorXd exact_z_;  ///< of just the problem's length, for the full problem's solvers
};

}  // namespace touchstone
