#pragma once

#include <Eigen/Core>
#include <string_view>

#include "core/complementarity/column_source.h"
#include "core/complementarity/complementary_basis.h"
#include "core/complementarity/ratio_test.h"

namespace touchstone {

/// How the pivoting of a mixed linear complementarity problem ended.
enum class LinearPathStatus {
  solved,
  ray,            ///< the path goes to infinity; see LinearPath::unknown_ray()
  pivot_limit,    ///< the allowed pivots were used up
  singular_basis  ///< the basis became singular to working accuracy
};

[[nodiscard]] std::string_view to_string(LinearPathStatus status);

struct LinearPathResult {
  LinearPathStatus status = LinearPathStatus::singular_basis;
  int pivots = 0;          ///< changes of basis, and unknowns that went from one bound to the other
  int ties_broken = 0;     ///< moves stopped by several variables at once
  double parameter = 1.0;  ///< tau where the path ended: 0 when solved
  bool repaired = false;   ///< the start basis was singular and was repaired

  [[nodiscard]] bool solved() const { return status == LinearPathStatus::solved; }
};

struct LinearPathOptions {
  /// Largest number of pivots, > 0; 0: 100 + 20 n.
  int max_pivots = 0;
  /// Variables that stop a move within this distance, relative to 1 + max|q|, tie; in (0, 1e-3].
  double tie_tolerance = 1e-12;
  /// Rates up to this, relative to the largest, do not stop a move; in (0, 1e-3].
  double pivot_tolerance = 1e-11;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Solves the mixed linear complementarity problem
///   s = q + M (z - origin),   l_i <= z_i _|_ s_i <= u_i
/// by following a piecewise linear path of complementary bases of
///   s = q + M (z - origin) + cover tau
/// to tau = 0. One engine, two starts:
///   lemke()   from infinity along the ray of a covering vector (Lemke 1965; Cottle, Pang & Stone 1992, 4.4);
///   follow()  from any point z_k, whose misfit r is the cover: the path of Dirkse & Ferris 1995 between the
///             zeros of  M z + q - w + v = (1 - t) r  at t = 0 and t = 1, with t = 1 - tau, s = w - v,
///             cover = -r.
/// Ties are broken lexicographically. A pivot costs O(n k + k^2), k the size of the core (see
/// ComplementaryBasis).
///
/// Nothing is allocated once a problem of the size, with as large a core, was solved.
class LinearPath {
 public:
  explicit LinearPath(const LinearPathOptions& options = {});

  /// Another limit than that of the options, with the same meaning. @param pivots  >= 0
  void limit_pivots(int pivots) { options_.max_pivots = pivots; }

  /// Makes room for problems of size n, so that solving one with a core of less than DenseLu::blocked_size
  /// allocates nothing. For one size: a problem of another size takes the room away.
  void reserve(Eigen::Index n);

  /// The linear complementarity problem  0 <= z _|_ q + M z >= 0  by Lemke's method with covering vector
  /// `cover`, > 0. On return z is the solution, or the last point of the path, which has tau > 0.
  [[nodiscard]] LinearPathResult lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& cover, Eigen::VectorXd& z);
  /// The same with covering vector (1, ..., 1).
  [[nodiscard]] LinearPathResult lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                       Eigen::VectorXd& z);
  /// The same with M by its columns: each column that enters the basis is asked for once, others never.
  [[nodiscard]] LinearPathResult lemke(const ColumnSource& m, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& cover, Eigen::VectorXd& z);
  /// With bounds, and q = F(origin). Starts from the bounds; free unknowns are basic from the start.
  [[nodiscard]] LinearPathResult lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                       const Eigen::VectorXd& origin, Eigen::VectorXd& z);

  [[nodiscard]] LinearPathResult lemke(const ColumnSource& m, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                       const Eigen::VectorXd& origin, Eigen::VectorXd& z);

  /// From z, l <= z <= u, with q = F(z): origin is z. Unknowns whose z_i - q_i is outside their bounds start
  /// at the bound; if the solution has the same ones at the same bounds this costs one factorisation and no
  /// pivot.
  /// @param misfit  a dependent row of a singular start basis may be left unsatisfied by up to this, >= 0: a
  /// consistent system is, linearised, consistent to first order only
  [[nodiscard]] LinearPathResult follow(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                        const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                        double misfit, Eigen::VectorXd& z);
  [[nodiscard]] LinearPathResult follow(const ColumnSource& m, const Eigen::VectorXd& q,
                                        const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                        double misfit, Eigen::VectorXd& z);

  /// After `ray`: the direction (n entries each) in which z and s go to infinity, and that of tau.
  [[nodiscard]] const Eigen::VectorXd& unknown_ray() const { return basis_.unknown_rates(); }
  [[nodiscard]] const Eigen::VectorXd& slack_ray() const { return basis_.slack_rates(); }
  [[nodiscard]] double parameter_ray() const { return basis_.parameter_rate(); }

 private:
  static constexpr Eigen::Index none = -1;
  static constexpr Eigen::Index undecided = -2;

  /// The variable that moves next, and which way.
  struct Move {
    PathVariable entering;
    double sign = 1.0;
    /// `none` if the sign is given; else either sign follows the path: the slack of this row, just released
    /// from zero, decides, or tau if it is `undecided`.
    Eigen::Index open_row = none;
  };

  void set_size(Eigen::Index n);
  void prepare(const Eigen::VectorXd& q);
  template <typename Matrix>
  [[nodiscard]] LinearPathResult follow_matrix(const Matrix& m, const Eigen::VectorXd& q,
                                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                               double misfit, Eigen::VectorXd& z);
  [[nodiscard]] bool start_at_bounds();
  [[nodiscard]] bool start_at_point(const Eigen::VectorXd& q, const Eigen::VectorXd& z);
  [[nodiscard]] LinearPathResult pursue_from_infinity(const Eigen::VectorXd& cover, Eigen::VectorXd& z);
  [[nodiscard]] bool target_is_feasible() const;
  void accept_misfit(double misfit);
  void return_to_start(const Eigen::VectorXd& q);
  [[nodiscard]] LinearPathResult pursue(Eigen::VectorXd& z);
  [[nodiscard]] LinearPathResult arrive(Eigen::VectorXd& z);
  [[nodiscard]] Move successor(const RatioTest::Leaving& leaving);
  [[nodiscard]] Move move_partner(Eigen::Index row, double sign) const;
  void orient(const Move& move);
  LinearPathResult finish(LinearPathStatus status, Eigen::VectorXd& z);

  LinearPathOptions options_;
  ComplementaryBasis basis_;
  RatioTest ratio_test_;
  LinearPathResult result_;
  double feasibility_ = 0.0;
  Eigen::VectorXd zero_, infinite_, ones_;
};

}  // namespace touchstone
