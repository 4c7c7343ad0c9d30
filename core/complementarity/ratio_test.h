#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/complementarity/complementary_basis.h"

namespace touchstone {

/// Which variable stops a move of a complementary basis, and after how far.
///
/// Where several variables stop it at once the choice is lexicographic (Cottle, Pang & Stone 1992, section
/// 4.9): it is the one that would stop it if the variables of the START basis were moved off their bounds by
/// eps, eps^2, ..., for all small eps. The perturbed path has no ties, so no basis comes twice and no
/// degenerate problem cycles. Only the entries that tell the tied variables apart are computed.
class RatioTest {
 public:
  struct Leaving {
    PathVariable variable;
    double step = 0.0;      ///< >= 0
    bool unblocked = true;  ///< nothing stops the move: a ray
    bool at_upper = false;  ///< an unknown left at its upper bound
  };

  /// @param tie  distance within which two variables stop at once, in the unit of unknowns and slacks; > 0
  /// @param pivot  rates up to this, relative to the largest rate or 1, count as zero; > 0
  void prepare(Eigen::Index unknowns, double tie, double pivot) {
    // Here rather than at the first move, so that meeting the first one later allocates nothing.
    start_.reserve(static_cast<std::size_t>(unknowns));
    candidates_.reserve(static_cast<std::size_t>(2 * unknowns + 2));
    tie_tolerance_ = tie;
    pivot_tolerance_ = pivot;
    ties_broken_ = 0;
  }

  /// Notes the start basis, whose variables the perturbation moves. To be called before the first move.
  void begin(const ComplementaryBasis& basis);

  /// What stops `entering`, whose direction() the basis has just computed. The parameter leaves at zero, and
  /// first.
  [[nodiscard]] Leaving choose(ComplementaryBasis& basis, PathVariable entering);

  /// Ties that the lexicographic rule had to break since prepare().
  [[nodiscard]] int ties_broken() const { return ties_broken_; }

 private:
  struct Candidate {
    PathVariable variable;
    double distance = 0.0;  ///< to the bound that it moves to, >= 0 up to rounding
    double rate = 0.0;      ///< of the variable itself, signed
    double key = 0.0;       ///< of the current power of eps
  };
  struct Perturbed {
    PathVariable variable;
    double sign = 0.0;  ///< away from the bound that the variable is at
  };

  void collect(const ComplementaryBasis& basis, PathVariable entering);
  void add(PathVariable variable, double value, double rate, double lower, double upper);
  void add_slack(const ComplementaryBasis& basis, Eigen::Index i);
  void keep_nearest();
  void break_tie(ComplementaryBasis& basis);
  void keep_smallest_keys();

  double tie_tolerance_ = 1e-12;
  double pivot_tolerance_ = 1e-11;
  double smallest_rate_ = 0.0;
  int ties_broken_ = 0;
  std::vector<Perturbed> start_;
  std::vector<Candidate> candidates_;
};

}  // namespace touchstone
