#include "core/complementarity/normal_equations.h"

namespace touchstone {

using Eigen::Index;

void NormalEquations::reserve(Index n) {
  h_.setIdentity(n, n);
  normal_.resize(n, n);
  cholesky_.compute(h_);  // takes its storage here, not in the first regularised step
  gradient_.resize(n);
}

void NormalEquations::form(FischerBurmeister& reformulation, const Iterate& at) {
  const Index n = at.z.size();
  is_sparse_ = at.is_sparse;
  if (is_sparse_) {
    reformulation.jacobian(at.z, at.f, at.sparse_jacobian, sparse_h_);
    gradient_ = sparse_h_.transpose() * at.phi;
    matrix_norm_ = sparse_h_.norm();
    sparse_normal_ = sparse_h_.transpose() * sparse_h_;
    identity_.resize(n, n);
    identity_.setIdentity();
    largest_diagonal_ = n > 0 ? Eigen::VectorXd(sparse_normal_.diagonal()).maxCoeff() : 0.0;
    return;
  }
  reformulation.jacobian(at.z, at.f, at.jacobian, {h_.data(), n, n});
  gradient_.noalias() = h_.transpose() * at.phi;
  matrix_norm_ = h_.norm();
  normal_.noalias() = h_.transpose() * h_;
  largest_diagonal_ = n > 0 ? normal_.diagonal().maxCoeff() : 0.0;
}

bool NormalEquations::solve(double weight, Eigen::VectorXd& step) {
  if (is_sparse_) {
    sparse_cholesky_.compute(sparse_normal_ + weight * identity_);
    if (sparse_cholesky_.info() != Eigen::Success) return false;
    step = sparse_cholesky_.solve(-gradient_);
    return true;
  }
  h_ = normal_;
  h_.diagonal().array() += weight;
  cholesky_.compute(h_);
  step = -gradient_;
  cholesky_.solveInPlace(step);
  return cholesky_.info() == Eigen::Success;
}

}  // namespace touchstone
