#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>

#include "core/complementarity/residual.h"

namespace touchstone {

/// A point of a search with all that is known there. Once it is the current one and not solved it has a
/// finite Jacobian.
struct Iterate {
  Eigen::VectorXd z, f, phi;
  Eigen::MatrixXd jacobian;                     ///< of a problem whose Jacobian is dense
  Eigen::SparseMatrix<double> sparse_jacobian;  ///< of one whose Jacobian is sparse
  NaturalResidual residual;
  double merit = 0.0;  ///< 1/2 |Phi(z)|^2; infinity where F is not finite
  bool has_jacobian = false;
  bool is_sparse = false;  ///< which of the two matrices is in use

  /// A sum is finite only if all terms are, and the quickest thing to ask.
  [[nodiscard]] bool has_finite_jacobian() const {
    return std::isfinite(is_sparse ? sparse_jacobian.coeffs().sum() : jacobian.sum());
  }

  // Neither allocates for a dense Jacobian, as copying or moving an empty sparse matrix would.
  void swap(Iterate& other) noexcept;
  void copy(const Iterate& other);
};

}  // namespace touchstone
