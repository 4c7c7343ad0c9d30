#pragma once

#include <Eigen/Core>

namespace touchstone {

/// Grows a workspace to n entries at least; what it held may be lost. Does not allocate once the largest n
/// was seen.
inline void make_room(Eigen::VectorXd& vector, Eigen::Index n) {
  if (vector.size() < n) vector.resize(n);
}

}  // namespace touchstone
