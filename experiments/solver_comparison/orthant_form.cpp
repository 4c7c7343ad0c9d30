#include "experiments/solver_comparison/orthant_form.h"

#include <algorithm>
#include <cmath>

namespace touchstone::solver_comparison {

using Eigen::Index;

OrthantForm::OrthantForm(const MixedComplementarityProblem& problem)
    : problem_(problem), z_(problem.size()), f_(problem.size()), jacobian_(problem.size(), problem.size()) {
  const Index n = problem.size();
  const Eigen::VectorXd& lower = problem.lower();
  const Eigen::VectorXd& upper = problem.upper();
  for (Index i = 0; i < n; ++i) {
    if (!std::isfinite(lower[i]) && !std::isfinite(upper[i])) parts_.push_back({.index = i});
  }
  free_ = static_cast<Index>(parts_.size());
  for (Index i = 0; i < n; ++i) {
    const bool below = std::isfinite(lower[i]);
    const bool above = std::isfinite(upper[i]);
    if (!below && !above) continue;
    Part part{.index = i, .offset = below ? lower[i] : upper[i], .sign = below ? 1.0 : -1.0};
    if (below && above) {
      part.beside = n + boxed_++;
      part.width = upper[i] - lower[i];
    }
    parts_.push_back(part);
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    as_it_is_ = as_it_is_ && part.index == static_cast<Index>(k) && part.offset == 0 && part.sign == 1 &&
                part.beside < 0;
  }
  unused_.resize(size());
}

Eigen::VectorXd OrthantForm::from(const Eigen::VectorXd& z) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  problem_.evaluate(z.cwiseMax(problem_.lower()).cwiseMin(problem_.upper()), f_, nullptr);
  for (Index k = 0; k < static_cast<Index>(parts_.size()); ++k) {
    const Part& part = parts_[static_cast<std::size_t>(k)];
    x[k] = part.sign * (z[part.index] - part.offset);
    if (k >= free_) x[k] = std::max(x[k], 0.0);
    if (part.beside < 0) continue;
    x[k] = std::min(x[k], part.width);
    x[part.beside] = std::max(-f_[part.index], 0.0);
  }
  return x;
}

Eigen::VectorXd OrthantForm::to(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z(problem_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k)
    z[parts_[k].index] = parts_[k].offset + parts_[k].sign * x[static_cast<Index>(k)];
  return z;
}

void OrthantForm::evaluate(const double* x, double* f, double* jacobian) {
  const auto count = static_cast<Index>(parts_.size());
  if (as_it_is_) {
    z_ = Eigen::Map<const Eigen::VectorXd>(x, count);
  } else {
    for (std::size_t k = 0; k < parts_.size(); ++k)
      z_[parts_[k].index] = parts_[k].offset + parts_[k].sign * x[k];
  }
  problem_.evaluate(z_, f_, jacobian == nullptr ? nullptr : &jacobian_);
  if (as_it_is_) {
    Eigen::Map<Eigen::VectorXd>(f, count) = f_;
    if (jacobian != nullptr) Eigen::Map<Eigen::MatrixXd>(jacobian, count, count) = jacobian_;
    return;
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    f[k] = part.sign * f_[part.index];
    if (part.beside < 0) continue;
    f[k] += x[part.beside];
    f[part.beside] = part.width - x[k];
  }
  if (jacobian != nullptr) transform_jacobian(jacobian);
}

void OrthantForm::transform_jacobian(double* jacobian) const {
  const auto at = [](std::size_t k) { return static_cast<Index>(k); };
  Eigen::Map<Eigen::MatrixXd> j(jacobian, size(), size());
  if (boxed_ > 0) j.setZero();
  for (std::size_t l = 0; l < parts_.size(); ++l) {
    const auto column = jacobian_.col(parts_[l].index);
    for (std::size_t k = 0; k < parts_.size(); ++k)
      j(at(k), at(l)) = parts_[k].sign * parts_[l].sign * column[parts_[k].index];
  }
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    if (parts_[k].beside < 0) continue;
    j(at(k), parts_[k].beside) = 1;
    j(parts_[k].beside, at(k)) = -1;
  }
}

}  // namespace touchstone::solver_comparison
