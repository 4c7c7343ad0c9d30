#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

/// Random linear complementarity problems  0 <= z _|_ M z + q >= 0  of which it is known beforehand whether
/// they have a solution.
namespace touchstone::problems {

enum class LcpKind : std::uint8_t {
  /// M is positive definite and not symmetric, so a P-matrix: one solution, strictly complementary.
  p_matrix,
  /// M is positive semidefinite of half rank, and a third of the pairs are zero on both sides in one of its
  /// solutions.
  degenerate,
  /// No z >= 0 has M z + q >= 0: there is y > 0 with M^T y < 0 and q^T y < 0.
  infeasible,
};
[[nodiscard]] std::string to_string(LcpKind kind);

struct RandomLcp {
  Eigen::MatrixXd m;
  Eigen::VectorXd q;
  Eigen::VectorXd solution;     ///< one of them; empty if there is none
  Eigen::VectorXd certificate;  ///< y of an infeasible problem (Farkas 1902); empty otherwise
};

/// The same on every platform. @param n  >= 3
[[nodiscard]] RandomLcp random_lcp(LcpKind kind, Eigen::Index n, std::uint64_t seed);

}  // namespace touchstone::problems
