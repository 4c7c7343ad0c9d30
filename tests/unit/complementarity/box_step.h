#pragma once

#include <Eigen/Core>

#include "core/complementarity/problem.h"

namespace touchstone::testing {

/// State of a planar box: centre [m], angle [rad], velocity [m/s, m/s, rad/s].
struct BoxState {
  Eigen::Vector3d q = Eigen::Vector3d::Zero();
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();
};

struct BoxScene {
  Eigen::Vector2d half_extents{0.5, 0.5};  ///< [m]
  double mass = 1.0;                       ///< [kg]
  double mu = 0.5;
  double slope = 0.0;  ///< of the plane, by turning gravity [rad]
  double h = 0.01;     ///< [s]
};

/// One implicit step of a planar box above the plane y = 0, as a mixed complementarity problem of 11 unknowns
///   z = [nu' (3), a (2), l (4), p_n, p_t]:
/// balance of momentum; sum_j l_j n_j = -(0, 1) with 0 <= l_j _|_ -g_j(a) >= 0 for the four faces at the end
/// of the step, which makes `a` the lowest point of the box; 0 <= p_n _|_ a_y >= 0; friction as a projection
/// onto the interval [-mu p_n, mu p_n], which is only piecewise smooth. A box in the air with a face down
/// leaves `a` undetermined along that face: its Jacobian is singular, its equations are consistent.
class BoxStep final : public MixedComplementarityProblem {
 public:
  static constexpr int unknowns = 11;

  BoxStep(const BoxScene& scene, const BoxState& state);

  [[nodiscard]] Eigen::Index size() const override { return unknowns; }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override;

  /// No contact impulse, the lowest corner at the end of the free motion as `a`.
  [[nodiscard]] Eigen::VectorXd predicted_start() const;
  [[nodiscard]] BoxState next_state(const Eigen::VectorXd& z) const;
  [[nodiscard]] double energy(const BoxState& state) const;

 private:
  template <typename Scalar>
  void rows(const Eigen::Matrix<Scalar, unknowns, 1>& z, Eigen::Matrix<Scalar, unknowns, 1>& f) const;
  [[nodiscard]] Eigen::Vector2d gravity() const;
  [[nodiscard]] double inertia() const;

  BoxScene scene_;
  BoxState state_;
  Eigen::VectorXd lower_, upper_;
};

}  // namespace touchstone::testing
