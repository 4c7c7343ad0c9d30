#pragma once

#include <Eigen/Core>

#include "core/complementarity/problem.h"

namespace touchstone {

/// How far a point is from solving a mixed complementarity problem, and in which row it is farthest.
struct NaturalResidual {
  double value = 0.0;  ///< >= 0, in the unit that the problem scaled its rows to; infinity if undefined
  Eigen::Index worst_row = -1;  ///< first row with that value; -1 of a problem without rows
};

/// The one judge of a solve: the natural residual
///   max_i | z_i - clamp(z_i - F_i(z), l_i, u_i) |,
/// zero exactly at the solutions (Facchinei & Pang 2003, Prop. 1.5.8 for a box). No solver keeps another
/// notion of "solved". An entry of z or F that is not finite makes the residual infinite, in its row. All
/// four vectors have the same size; l_i <= u_i.
[[nodiscard]] NaturalResidual natural_residual(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                               const Eigen::VectorXd& z, const Eigen::VectorXd& f);

/// The same with F evaluated afresh, for whoever holds nothing but a claimed solution. Allocates.
[[nodiscard]] NaturalResidual natural_residual(const MixedComplementarityProblem& problem,
                                               const Eigen::VectorXd& z);

}  // namespace touchstone
