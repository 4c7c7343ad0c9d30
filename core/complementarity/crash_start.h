#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <cstdint>
#include <vector>

#include "core/complementarity/dense_lu.h"
#include "core/complementarity/merit_search.h"
#include "core/complementarity/problem.h"

namespace touchstone {

/// A start for path-following that has most of the solution's active set (Dirkse & Ferris 1997, "Crash
/// techniques for large-scale complementarity problems"): projected Newton steps. Each takes the unknowns
/// that the natural map z - F(z) sends out of their bounds to the bound, solves the linearised equations of
/// the others, and puts the result back into the bounds. A step may change the active set in any number of
/// places, where path-following changes one a pivot.
///
/// It ends where the active set stays the same, where the merit does not fall, or after the steps allowed.
class CrashStart {
 public:
  /// Moves the search's current point. @param steps  at most, >= 0
  void run(const MixedComplementarityProblem& problem, int steps, MeritSearch& search);

 private:
  enum class Place : std::uint8_t { lower, between, upper };

  [[nodiscard]] bool choose_places(const MixedComplementarityProblem& problem, const Iterate& at);
  [[nodiscard]] bool find_direction(const MixedComplementarityProblem& problem, const Iterate& at);
  void fill_dense(const Iterate& at, double perturbation);
  [[nodiscard]] bool solve_dense(const Iterate& at);
  [[nodiscard]] bool solve_sparse(const Iterate& at);
  [[nodiscard]] bool is_between(Eigen::Index i) const {
    return places_[static_cast<std::size_t>(i)] == Place::between;
  }

  std::vector<Place> places_, new_places_;
  DenseLu lu_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> sparse_lu_;
  Eigen::VectorXd direction_;
};

}  // namespace touchstone
