#pragma once

#include <Eigen/Core>

#include "core/complementarity/crash_start.h"
#include "core/complementarity/linear_path.h"
#include "core/complementarity/merit_search.h"
#include "core/complementarity/problem.h"
#include "core/complementarity/report.h"
#include "core/complementarity/solver.h"

namespace touchstone {

struct PathNewtonOptions {
  SearchOptions search;
  /// Of the linearised problems. Here max_pivots = 0 means 100 + n / 2: far from a solution the path may be
  /// long, and a regularised step then brings more than the rest of it.
  LinearPathOptions linear;
  /// Projected Newton steps to begin with, at most, which find most of the active set at once (CrashStart);
  /// in [0, 100], 0: none.
  int crash_steps = 0;
  /// Full steps in a row that may fail to decrease the merit before the search goes back to where they began
  /// (the watchdog of Chamberlain et al. 1982); in [0, 16].
  int watchdog = 4;
  /// Where the path from the current point ends on a ray, the linearised problem is tried once more by
  /// Lemke's method.
  bool lemke = true;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Newton's method for mixed complementarity problems in the manner of PATH (Dirkse & Ferris 1995): each
/// iteration solves the linearised problem, complementarity and all, by pivoting from the current point; the
/// step to its solution is safeguarded by a watchdog and a nonmonotone search on the Fischer-Burmeister
/// merit. While the active set stays the same an iteration is one factorisation and no pivot.
///
/// Where the linearised problem has no solution on its path, or the step to it gives no decrease, regularised
/// steps on the merit take over. A singular but consistent Jacobian leaves the undetermined unknowns where
/// they are. After the first solve of a size nothing is allocated, but for the scratch memory of Eigen's
/// blocked algorithms above a hundred unknowns or so, and for a sparse Jacobian. The columns of that are
/// taken as the basis needs them; the basis itself is dense, with as many rows as unknowns are between their
/// bounds.
class PathNewton final : public ComplementaritySolver {
 public:
  explicit PathNewton(const PathNewtonOptions& options = {});

  /// @param z  start on entry, put into the bounds; on return as ComplementaritySolver says
  [[nodiscard]] SolveReport solve(const MixedComplementarityProblem& problem, Eigen::VectorXd& z) override;

 private:
  [[nodiscard]] LinearPathResult newton_point(const MixedComplementarityProblem& problem);
  template <typename Matrix>
  [[nodiscard]] LinearPathResult newton_point(const MixedComplementarityProblem& problem,
                                              const Matrix& jacobian);
  [[nodiscard]] bool search_along_step();
  [[nodiscard]] bool search_from_checkpoint();
  [[nodiscard]] double slope() const;
  [[nodiscard]] SolveStatus failure(const LinearPathResult& linear) const;

  PathNewtonOptions options_;
  MeritSearch search_;
  CrashStart crash_;
  LinearPath path_;
  Eigen::VectorXd newton_point_, direction_, checkpoint_direction_;
  int tentative_steps_ = 0;
};

}  // namespace touchstone
