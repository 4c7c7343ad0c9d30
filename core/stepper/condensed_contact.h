#pragma once

#include <vector>

#include "core/complementarity/dense_lu.h"
#include "core/stepper/condensed_part.h"
#include "core/stepper/point_elimination.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// A contact in CondensedSystem: its rows at the current z, and the elimination of its closest points and
/// multipliers (static condensation, by a Schur complement), whose rows hold no impulse.
///
/// Where the closest points are not determined by the bodies' poses alone (flat on flat) elimination is
/// singular: such a contact keeps its points among what is solved together.
template <int Dim>
class CondensedContact {
 public:
  /// Number of a contact's impulses: (p_f, p_n).
  static constexpr int kImpulses = Dimension<Dim>::friction + 1;

  /// Becomes contact i of `problem`, which must outlive the use. Makes room for any step of it, so that the
  /// first one that needs it allocates nothing.
  void bind(StepProblem<Dim>& problem, std::size_t i);

  /// The contact's rows at z, with its part of the natural residual and of the merit; sigma = |w| goes into
  /// z.
  void evaluate(const CondensedForm& form, Eigen::VectorXd& z, ResidualAndMerit& total);
  /// Of the contact's closest points and multipliers where it was evaluated last.
  [[nodiscard]] double geometry_residual() const { return geometry_residual_; }
  /// What evaluate() left: rows, without those that complementarity puts in their places.
  [[nodiscard]] const StepBlock<Dim>& block() const { return part_.block; }

  /// Linear equations at z, where the contact was evaluated last, with closest points eliminated: the Schur
  /// complement stands in the rows and columns of the block that are kept, which are listed with their
  /// places.
  /// @param hold          added to the diagonal of the friction and normal rows
  /// @param reduced_size  of the reduced system so far; grows by what is kept
  void condense(const CondensedForm& form, double hold, const Eigen::VectorXd& z, Eigen::Index& reduced_size);
  /// After condense() at an earlier z: the rows at z, where the contact was evaluated last, in its equations.
  void update_rows(const CondensedForm& form, const Eigen::VectorXd& z) { set_rows(form, z, false); }
  /// Block, kept unknowns and places for the reduced matrix.
  [[nodiscard]] const CondensedPart<Dim>& part() const { return part_; }
  /// Adds the contact's part to the right side of the reduced system, where bodies' rows stand already.
  void add_right_side(Eigen::VectorXd& right_side);
  /// Step of the contact's own unknowns, in z, from the solution of the reduced system.
  void expand(const Eigen::VectorXd& solution, Eigen::VectorXd& step) const;

  /// Residual of the rows of closest points and multipliers alone at z, in this form; 2 where they satisfy
  /// their rows and are no closest points (StepProblem::is_spurious()).
  [[nodiscard]] double points_residual(const CondensedForm& form, const Eigen::VectorXd& z);
  /// A Newton step of closest points and multipliers alone, after points_residual() at the same z. False if
  /// singular; z is then as it was.
  [[nodiscard]] bool points_step(const CondensedForm& form, Eigen::VectorXd& z);

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kFriction = Dimension<Dim>::friction;

  void choose_rows(const CondensedForm& form, const Eigen::VectorXd& z);
  void set_rows(const CondensedForm& form, const Eigen::VectorXd& z, bool derivatives);
  void add_hold(double hold);
  void list_points();
  void list_kept(Eigen::Index& reduced_size);
  void fill_eliminated();
  void factor_points(Eigen::Index& reduced_size);
  void find_response();
  void subtract_response();
  void add_motions();
  void solve_points(double* x);
  [[nodiscard]] Eigen::Index column_in_z(Eigen::Index unknown) const;

  StepProblem<Dim>* problem_ = nullptr;
  std::size_t i_ = 0;
  double gap_weight_ = 1.0;  ///< makes a gap the velocity of a step that closes it, to compare p_n with
  CondensedPart<Dim> part_;
  double geometry_residual_ = 0.0;
  bool touching_ = false;         ///< the gap row stands
  bool loaded_ = false;           ///< the impulse is among what is solved together
  bool regular_ = false;          ///< the closest points follow from the poses
  bool keeps_points_ = false;     ///< they are among what is solved together
  bool by_motion_ = false;        ///< the points are eliminated in closed form,
  PointElimination<Dim> points_;  ///< by this
  MotionJacobian<Dim> motions_;
  typename PointElimination<Dim>::Motion rest_;  ///< for no motion of the kept unknowns, negative
  std::vector<bool> active_;                     ///< inequalities whose row stands
  std::vector<Eigen::Index> eliminated_;         ///< of the block's unknowns
  DenseLu lu_;                                   ///< of the eliminated rows and unknowns
  std::vector<double> response_;                 ///< - d eliminated / d nu', row after row
  Eigen::VectorXd offset_;  ///< of the eliminated unknowns, for no motion of the kept ones
  Eigen::VectorXd column_, scratch_;
};

}  // namespace touchstone
