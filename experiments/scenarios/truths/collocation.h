#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/scenarios/truths/dense_step.h"

namespace touchstone::truth {

/// One step of y' = f(t, y) by collocation at the Gauss-Legendre nodes: the polynomial whose
/// slope is f at every node (an implicit Runge-Kutta method of order 2 stages, here 20;
/// Hairer, Norsett & Wanner I, II.7). Its weights are positive and its coefficients below 1,
/// so rounding is not amplified, and the polynomial is the dense output.
///
/// The nodes' values are found by Picard iteration, which converges wherever |df/dy| h
/// is of order 1. Where it does not (a contact that has just begun to slip has
/// df/dy ~ 1 / slip) Newton's method with a differenced Jacobian takes over.
template <int N, class Field>
class Collocation {
 public:
  static constexpr std::size_t stages = DenseStep<N>::stages;
  static constexpr int columns = static_cast<int>(stages);
  using Vector = OdeVector<N>;
  using Nodes = Eigen::Matrix<double, N, columns>;  ///< column i belongs to node i

  explicit Collocation(const Field& field) : field_(field) {
    const auto& rule = GaussRule<stages>::instance();
    for (int i = 0; i < columns; ++i) {
      const auto row = static_cast<std::size_t>(i);
      for (int j = 0; j < columns; ++j) {
        const auto column = static_cast<std::size_t>(j);
        to_increments_(j, i) = rule.integral[row][column];
        to_modes_(j, i) = rule.to_modes[row][column];
      }
      node_[row] = rule.node[row];
      weight_[i] = rule.weight[row];
    }
  }

  /// Solves the step from (t0, y0) to t0 + h. Errors and
  /// increments are measured in units of `scale`, > 0 a component.
  /// @return false if neither iteration converged; then the other accessors mean nothing
  [[nodiscard]] bool solve(double t0, const Vector& y0, double h, const Vector& scale) {
    t0_ = t0, y0_ = y0, h_ = h, inverse_scale_ = scale.cwiseInverse();
    start_from_tangent();
    if (picard()) return true;
    start_from_tangent();
    return newton();
  }

  /// Estimate of what the dense output leaves out, in units of the scale: its last two Legendre coefficients.
  [[nodiscard]] double error() const {
    const Nodes modes = slopes_ * to_modes_;
    const double last = scaled(modes.col(columns - 1)) / (2.0 * stages - 1.0);
    const double before = scaled(modes.col(columns - 2)) / (2.0 * stages - 3.0);
    return h_ * std::max(last, 0.1 * before);
  }

  [[nodiscard]] Vector increment() const { return h_ * (slopes_ * weight_); }
  [[nodiscard]] DenseStep<N> dense() const { return {t0_, h_, y0_, slopes_ * to_modes_}; }
  [[nodiscard]] int iterations() const { return iterations_; }

 private:
  [[nodiscard]] double scaled(const Vector& v) const {
    return v.cwiseProduct(inverse_scale_).cwiseAbs().maxCoeff();
  }
  [[nodiscard]] double time(int i) const { return t0_ + h_ * node_[static_cast<std::size_t>(i)]; }

  void start_from_tangent() {
    const Vector slope = field_(t0_, y0_);
    for (int i = 0; i < columns; ++i) increments_.col(i) = h_ * node_[static_cast<std::size_t>(i)] * slope;
  }

  /// slopes = f(y0 + increments), then the increments that these slopes ask for.
  [[nodiscard]] Nodes mapped_increments() {
    for (int i = 0; i < columns; ++i) slopes_.col(i) = field_(time(i), y0_ + increments_.col(i));
    return h_ * (slopes_ * to_increments_);
  }

  [[nodiscard]] double largest(const Nodes& change) const {
    double result = 0.0;
    for (int i = 0; i < columns; ++i) {
      const double size = scaled(change.col(i));
      if (!(size <= std::numeric_limits<double>::max())) return std::numeric_limits<double>::infinity();
      result = std::max(result, size);
    }
    return result;
  }

  [[nodiscard]] bool picard() {
    double previous = std::numeric_limits<double>::infinity();
    for (iterations_ = 1; iterations_ <= max_picard; ++iterations_) {
      const Nodes next = mapped_increments();
      const double change = largest(next - increments_);
      increments_ = next;
      if (change < rounding) return true;
      if (change < stagnation && change > 0.5 * previous) return true;  // only rounding is left
      if (iterations_ > 4 && change > 0.7 * previous) return false;
      previous = change;
    }
    return false;
  }

  [[nodiscard]] bool newton() {
    double previous = std::numeric_limits<double>::infinity();
    for (iterations_ = 1; iterations_ <= max_newton; ++iterations_) {
      const Nodes residual = mapped_increments() - increments_;
      const Nodes step = newton_step(residual);
      const double change = largest(step);
      if (!(change < std::numeric_limits<double>::infinity())) return false;
      increments_ += step;
      if (change < rounding || (change < stagnation && change > 0.5 * previous)) {
        (void)mapped_increments();
        return true;
      }
      previous = change;
    }
    return false;
  }

  /// Solves (1 - h (A x 1) diag(df/dy)) step = residual over all nodes at once.
  [[nodiscard]] Nodes newton_step(const Nodes& residual) {
    using Big = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
    Big matrix = Big::Identity(N * columns, N * columns);
    for (int j = 0; j < columns; ++j) {
      const Eigen::Matrix<double, N, N> derivative = differenced_jacobian(j);
      for (int i = 0; i < columns; ++i) {
        matrix.template block<N, N>(N * i, N * j) -= h_ * to_increments_(j, i) * derivative;
      }
    }
    Nodes step;
    Eigen::Map<Eigen::VectorXd>(step.data(), N * columns) =
        matrix.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(residual.data(), N * columns));
    return step;
  }

  /// df/dy at node j. The differences are small beside the node's own increment, because
  /// where Newton is needed f varies on that length (slip that grows from zero).
  [[nodiscard]] Eigen::Matrix<double, N, N> differenced_jacobian(int j) {
    Eigen::Matrix<double, N, N> result;
    for (int k = 0; k < N; ++k) {
      Vector y = y0_ + increments_.col(j);
      const double delta = std::max(1e-6 * std::abs(increments_(k, j)), 1e-15 / inverse_scale_[k]);
      const double forward = y[k] + delta;
      const double taken = forward - y[k];
      y[k] = forward;
      result.col(k) = (field_(time(j), y) - slopes_.col(j)) / taken;
    }
    return result;
  }

  static constexpr int max_picard = 40;
  static constexpr int max_newton = 25;
  static constexpr double rounding = 2e-16;
  static constexpr double stagnation = 1e-14;

  const Field& field_;
  std::array<double, stages> node_{};
  Eigen::Matrix<double, columns, 1> weight_;
  Nodes increments_;                                       ///< y at the nodes, less y0
  Nodes slopes_;                                           ///< f at the nodes
  Eigen::Matrix<double, columns, columns> to_increments_;  ///< A transposed: increments = h slopes A^T
  Eigen::Matrix<double, columns, columns> to_modes_;
  double t0_ = 0.0;
  double h_ = 0.0;
  Vector y0_;
  Vector inverse_scale_;
  int iterations_ = 0;
};

}  // namespace touchstone::truth
