#include "core/complementarity/iterate.h"

#include <utility>

namespace touchstone {

void Iterate::swap(Iterate& other) noexcept {
  z.swap(other.z);
  f.swap(other.f);
  phi.swap(other.phi);
  jacobian.swap(other.jacobian);
  sparse_jacobian.swap(other.sparse_jacobian);
  std::swap(residual, other.residual);
  std::swap(merit, other.merit);
  std::swap(has_jacobian, other.has_jacobian);
  std::swap(is_sparse, other.is_sparse);
}

void Iterate::copy(const Iterate& other) {
  z = other.z;
  f = other.f;
  phi = other.phi;
  if (other.is_sparse) {
    sparse_jacobian = other.sparse_jacobian;
  } else {
    jacobian = other.jacobian;
  }
  residual = other.residual;
  merit = other.merit;
  has_jacobian = other.has_jacobian;
  is_sparse = other.is_sparse;
}

}  // namespace touchstone
