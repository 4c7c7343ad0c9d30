#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include "core/complementarity/dense_lu.h"
#include "core/complementarity/merit_search.h"
#include "core/complementarity/problem.h"
#include "core/complementarity/report.h"
#include "core/complementarity/solver.h"

namespace touchstone {

struct SemismoothNewtonOptions {
  SearchOptions search;
  /// Trial points are put back into the bounds, outside of which F need not be defined.
  bool project = true;
  /// A search that fails is made once more from the start, without the projection (or with it, if the first
  /// had none): where one gets caught in a local minimum of the merit the other often does not.
  bool second_search = true;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Semismooth Newton method on the (penalised) Fischer-Burmeister reformulation Phi(z) = 0 of a mixed
/// complementarity problem, with line search on 1/2 |Phi|^2 (De Luca, Facchinei & Kanzow 1996; Munson et al.
/// 2001).
///
/// A singular but consistent Newton system (an unknown that nothing determines) gives the shortest step; an
/// inconsistent one, or a direction without decrease, gives regularised steps that turn towards the gradient.
/// After the first solve of a size nothing is allocated, but for the scratch memory of Eigen's blocked
/// algorithms above a hundred unknowns or so. A sparse Jacobian is factorised as such, which allocates; where
/// it is singular the step is a regularised one, consistent or not.
class SemismoothNewton final : public ComplementaritySolver {
 public:
  explicit SemismoothNewton(const SemismoothNewtonOptions& options = {});

  [[nodiscard]] SolveReport solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) override;

 private:
  [[nodiscard]] SolveStatus search(bool project);
  [[nodiscard]] bool newton_direction();
  [[nodiscard]] bool sparse_newton_direction();
  [[nodiscard]] bool least_norm_direction();
  void fill_newton_matrix();

  SemismoothNewtonOptions options_;
  MeritSearch search_;
  DenseLu lu_;
  Eigen::SparseMatrix<double> sparse_matrix_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu_;
  Eigen::VectorXd direction_, misfit_;
};

}  // namespace touchstone
