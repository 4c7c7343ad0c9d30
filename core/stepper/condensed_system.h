#pragma once

#include <vector>

#include "core/stepper/condensed_contact.h"
#include "core/stepper/reduced_system.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// The linear algebra of a semismooth Newton method for StepProblem that eliminates before it solves: sigma =
/// |w|, then in each contact its closest points (and multipliers), whose rows hold no impulse, so that what
/// is left to solve together is the bodies' velocities with the impulses (p_f, p_n) of the contacts that
/// touch. Same unknowns, rows, solutions and residual as the full mixed problem.
///
/// Use: bind() and set_form(); evaluate(z), then newton_step(z) or chord_step(z) at the same z, and step().
/// z has at least as many entries as the problem, in the projection form of friction.
template <int Dim>
class CondensedSystem {
 public:
  /// Takes a problem, which must outlive the use, and makes room for any step of it, so that the first one
  /// that needs it allocates nothing. Counts begin anew.
  void bind(StepProblem<Dim>& problem);
  /// Holds from the next evaluate() on; the problem's smoothing is set to the form's.
  void set_form(const CondensedForm& form);
  [[nodiscard]] const CondensedForm& form() const { return form_; }

  /// Rows, natural residual and merit at z; sigma is eliminated here, into z.
  void evaluate(Eigen::VectorXd& z);
  /// Natural residual of the whole step problem, in StepProblem's units.
  [[nodiscard]] double residual() const { return total_.residual; }
  /// Row in z of the natural residual, -1 if that is 0.
  [[nodiscard]] Eigen::Index worst_row() const { return total_.worst_row; }
  /// 1/2 |Phi|^2 in the form that was set.
  [[nodiscard]] double merit() const { return total_.merit; }
  /// Natural residual of the closest points and multipliers of contact i alone.
  [[nodiscard]] double geometry_residual(std::size_t i) const { return contacts_[i].geometry_residual(); }

  /// Finds the Newton step at z, evaluated last. False if its system is singular.
  [[nodiscard]] bool newton_step(const Eigen::VectorXd& z);
  /// Finds a step with the matrix of the last Newton step and the rows at z, evaluated last.
  void chord_step(const Eigen::VectorXd& z);
  /// What either found, in z: the problem's size of entries at the front.
  [[nodiscard]] const Eigen::VectorXd& step() const { return step_; }

  /// See CondensedContact: contact i on its own.
  [[nodiscard]] double points_residual(std::size_t i, const Eigen::VectorXd& z) {
    return contacts_[i].points_residual(form_, z);
  }
  [[nodiscard]] bool points_step(std::size_t i, Eigen::VectorXd& z) {
    return contacts_[i].points_step(form_, z);
  }

  /// Since bind().
  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] int factorisations() const { return factorisations_; }

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;

  void evaluate_joints(const Eigen::VectorXd& z);
  void add_wrenches(const StepBlock<Dim>& block);
  void condense(const Eigen::VectorXd& z);
  [[nodiscard]] double hold() const;
  [[nodiscard]] bool factor(double regularisation);
  void solve_reduced();
  void expand();

  StepProblem<Dim>* problem_ = nullptr;
  CondensedForm form_;
  std::vector<CondensedContact<Dim>> contacts_;  ///< as many as any problem had; so are the joints
  std::vector<CondensedPart<Dim>> joints_;
  Eigen::Index reduced_size_ = 0;
  ReducedSystem reduced_;
  ResidualAndMerit total_;
  Eigen::VectorXd momentum_;  ///< rows of the bodies
  Eigen::VectorXd solution_;  ///< of the reduced system
  Eigen::VectorXd step_;      ///< in z
  int evaluations_ = 0;
  int factorisations_ = 0;
};

}  // namespace touchstone
