#pragma once

#include <Eigen/SparseCore>

#include "core/complementarity/problem.h"

namespace touchstone {

/// A mixed complementarity problem whose Jacobian is a sparse matrix: for many unknowns of which each row
/// holds few. Solvers then factorise it as such.
class SparseComplementarityProblem : public MixedComplementarityProblem {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Writes F(z), size() entries, and, unless `jacobian` is null, an element of its generalised Jacobian,
  /// size() x size(), compressed. Its pattern may be another one at each call. May allocate.
  virtual void evaluate_sparse(const Eigen::VectorXd& z, Eigen::VectorXd& f, Matrix* jacobian) const = 0;

  [[nodiscard]] const SparseComplementarityProblem* sparse() const final { return this; }

  /// The same with a dense matrix, for whoever wants one.
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const final {
    if (jacobian == nullptr) return evaluate_sparse(z, f, nullptr);
    Matrix sparse;
    evaluate_sparse(z, f, &sparse);
    *jacobian = sparse;
  }
};

}  // namespace touchstone
