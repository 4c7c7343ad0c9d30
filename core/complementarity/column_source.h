#pragma once

#include <Eigen/Core>

namespace touchstone {

/// A square matrix that gives its columns on request, for problems whose matrix is never formed: that of a
/// contact problem, M = W^T A^-1 W, costs a solve with A a column, and few columns are ever asked for.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;

  [[nodiscard]] virtual Eigen::Index size() const = 0;

  /// Writes column j, size() entries, all of them.
  virtual void column(Eigen::Index j, Eigen::Ref<Eigen::VectorXd> out) const = 0;
};

}  // namespace touchstone
