#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace touchstone {

/// The penalised Fischer-Burmeister reformulation of a mixed complementarity problem: Phi(z) = 0 exactly at
/// solutions.
///   phi(a, b) = weight (a + b - sqrt(a^2 + b^2)) + (1 - weight) max(a, 0) max(b, 0),   0 < weight <= 1
/// (Chen, Chen & Kanzow 2000; weight 1 is Fischer-Burmeister), zero exactly if a, b >= 0 and a b = 0. By the
/// bounds of the row (Billups 1995; De Luca, Facchinei & Kanzow 1996):
///   none: F      lower: phi(z - l, F)      upper: -phi(u - z, -F)      both: phi(z - l, -phi(u - z, -F))
class FischerBurmeister {
 public:
  /// The problem's bounds, which must outlive the use. @param weight  in (0, 1]
  void bind(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double weight);

  /// Writes Phi at z with F(z) = f; all of the problem's size.
  void evaluate(const Eigen::VectorXd& z, const Eigen::VectorXd& f, Eigen::VectorXd& phi) const;

  /// Writes an element  H = diag(d Phi_i / d z_i) + diag(d Phi_i / d F_i) J  of the generalised Jacobian of
  /// Phi, every entry. J is that of F. `h` may not overlap `jacobian`.
  void jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& f, const Eigen::MatrixXd& jacobian,
                Eigen::Map<Eigen::MatrixXd> h);
  /// The same for a sparse J. Allocates.
  void jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& f,
                const Eigen::SparseMatrix<double>& jacobian, Eigen::SparseMatrix<double>& h);

 private:
  void find_slopes(const Eigen::VectorXd& z, const Eigen::VectorXd& f);

  const Eigen::VectorXd* lower_ = nullptr;
  const Eigen::VectorXd* upper_ = nullptr;
  double weight_ = 1.0;
  Eigen::VectorXd by_z_, by_f_;
};

}  // namespace touchstone
