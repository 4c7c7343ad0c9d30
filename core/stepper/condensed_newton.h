#pragma once

#include <array>
#include <vector>

#include "core/complementarity/dense_lu.h"
#include "core/complementarity/report.h"
#include "core/stepper/contact_relaxation.h"
#include "core/stepper/contact_sweeps.h"
#include "core/stepper/fischer_burmeister.h"
#include "core/stepper/reduced_system.h"
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

/// A semismooth Newton method for StepProblem that eliminates before it solves: sigma = |w|, then in each
/// contact its closest points (and multipliers), whose rows hold no impulse, so that what is left to solve
/// together is the bodies' velocities with the impulses (p_f, p_n) of the contacts that touch. Same unknowns,
/// rows, solutions and residual as the full mixed problem; only the linear algebra differs.
///
/// Where the closest points are not determined by the bodies' poses alone (flat on flat) elimination is
/// singular: such a contact keeps its points among what is solved together.
///
/// Several searches, the next where the last one fails: full steps with the active set of the minimum
/// function, which nearly always converge within a few; continuation in a smoothing of everything that is not
/// differentiable (smoothed_search.cpp), which finds the active set of piles near rest, where contacts
/// between stick and slip are many; a line search on the merit of Fischer and Burmeister's function; and all
/// of these from where Gauss-Seidel sweeps lead (contact_sweeps.h), with closest points found anew where a
/// step loses them. What is left then is for the full problem's solvers.
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

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kFriction = Dimension<Dim>::friction;

  /// How one search goes about it.
  struct Strategy {
    /// Complementarity by Fischer & Burmeister's function, and a nonmonotone line search on 1/2 |Phi|^2;
    /// otherwise by the active set of the minimum function, and full steps.
    bool line_search = false;
    bool restores = false;  ///< finds closest points anew where a step loses them
    bool follows =
        false;           ///< closest points that a trial step loses are brought after it, by follow_points()
    bool damps = false;  ///< holds on to the contacts' impulses, see damp()
    int limit = 0;       ///< of Newton steps
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

  /// A joint at the current z.
  struct Joint {
    StepBlock<Dim> block;
    std::vector<Eigen::Index> kept;   ///< of the block's unknowns
    std::vector<Eigen::Index> place;  ///< of those kept in the reduced system
  };

  /// A contact at the current z.
  struct Element : Joint {
    double geometry_residual = 0.0;
    bool touching = false;                 ///< its gap row stands
    bool loaded = false;                   ///< its impulse is among what is solved together
    bool regular = false;                  ///< the closest points follow from the poses
    bool keeps_points = false;             ///< they are among what is solved together
    std::vector<bool> active;              ///< inequalities whose row stands
    std::vector<Eigen::Index> eliminated;  ///< of the block's unknowns
    DenseLu lu;                            ///< of the eliminated rows and unknowns
    std::vector<double> response;          ///< - d eliminated / d nu', row after row
    Eigen::VectorXd offset;                ///< of the eliminated unknowns, for no motion of the kept ones
  };

  void bind(StepProblem<Dim>& problem);
  void make_room_for_problem();
  [[nodiscard]] SolveReport search(const Strategy& strategy, Eigen::VectorXd& z);
  [[nodiscard]] int approach(Eigen::VectorXd& z);
  [[nodiscard]] SolveReport rescue(const Rescue& rescue, Eigen::VectorXd& z);
  [[nodiscard]] SolveReport smoothed_search(Eigen::VectorXd& z);
  [[nodiscard]] bool sharpen(Stage& stage, Eigen::VectorXd& z);
  [[nodiscard]] bool retreat(Stage& stage, Eigen::VectorXd& z);
  void set_smoothing(double smoothing, Eigen::VectorXd& z);
  void follow_points(Eigen::VectorXd& z);
  void follow(std::size_t i, Eigen::VectorXd& z);
  [[nodiscard]] double points_residual(std::size_t i, const Eigen::VectorXd& z);
  [[nodiscard]] bool points_step(std::size_t i, Eigen::VectorXd& z);
  [[nodiscard]] SolveReport report_of(SolveStatus status, const SolveReport& search) const;
  [[nodiscard]] bool is_acceptable(const SolveReport& report) const {
    return report.solved() || report.residual <= options_.acceptable;
  }
  void evaluate(Eigen::VectorXd& z);
  void judge(Element& element, std::size_t i, Eigen::VectorXd& z);
  void account(double value, Eigen::Index row);
  void choose_rows(Element& element, std::size_t i, const Eigen::VectorXd& z);
  void set_rows(Element& element, std::size_t i, const Eigen::VectorXd& z, bool derivatives);
  /// Whether faces and edges are chosen, and not part of the merit function's smooth terms.
  [[nodiscard]] bool by_active_set() const {
    return !strategy_.line_search || (strategy_.follows && smoothing_ == 0);
  }
  void damp(Element& element) const;
  void list_velocities(Joint& part) const;
  void list_unknowns(Element& element);
  void keep(Joint& part, Eigen::Index unknown);
  void fill_eliminated(Element& element);
  void solve_points(Element& element, double* x);
  void eliminate(Element& element);
  void condense(const Eigen::VectorXd& z);
  [[nodiscard]] bool factor(double regularisation);
  [[nodiscard]] bool newton_step(const Eigen::VectorXd& z);
  void chord_step(const Eigen::VectorXd& z);
  void solve_reduced();
  void expand();
  [[nodiscard]] bool restore(Eigen::VectorXd& z);
  [[nodiscard]] bool advance(bool chord, int iteration, Eigen::VectorXd& z);
  [[nodiscard]] Eigen::Index column_in_z(std::size_t i, Eigen::Index unknown) const;

  CondensedOptions options_;
  StepProblem<Dim>* problem_ = nullptr;
  std::vector<Element> elements_;
  std::vector<Joint> joints_;
  Eigen::Index reduced_size_ = 0;
  ReducedSystem reduced_;
  ContactSweeps<Dim> sweeps_;
  ContactRelaxation<Dim> relaxation_;
  Eigen::VectorXd momentum_;  ///< rows of the bodies
  Eigen::VectorXd solution_;  ///< of the reduced system
  Eigen::VectorXd step_;      ///< in z
  Eigen::VectorXd start_, trial_, best_, scratch_, column_;
  std::vector<double> row_;
  Eigen::MatrixXd body_matrix_;
  std::vector<double> recent_merits_;
  double residual_ = 0.0;
  Eigen::Index worst_row_ = -1;
  double merit_ = 0.0;
  double gap_weight_ = 1.0;
  Strategy strategy_;
  double smoothing_ = 0.0;  ///< tau, an impulse over m V; 0: the problem as it is
  int evaluations_ = 0;
  int factorisations_ = 0;
};

}  // namespace touchstone
