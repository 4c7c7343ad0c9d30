#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/complementarity/problem.h"
#include "core/stepper/step_problem.h"

namespace touchstone::problems {

/// The frictional contact problem of a step whose geometry is frozen at its start:
///   u = W r + q,  0 <= u_n + psi / h _|_ r_n >= 0,  and Coulomb's law between u_t and r_t in each contact,
/// as a mixed complementarity problem. Torsional friction is left out: it is the problem that solvers of
/// frictional contact (Siconos's FC3D) pose.
///
/// Unknowns, per contact: y (t, o, r; r held at 0), p, sigma, over m V and V as in StepProblem, with one m
/// for all contacts so that W is symmetric.
class FrozenContactProblem final : public MixedComplementarityProblem {
 public:
  static constexpr Eigen::Index kUnknowns = 5;
  static constexpr Eigen::Index kNormal = 3;

  /// The step as `step` poses it at its start. None if it has no contact, has joints, or
  /// a direction without friction (e_t or e_o = 0).
  [[nodiscard]] static std::optional<FrozenContactProblem> from(StepProblem<3> step);

  [[nodiscard]] Eigen::Index size() const override { return lower_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override;

  [[nodiscard]] int contacts() const { return static_cast<int>(mu_.size()); }
  // The data in the order n, t, o of each contact: what FC3D takes.
  [[nodiscard]] const Eigen::MatrixXd& w() const { return w_; }
  [[nodiscard]] const Eigen::VectorXd& q() const { return q_; }
  [[nodiscard]] const Eigen::VectorXd& mu() const { return mu_; }
  /// The point of this problem that has the reactions r (n, t, o), with sigma from the velocities that they
  /// lead to.
  [[nodiscard]] Eigen::VectorXd point_of(const Eigen::VectorXd& reactions) const;
  /// Reactions (n, t, o) of a point.
  [[nodiscard]] Eigen::VectorXd reactions_of(const Eigen::VectorXd& z) const;

 private:
  Eigen::MatrixXd w_;
  Eigen::VectorXd q_, mu_, lower_, upper_;
  double rho_ = 1.0;
};

}  // namespace touchstone::problems
