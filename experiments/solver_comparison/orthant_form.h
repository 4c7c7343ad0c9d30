#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/complementarity/problem.h"

namespace touchstone::solver_comparison {

/// A mixed complementarity problem in the form that Siconos takes: free unknowns with equations first, then
/// unknowns x >= 0. A bound is moved to 0 (z = l + x, or z = u - x with the row's sign turned); an unknown
/// between two bounds has another one beside it:
///   0 <= z - l _|_ F + v >= 0,  0 <= v _|_ u - z >= 0.
class OrthantForm {
 public:
  /// @param problem  must outlive the form
  explicit OrthantForm(const MixedComplementarityProblem& problem);

  [[nodiscard]] Eigen::Index size() const { return free_ + inequalities(); }
  [[nodiscard]] Eigen::Index equations() const { return free_; }
  [[nodiscard]] Eigen::Index inequalities() const {
    return static_cast<Eigen::Index>(parts_.size()) - free_ + boxed_;
  }

  /// x of z, put into the bounds; the unknowns beside boxed ones balance rows that are negative there.
  [[nodiscard]] Eigen::VectorXd from(const Eigen::VectorXd& z);
  [[nodiscard]] Eigen::VectorXd to(const Eigen::VectorXd& x) const;

  /// size() entries each; jacobian column-major, size() x size(), or null.
  void evaluate(const double* x, double* f, double* jacobian);
  void evaluate_jacobian(const double* x, double* jacobian) { evaluate(x, unused_.data(), jacobian); }

 private:
  void transform_jacobian(double* jacobian) const;

  /// Unknown z_index = offset + sign x, and where the unknown beside it stands, -1 if it has none.
  struct Part {
    Eigen::Index index = 0;
    double offset = 0.0;
    double sign = 1.0;
    Eigen::Index beside = -1;
    double width = 0.0;
  };

  const MixedComplementarityProblem& problem_;
  std::vector<Part> parts_;  ///< in the order of x
  Eigen::Index free_ = 0;
  Eigen::Index boxed_ = 0;
  bool as_it_is_ = true;  ///< x is z: nothing is reordered, moved, or turned
  Eigen::VectorXd z_, f_;
  Eigen::VectorXd unused_;  ///< rows that were not asked for
  Eigen::MatrixXd jacobian_;
};

}  // namespace touchstone::solver_comparison
