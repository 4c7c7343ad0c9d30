#pragma once

#include <vector>

#include "core/complementarity/dense_lu.h"
#include "core/complementarity/report.h"
#include "core/stepper/contact_sweeps.h"
#include "core/stepper/reduced_system.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

struct CondensedOptions {
  /// Solved if the natural residual of the whole step problem is at most this; > 0, in its units.
  double tolerance = 1e-13;
  int max_iterations = 100;  ///< Newton steps; >= 1
};

/// A semismooth Newton method for StepProblem that eliminates before it solves: sigma = |w|, then in each
/// contact its closest points (and multipliers), whose rows hold no impulse, so that what is left to solve
/// together is the bodies' velocities with the impulses (p_f, p_n) of the contacts that touch. Same unknowns,
/// rows, solutions and residual as the full mixed problem; only the linear algebra differs.
///
/// Where the closest points are not determined by the bodies' poses alone (flat on flat) elimination is
/// singular: such a contact keeps its points among what is solved together.
///
/// Three searches, each from the same start, the next where the last one fails: full steps with the active
/// set of the minimum function, which nearly always converge within a few; a line search on the merit of
/// Fischer and Burmeister's function; and full steps again from where Gauss-Seidel sweeps lead
/// (contact_sweeps.h), with closest points found anew where a step loses them. What is left then is for the
/// full problem's solvers.
template <int Dim>
class CondensedNewton {
 public:
  explicit CondensedNewton(const CondensedOptions& options) : options_(options) {}

  /// @param z  start on entry, at least problem.size() entries, in the projection form of friction; the
  ///           solution if the report says so, else wherever the search ended
  [[nodiscard]] SolveReport solve(StepProblem<Dim>& problem, Eigen::VectorXd& z);

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kFriction = Dimension<Dim>::friction;

  /// How one search goes about it.
  struct Strategy {
    /// Complementarity by Fischer & Burmeister's function, and a nonmonotone line search on 1/2 |Phi|^2;
    /// otherwise by the active set of the minimum function, and full steps.
    bool line_search = false;
    bool restores = false;  ///< finds closest points anew where a step loses them
    int limit = 0;          ///< of Newton steps
  };

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

  void make_room_for_problem();
  [[nodiscard]] SolveReport search(const Strategy& strategy, Eigen::VectorXd& z);
  [[nodiscard]] int approach(Eigen::VectorXd& z);
  void evaluate(Eigen::VectorXd& z);
  void judge(Element& element, std::size_t i, Eigen::VectorXd& z);
  void account(double value, Eigen::Index row);
  void choose_rows(Element& element, std::size_t i, const Eigen::VectorXd& z);
  void set_rows(Element& element, std::size_t i, const Eigen::VectorXd& z, bool derivatives);
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
  Eigen::VectorXd momentum_;  ///< rows of the bodies
  Eigen::VectorXd solution_;  ///< of the reduced system
  Eigen::VectorXd step_;      ///< in z
  Eigen::VectorXd start_, trial_, scratch_, column_;
  std::vector<double> row_;
  Eigen::MatrixXd body_matrix_;
  std::vector<double> recent_merits_;
  double residual_ = 0.0;
  Eigen::Index worst_row_ = -1;
  double merit_ = 0.0;
  double gap_weight_ = 1.0;
  Strategy strategy_;
  int evaluations_ = 0;
  int factorisations_ = 0;
};

}  // namespace touchstone
