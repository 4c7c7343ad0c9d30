#include "baselines/engines/principal_axes.h"

#include <Eigen/Eigenvalues>

namespace touchstone::engines {

PrincipalInertia principal_inertia(const Inertia<3>& inertia) {
  if (inertia.isDiagonal()) return {Eigen::Quaterniond::Identity(), inertia.diagonal()};
  const Eigen::SelfAdjointEigenSolver<Inertia<3>> solver(inertia);
  Matrix<3> axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  return {Eigen::Quaterniond(axes).normalized(), solver.eigenvalues()};
}

}  // namespace touchstone::engines
