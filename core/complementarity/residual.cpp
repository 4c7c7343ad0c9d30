#include "core/complementarity/residual.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace touchstone {

NaturalResidual natural_residual(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                 const Eigen::VectorXd& z, const Eigen::VectorXd& f) {
  const Eigen::Index n = z.size();
  assert(lower.size() == n && upper.size() == n && f.size() == n);
  NaturalResidual worst;
  if (n > 0) worst.worst_row = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double zi = z[i];
    const double target = zi - f[i];
    // Not std::clamp: an infinite target must not hide behind a finite bound, hence the test before.
    if (!std::isfinite(target)) return {std::numeric_limits<double>::infinity(), i};
    const double projected = target < lower[i] ? lower[i] : (target > upper[i] ? upper[i] : target);
    const double distance = std::abs(zi - projected);
    if (distance > worst.value) worst = {distance, i};
  }
  return worst;
}

NaturalResidual natural_residual(const MixedComplementarityProblem& problem, const Eigen::VectorXd& z) {
  Eigen::VectorXd f(problem.size());
  problem.evaluate(z, f, nullptr);
  return natural_residual(problem.lower(), problem.upper(), z, f);
}

}  // namespace touchstone
