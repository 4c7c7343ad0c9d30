#pragma once

#include "core/model/dimension.h"

namespace touchstone::engines {

/// An inertia as engines with diagonal inertias want it: I = axes diag(moments) axes^T.
struct PrincipalInertia {
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  ///< principal frame to body frame
  Vector<3> moments = Vector<3>::Zero();                     ///< [kg m^2]

  [[nodiscard]] Inertia<3> matrix() const {
    const Matrix<3> r = axes.toRotationMatrix();
    return r * moments.asDiagonal() * r.transpose();
  }
};

/// A diagonal inertia keeps the body's own axes, so that nothing is turned without need.
PrincipalInertia principal_inertia(const Inertia<3>& inertia);

}  // namespace touchstone::engines
