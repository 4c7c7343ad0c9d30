#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/complementarity/problem.h"
#include "core/stepper/step_problem.h"

namespace touchstone::problems {

/// The frictional contact problem of a step whose geometry is frozen at its start:
///   u = W r + q,   0 <= u_n _|_ r_n >= 0   (psi / h is part of q_n),
///   r_t the point of the disc |r_t| <= mu r_n that dissipates most against u_t,
/// as a mixed complementarity problem in r itself, without further unknowns: the friction rows are
///   r_t = proj(r_t - rho u_t) on that disc, for any rho > 0
/// (Alart & Curnier 1991), in y = E^-1 p_f and w = E v_f where e_t and e_o are not 1. Torsion is left out: it
/// is the problem that solvers of frictional contact (Siconos's FC3D) take.
///
/// Unknowns, per contact: r_n, r_t, r_o, over m V with one m for all contacts, so that W is symmetric; u over
/// V (StepProblem's scale).
class FrozenContactProblem final : public MixedComplementarityProblem {
 public:
  /// @param w   3 n x 3 n, symmetric positive semidefinite, in the order n, t, o of each contact
  /// @param mu  n entries, >= 0
  FrozenContactProblem(Eigen::MatrixXd w, Eigen::VectorXd q, Eigen::VectorXd mu);

  /// The step as `step` poses it at its start. None if it has no contact, has joints, or a
  /// direction without friction (e_t or e_o = 0).
  [[nodiscard]] static std::optional<FrozenContactProblem> from(StepProblem<3> step);

  [[nodiscard]] Eigen::Index size() const override { return lower_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override;

  [[nodiscard]] int contacts() const { return static_cast<int>(mu_.size()); }
  // The data, in the order n, t, o of each contact.
  [[nodiscard]] const Eigen::MatrixXd& w() const { return w_; }
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  [[nodiscard]] const Eigen::VectorXd& mu() const { return mu_; }

 private:
  void friction_rows(Eigen::Index contact, const Eigen::VectorXd& r, Eigen::VectorXd& f,
                     Eigen::MatrixXd* jacobian) const;

  Eigen::MatrixXd w_;
  Eigen::VectorXd q_, mu_, lower_, upper_;
  double rho_ = 1.0;
};

}  // namespace touchstone::problems
