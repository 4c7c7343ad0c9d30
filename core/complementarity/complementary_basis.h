#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/complementarity/basis_core.h"
#include "core/complementarity/column_cache.h"

namespace touchstone {

/// A variable of the parametric system  s = q + M (z - origin) + cover tau.
struct PathVariable {
  enum class Kind : std::uint8_t { unknown, slack, parameter };
  Kind kind = Kind::parameter;
  Eigen::Index index = 0;  ///< row or unknown; 0 of the parameter
  [[nodiscard]] bool operator==(const PathVariable&) const = default;
};

/// What a basic slack may be: where its unknown rests decides.
enum class SlackDomain : std::uint8_t {
  nonnegative,  ///< the unknown is at its lower bound
  nonpositive,  ///< the unknown is at its upper bound
  zero,  ///< the row was found dependent: no sign is allowed, an unknown, its partner, rests between bounds
  any    ///< the unknown is fixed: both bounds are equal
};

/// A complementary basis of the parametric mixed linear complementarity problem
///   s = q + M (z - origin) + cover tau,   l <= z _|_ s <= u,
/// with the values of all variables: of each pair (z_i, s_i) one is basic, tau is basic or drives. A point
/// moves through it along a piecewise linear path; see LinearPath, which decides what moves.
///
/// Only the core (rows whose slack is nonbasic, by basic unknowns and tau) is factorised; k is its size. A
/// direction costs O(n k + k^2), a change of basis O(k^2).
class ComplementaryBasis {
 public:
  /// Makes room for n unknowns and any basis of them, of columns from a ColumnSource too.
  void reserve(Eigen::Index n);

  // -- Start --
  /// Binds the data, which must outlive the use; q and origin are copied. All unknowns are to be rested or
  /// entered next.
  template <typename Matrix>
  void bind(const Matrix& matrix, const Eigen::VectorXd& q, const Eigen::VectorXd& lower,
            const Eigen::VectorXd& upper, const Eigen::VectorXd& origin) {
    columns_.bind(matrix);
    bind_vectors(q, lower, upper, origin);
  }
  /// Starts with z_i nonbasic at its lower or upper bound, its slack basic with the given value.
  void rest_at_lower(Eigen::Index i, double slack);
  void rest_at_upper(Eigen::Index i, double slack);
  /// Starts with z_i basic, at the origin.
  void make_basic(Eigen::Index i);
  /// Factorises the start basis. Where its block is singular the dependent unknowns are left nonbasic where
  /// they are and the dependent rows keep their slack, held at zero; false if even that fails.
  [[nodiscard]] bool factor_start();
  /// Adds `shift` to q_i.
  void shift_row(Eigen::Index i, double shift) { q_[i] += shift; }
  /// Slacks with every basic unknown at its origin and tau = 0: q + M (z_nonbasic - origin).
  void evaluate_base();
  [[nodiscard]] const Eigen::VectorXd& base() const { return base_; }
  /// Puts every basic unknown back to its origin.
  void return_to_origin();
  /// The column of tau, to be set before tau moves.
  [[nodiscard]] Eigen::VectorXd& cover() { return cover_; }

  // -- Values --
  [[nodiscard]] Eigen::Index size() const { return n_; }
  [[nodiscard]] Eigen::Index core_size() const { return core_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const { return *lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const { return *upper_; }
  [[nodiscard]] const Eigen::VectorXd& unknowns() const { return z_; }
  [[nodiscard]] Eigen::VectorXd& unknowns() { return z_; }
  [[nodiscard]] const Eigen::VectorXd& slacks() const { return s_; }
  [[nodiscard]] Eigen::VectorXd& slacks() { return s_; }
  [[nodiscard]] double parameter() const { return tau_; }
  void set_parameter(double tau) { tau_ = tau; }
  [[nodiscard]] bool is_basic(PathVariable variable) const;
  [[nodiscard]] bool slack_is_basic(Eigen::Index i) const { return row_position_[at(i)] < 0; }
  [[nodiscard]] SlackDomain slack_domain(Eigen::Index i) const { return domain_[at(i)]; }
  void set_slack_domain(Eigen::Index i, SlackDomain domain) { domain_[at(i)] = domain; }
  /// The nonbasic unknown to enter when the slack of a dependent row leaves.
  [[nodiscard]] Eigen::Index partner(Eigen::Index row) const { return partner_[at(row)]; }
  /// Basic structural columns: unknowns, and size() for tau.
  [[nodiscard]] const std::vector<Eigen::Index>& basic_columns() const { return basic_columns_; }
  [[nodiscard]] bool repaired() const { return repaired_; }

  // -- Moves --
  /// Rates of all variables when `entering`, nonbasic, moves at rate `sign`. False if the core is singular.
  [[nodiscard]] bool direction(PathVariable entering, double sign);
  [[nodiscard]] const Eigen::VectorXd& unknown_rates() const { return dz_; }
  [[nodiscard]] const Eigen::VectorXd& slack_rates() const { return ds_; }
  [[nodiscard]] double parameter_rate() const { return dtau_; }
  void reverse_direction();
  void advance(double step);
  /// Puts `entering`, whose direction() was asked for last, into the basis in the place of `leaving`.
  void exchange(PathVariable entering, PathVariable leaving);

  /// Rates of single basic variables when a nonbasic one moves at rate 1, without the cost of all of them:
  /// what breaking a tie asks for. First the nonbasic variable, then any number of basic ones. False if the
  /// core is singular.
  [[nodiscard]] bool probe(PathVariable nonbasic);
  [[nodiscard]] double probed_rate(PathVariable basic);

  /// Values of all basic variables at tau = 0, which is nonbasic, from the data rather than from the moves
  /// made.
  [[nodiscard]] bool solve_at_target();

 private:
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  void set_size(Eigen::Index n);
  void bind_vectors(const Eigen::VectorXd& q, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                    const Eigen::VectorXd& origin);
  void rest(Eigen::Index i, double value, double slack, SlackDomain domain);
  void fill_core();
  [[nodiscard]] bool keep_independent(Eigen::Index rank, const std::vector<Eigen::Index>& row_order);
  [[nodiscard]] const double* column(Eigen::Index j) { return j == n_ ? cover_.data() : columns_.column(j); }
  [[nodiscard]] static Eigen::Index structural(PathVariable variable, Eigen::Index n);
  [[nodiscard]] bool solve_entering(PathVariable entering, Eigen::VectorXd& solution);
  void add_basic_columns(double factor, Eigen::VectorXd& target);
  void gather_row(Eigen::Index row);
  void add_row(Eigen::Index row);
  void add_column(Eigen::Index j);

  Eigen::Index n_ = 0;
  ColumnCache columns_;
  const Eigen::VectorXd* lower_ = nullptr;
  const Eigen::VectorXd* upper_ = nullptr;
  Eigen::VectorXd q_, origin_, cover_, base_;

  Eigen::VectorXd z_, s_;
  double tau_ = 0.0;
  Eigen::VectorXd dz_, ds_;
  double dtau_ = 0.0;

  // basic_columns_[c] and rows_[r] name the columns and rows of the core; the positions are their inverses,
  // -1 if absent.
  std::vector<Eigen::Index> basic_columns_, rows_, column_position_, row_position_;
  std::vector<Eigen::Index> all_columns_, all_rows_;  // what a repair chooses from
  std::vector<SlackDomain> domain_;
  std::vector<Eigen::Index> partner_;
  bool repaired_ = false;

  BasisCore core_;
  Eigen::VectorXd entering_column_, solved_, row_, probe_column_, probe_;
  PathVariable probed_;
};

}  // namespace touchstone
