#pragma once

#include "core/model/dimension.h"

namespace touchstone {

/// Measure, mean position and second moments about it, of a solid of unit mass.
template <int Dim>
struct Moments {
  double measure = 0.0;                      ///< area [m^2], volume [m^3]
  Vector<Dim> center = Vector<Dim>::Zero();  ///< [m]
  Matrix<Dim> second = Matrix<Dim>::Zero();  ///< mean of (x - center)(x - center)^T [m^2]
};

}  // namespace touchstone
