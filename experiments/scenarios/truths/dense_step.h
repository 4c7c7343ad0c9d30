#pragma once

#include <Eigen/Dense>

#include "experiments/scenarios/truths/gauss_legendre.h"

namespace touchstone::truth {

template <int N>
using OdeVector = Eigen::Matrix<double, N, 1>;

/// The trajectory over one step as a polynomial: y(t) = y0 + h sum_k f_hat_k
/// Q_k(theta), theta = (t - t0)/h, with Q_k(theta) the integral from 0 to theta of
/// P_k(2 theta - 1). Valid, and exactly y0 at its start, on [begin, end].
template <int N>
class DenseStep {
 public:
  static constexpr std::size_t stages = 10;
  using Vector = OdeVector<N>;
  using Modes = Eigen::Matrix<double, N, static_cast<int>(stages)>;

  DenseStep() = default;
  DenseStep(double t0, double h, const Vector& y0, const Modes& modes)
      : t0_(t0), h_(h), y0_(y0), modes_(modes) {}

  [[nodiscard]] double begin() const { return t0_; }
  [[nodiscard]] double end() const { return t0_ + h_; }
  [[nodiscard]] const Vector& initial() const { return y0_; }

  [[nodiscard]] Vector operator()(double t) const {
    const double theta = (t - t0_) / h_;
    const auto p = legendre<stages + 1>(2.0 * theta - 1.0);
    Vector sum = theta * modes_.col(0);
    for (int k = static_cast<int>(stages) - 1; k > 0; --k) {
      const auto above = static_cast<std::size_t>(k + 1);
      sum += modes_.col(k) * ((p[above] - p[above - 2]) / (2.0 * (2.0 * k + 1.0)));
    }
    return y0_ + h_ * sum;
  }

 private:
  double t0_ = 0.0;
  double h_ = 1.0;
  Vector y0_ = Vector::Zero();
  Modes modes_ = Modes::Zero();  ///< column k is f_hat_k
};

}  // namespace touchstone::truth
