#pragma once

#include <Eigen/Core>
#include <string>

namespace touchstone {

class SparseComplementarityProblem;

/// A mixed complementarity problem: find z with  l <= z _|_ F(z) <= u, that is, row by row
///   z_i = l_i and F_i(z) >= 0,   or   l_i < z_i < u_i and F_i(z) = 0,   or   z_i = u_i and F_i(z) <= 0.
/// A row with infinite bounds on both sides is an equation and its z_i is free.
///
/// Rows and unknowns are to be scaled by the problem so that one tolerance means one thing for all of them.
class MixedComplementarityProblem {
 public:
  virtual ~MixedComplementarityProblem() = default;

  /// Number of unknowns, which is the number of rows.
  [[nodiscard]] virtual Eigen::Index size() const = 0;

  /// Bounds of z, size() entries each; -infinity and +infinity are allowed.
  [[nodiscard]] virtual const Eigen::VectorXd& lower() const = 0;
  [[nodiscard]] virtual const Eigen::VectorXd& upper() const = 0;

  /// Writes F(z), size() entries, and, unless `jacobian` is null, an element of its generalised Jacobian
  /// dF/dz, size() x size(), every entry. Both are already of the right size. Does not allocate. Where F is
  /// not defined the entries are not finite; a solver treats such a z as one it may not step to.
  virtual void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const = 0;

  /// This problem with its Jacobian as a sparse matrix, which a solver then prefers; null if it has none.
  [[nodiscard]] virtual const SparseComplementarityProblem* sparse() const { return nullptr; }

  /// What a row states, for messages: "gap of contact 2 (ball, ground)".
  [[nodiscard]] virtual std::string row_name(Eigen::Index row) const { return "row " + std::to_string(row); }
};

}  // namespace touchstone
