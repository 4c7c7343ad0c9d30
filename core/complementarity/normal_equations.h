#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "core/complementarity/fischer_burmeister.h"
#include "core/complementarity/iterate.h"

namespace touchstone {

/// The regularised normal equations of a Newton step on Phi (Levenberg 1944, Marquardt 1963)
///   (H^T H + weight I) d = -H^T Phi,
/// H an element of the generalised Jacobian of Phi, dense or sparse as that of F is.
class NormalEquations {
 public:
  /// Takes the storage for n unknowns with a dense Jacobian, so that what follows allocates nothing.
  void reserve(Eigen::Index n);

  /// Forms them at a point that has its Jacobian.
  void form(FischerBurmeister& reformulation, const Iterate& at);
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }  ///< H^T Phi
  [[nodiscard]] double matrix_norm() const { return matrix_norm_; }            ///< of H, Frobenius
  [[nodiscard]] double largest_diagonal() const { return largest_diagonal_; }  ///< of H^T H

  /// @param weight  > 0. False if H^T H + weight I is not positive definite to working accuracy
  [[nodiscard]] bool solve(double weight, Eigen::VectorXd& step);

 private:
  bool is_sparse_ = false;
  Eigen::MatrixXd h_, normal_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  Eigen::SparseMatrix<double> sparse_h_, sparse_normal_, identity_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> sparse_cholesky_;
  Eigen::VectorXd gradient_;
  double matrix_norm_ = 0.0;
  double largest_diagonal_ = 0.0;
};

}  // namespace touchstone
