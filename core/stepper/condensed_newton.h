#pragma once

#include <array>
#include <vector>

#include "core/complementarity/report.h"
#include "core/stepper/condensed_system.h"
#include "core/stepper/contact_relaxation.h"
#include "core/stepper/contact_sweeps.h"
#include "core/stepper/interior_path.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

struct CondensedOptions {
  /// Solved if the natural residual of the whole step problem is at most this; > 0, in its units.
  double tolerance = 1e-13;
  int max_iterations = 100;  ///< Newton steps; >= 1
  /// What rounding leaves is solved too, once a search has got no further, and no other one is tried; >= 0.
  /// The report then says why the search ended.
  double acceptable = 0.0;
};

/// A semismooth Newton method for StepProblem on the condensed system (condensed_system.h): same unknowns,
/// rows, solutions and residual as the full mixed problem; only the linear algebra differs.
///
/// Several searches, the next where the last one fails: full steps with the active set of the minimum
/// function, which nearly always converge within a few; continuation in a smoothing of everything that is not
/// differentiable (smoothed_search.cpp), which finds the active set of piles near rest, where contacts
/// between stick and slip are many; a line search on the merit of Fischer and Burmeister's function; and all
/// of these from where Gauss-Seidel sweeps lead (contact_sweeps.h), with closest points found anew where a
/// step loses them. What is left then is for the full problem's solvers. Problems of many contacts are first
/// relaxed (contact_relaxation.h), which mostly solves them without a Newton step; where that ends, near
/// rest, an interior-point method goes on (interior_search.cpp).
template <int Dim>
class CondensedNewton {
 public:
  explicit CondensedNewton(const CondensedOptions& options) : options_(options) {}

  /// @param z  start on entry, at least problem.size() entries, in the projection form of friction; the
  ///           solution if the report says so, else wherever the search ended
  [[nodiscard]] SolveReport solve(StepProblem<Dim>& problem, Eigen::VectorXd& z);
  /// From a start near a solution: searches from there alone.
  [[nodiscard]] SolveReport finish(StepProblem<Dim>& problem, Eigen::VectorXd& z);
  /// From a solution as good as rounding lets a search end with, to one that also holds under load (see
  /// StepProblem::expect_load): Newton steps go around among solutions of one rounding error, and the best of
  /// them is taken. Nothing is done where loads are usual.
  [[nodiscard]] SolveReport settle(StepProblem<Dim>& problem, Eigen::VectorXd& z);
  /// From a solution whose loads are heavy although nothing asks for them (a body that sticks between others,
  /// each of which takes what the other one gives), to one with less: from no impulses anew. The loads
  /// expected are then usual ones again.
  [[nodiscard]] SolveReport relieve(StepProblem<Dim>& problem, Eigen::VectorXd& z);

 private:
  /// How one search goes about it.
  struct Strategy {
    /// Complementarity by Fischer & Burmeister's function, and a nonmonotone line search on 1/2 |Phi|^2;
    /// otherwise by the active set of the minimum function, and full steps.
    bool line_search = false;
    bool restores = false;  ///< finds closest points anew where a step loses them
    bool follows = false;   ///< brings closest points after a trial step that loses them: follow_points()
    bool damps = false;     ///< holds on to the contacts' impulses
    double hold = 0.0;      ///< see CondensedForm
    int limit = 0;          ///< of Newton steps
  };

  /// One value of the smoothing, and how the next one follows from it.
  struct Stage {
    double solved = 0.0;  ///< the last smoothing whose problem was solved; 0: none yet
    double ratio = 0.4;   ///< of the next one to it
    int steps = 0;        ///< Newton steps spent on the current one
  };

  /// What is tried where the search from the given start fails.
  struct Rescue {
    enum class Search { smoothed, line_search, full_steps };
    int sweeps = 0;          ///< of Gauss-Seidel, for a start
    bool from_cold = false;  ///< with closest points in the middle of flat patches, and not where they were
    Search search = Search::smoothed;
    bool damps = false;
  };
  static const std::array<Rescue, 15> kRescues;  ///< in this order

  void bind(StepProblem<Dim>& problem);
  void set_strategy(const Strategy& strategy);
  [[nodiscard]] SolveReport search(const Strategy& strategy, Eigen::VectorXd& z);
  [[nodiscard]] SolveReport report_of(SolveStatus status, const SolveReport& search) const;
  [[nodiscard]] bool advance(bool chord, int iteration, Eigen::VectorXd& z);
  [[nodiscard]] bool restore(Eigen::VectorXd& z);
  [[nodiscard]] SolveReport approach(StepProblem<Dim>& problem, Eigen::VectorXd& z);
  [[nodiscard]] SolveReport rescue(const Rescue& rescue, Eigen::VectorXd& z);
  [[nodiscard]] bool is_acceptable(const SolveReport& report) const {
    return report.solved() || report.residual <= options_.acceptable;
  }

  // interior_search.cpp
  [[nodiscard]] SolveReport interior_search(Eigen::VectorXd& z);
  void drop_idle_loads(SolveReport& report, Eigen::VectorXd& z);
  [[nodiscard]] SolveReport decide(double load, double hold, Eigen::VectorXd& z);

  // smoothed_search.cpp
  [[nodiscard]] SolveReport smoothed_search(Eigen::VectorXd& z);
  [[nodiscard]] bool sharpen(Stage& stage, Eigen::VectorXd& z);
  [[nodiscard]] bool retreat(Stage& stage, Eigen::VectorXd& z);
  [[nodiscard]] double smoothing() const { return system_.form().smoothing; }
  void set_smoothing(double smoothing);
  void follow_points(Eigen::VectorXd& z);
  void follow(std::size_t i, Eigen::VectorXd& z);

  CondensedOptions options_;
  StepProblem<Dim>* problem_ = nullptr;
  CondensedSystem<Dim> system_;
  ContactSweeps<Dim> sweeps_;
  ContactRelaxation<Dim> relaxation_;
  InteriorPath<Dim> interior_;
  Strategy strategy_;
  Eigen::VectorXd start_, trial_, best_;
  Eigen::VectorXd relaxed_;            ///< where rounds of sweeps ended
  std::vector<double> recent_merits_;  ///< of the line search
};

}  // namespace touchstone
