#pragma once

#include <Eigen/Core>

#include "core/complementarity/problem.h"
#include "core/complementarity/sparse_problem.h"

namespace touchstone {

/// A problem with a proximal term: F(z) + weight (z - center) in the place of F(z). For a monotone F the term
/// makes the solution unique and its Jacobian regular; in general it ties the solution to the center while
/// the weight is large.
class ProximalProblem final : public MixedComplementarityProblem {
 public:
  /// Both must outlive the use. @param weight  >= 0, in units of F per unit of z
  void bind(const MixedComplementarityProblem& problem, const Eigen::VectorXd& center, double weight) {
    problem_ = &problem;
    center_ = &center;
    weight_ = weight;
  }

  [[nodiscard]] Eigen::Index size() const override { return problem_->size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return problem_->lower(); }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return problem_->upper(); }
  [[nodiscard]] std::string row_name(Eigen::Index row) const override { return problem_->row_name(row); }

  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    problem_->evaluate(z, f, jacobian);
    f += weight_ * (z - *center_);
    if (jacobian != nullptr) jacobian->diagonal().array() += weight_;
  }

 private:
  const MixedComplementarityProblem* problem_ = nullptr;
  const Eigen::VectorXd* center_ = nullptr;
  double weight_ = 0.0;
};

/// The same for a problem whose Jacobian is sparse.
class SparseProximalProblem final : public SparseComplementarityProblem {
 public:
  void bind(const SparseComplementarityProblem& problem, const Eigen::VectorXd& center, double weight) {
    problem_ = &problem;
    center_ = &center;
    weight_ = weight;
  }

  [[nodiscard]] Eigen::Index size() const override { return problem_->size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return problem_->lower(); }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return problem_->upper(); }
  [[nodiscard]] std::string row_name(Eigen::Index row) const override { return problem_->row_name(row); }

  void evaluate_sparse(const Eigen::VectorXd& z, Eigen::VectorXd& f, Matrix* jacobian) const override {
    problem_->evaluate_sparse(z, f, jacobian);
    f += weight_ * (z - *center_);
    if (jacobian == nullptr) return;
    Matrix term(size(), size());
    term.setIdentity();
    *jacobian += weight_ * term;
  }

 private:
  const SparseComplementarityProblem* problem_ = nullptr;
  const Eigen::VectorXd* center_ = nullptr;
  double weight_ = 0.0;
};

}  // namespace touchstone
