#pragma once

#include <Eigen/Core>

#include "core/complementarity/problem.h"
#include "core/complementarity/sparse_problem.h"

namespace touchstone {

/// A problem with a proximal term: F(z) + weight (z - center) in the place of F(z). For a monotone F the term
/// makes the solution unique and its Jacobian regular; in general it ties the solution to the center while
/// the weight is large.
template <typename Problem>
class WithProximalTerm : public Problem {
 public:
  /// Both must outlive the use. @param weight  >= 0, in units of F per unit of z
  void bind(const Problem& problem, const Eigen::VectorXd& center, double weight) {
    problem_ = &problem;
    center_ = &center;
    weight_ = weight;
  }

  [[nodiscard]] Eigen::Index size() const override { return problem_->size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return problem_->lower(); }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return problem_->upper(); }
  [[nodiscard]] std::string row_name(Eigen::Index row) const override { return problem_->row_name(row); }

 protected:
  [[nodiscard]] const Problem& problem() const { return *problem_; }
  [[nodiscard]] double weight() const { return weight_; }
  void add_term(const Eigen::VectorXd& z, Eigen::VectorXd& f) const { f += weight_ * (z - *center_); }

 private:
  const Problem* problem_ = nullptr;
  const Eigen::VectorXd* center_ = nullptr;
  double weight_ = 0.0;
};

/// With a dense Jacobian.
class ProximalProblem final : public WithProximalTerm<MixedComplementarityProblem> {
 public:
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override {
    problem().evaluate(z, f, jacobian);
    add_term(z, f);
    if (jacobian != nullptr) jacobian->diagonal().array() += weight();
  }
};

/// With a sparse one.
class SparseProximalProblem final : public WithProximalTerm<SparseComplementarityProblem> {
 public:
  void evaluate_sparse(const Eigen::VectorXd& z, Eigen::VectorXd& f, Matrix* jacobian) const override {
    problem().evaluate_sparse(z, f, jacobian);
    add_term(z, f);
    if (jacobian == nullptr) return;
    Matrix term(size(), size());
    term.setIdentity();
    *jacobian += weight() * term;
  }
};

}  // namespace touchstone
