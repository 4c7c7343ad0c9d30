#include "core/complementarity/linear_path.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/complementarity/require.h"

namespace touchstone {

using Eigen::Index;
using Kind = PathVariable::Kind;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr PathVariable parameter{Kind::parameter, 0};

PathVariable unknown(Index i) { return {Kind::unknown, i}; }
PathVariable slack(Index i) { return {Kind::slack, i}; }

}  // namespace

std::string_view to_string(LinearPathStatus status) {
  switch (status) {
    case LinearPathStatus::solved:
      return "solved";
    case LinearPathStatus::ray:
      return "ray";
    case LinearPathStatus::pivot_limit:
      return "pivot_limit";
    case LinearPathStatus::singular_basis:
      return "singular_basis";
  }
  return "unknown";
}

void LinearPathOptions::validate() const {
  require::at_least("LinearPathOptions.max_pivots", max_pivots, 0);
  require::in_left_open("LinearPathOptions.tie_tolerance", tie_tolerance, 0.0, 1e-3);
  require::in_left_open("LinearPathOptions.pivot_tolerance", pivot_tolerance, 0.0, 1e-3);
}

LinearPath::LinearPath(const LinearPathOptions& options) : options_(options) { options_.validate(); }

LinearPathResult LinearPath::lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& cover, Eigen::VectorXd& z) {
  prepare(q);
  basis_.bind(m, q, zero_, infinite_, zero_);
  return pursue_from_infinity(cover, z);
}

LinearPathResult LinearPath::lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q, Eigen::VectorXd& z) {
  prepare(q);
  return lemke(m, q, ones_, z);
}

LinearPathResult LinearPath::lemke(const ColumnSource& m, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& cover, Eigen::VectorXd& z) {
  prepare(q);
  basis_.bind(m, q, zero_, infinite_, zero_);
  return pursue_from_infinity(cover, z);
}

LinearPathResult LinearPath::lemke(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                   const Eigen::VectorXd& origin, Eigen::VectorXd& z) {
  prepare(q);
  basis_.bind(m, q, lower, upper, origin);
  return pursue_from_infinity(ones_, z);
}

LinearPathResult LinearPath::lemke(const ColumnSource& m, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                   const Eigen::VectorXd& origin, Eigen::VectorXd& z) {
  prepare(q);
  basis_.bind(m, q, lower, upper, origin);
  return pursue_from_infinity(ones_, z);
}

LinearPathResult LinearPath::follow(const Eigen::MatrixXd& m, const Eigen::VectorXd& q,
                                    const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double misfit,
                                    Eigen::VectorXd& z) {
  return follow_matrix(m, q, lower, upper, misfit, z);
}

LinearPathResult LinearPath::follow(const ColumnSource& m, const Eigen::VectorXd& q,
                                    const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, double misfit,
                                    Eigen::VectorXd& z) {
  return follow_matrix(m, q, lower, upper, misfit, z);
}

template <typename Matrix>
LinearPathResult LinearPath::follow_matrix(const Matrix& m, const Eigen::VectorXd& q,
                                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                           double misfit, Eigen::VectorXd& z) {
  prepare(q);
  basis_.bind(m, q, lower, upper, z);
  if (!start_at_point(q, z) || !basis_.solve_at_target()) return finish(LinearPathStatus::singular_basis, z);
  if (basis_.repaired()) accept_misfit(misfit);
  if (target_is_feasible()) return finish(LinearPathStatus::solved, z);
  return_to_start(q);
  return pursue(z);
}

void LinearPath::reserve(Index n) {
  set_size(n);
  ratio_test_.prepare(n, options_.tie_tolerance, options_.pivot_tolerance);
  basis_.reserve(n);
}

void LinearPath::set_size(Index n) {
  if (zero_.size() == n) return;
  zero_.setZero(n);
  infinite_.setConstant(n, infinity);
  ones_.setOnes(n);
}

void LinearPath::prepare(const Eigen::VectorXd& q) {
  const Index n = q.size();
  set_size(n);
  const double scale = 1.0 + (n > 0 ? q.lpNorm<Eigen::Infinity>() : 0.0);
  feasibility_ = options_.tie_tolerance * scale;
  ratio_test_.prepare(n, feasibility_, options_.pivot_tolerance);
  result_ = {};
}

// The active set that the natural map z - F(z) sees (a crash in the sense of Dirkse & Ferris 1997): unknowns
// that it sends out of their bounds start at the bound, the others basic where they are.
bool LinearPath::start_at_point(const Eigen::VectorXd& q, const Eigen::VectorXd& z) {
  const Eigen::VectorXd& lower = basis_.lower();
  const Eigen::VectorXd& upper = basis_.upper();
  for (Index i = 0; i < z.size(); ++i) {
    const double target = z[i] - q[i];
    if (target <= lower[i]) {
      basis_.rest_at_lower(i, std::max(q[i], 0.0));
    } else if (target >= upper[i]) {
      basis_.rest_at_upper(i, std::min(q[i], 0.0));
    } else {
      basis_.make_basic(i);
    }
  }
  return basis_.factor_start();
}

bool LinearPath::start_at_bounds() {
  for (Index i = 0; i < basis_.size(); ++i) {
    if (basis_.lower()[i] > -infinity) {
      basis_.rest_at_lower(i, 0.0);
    } else if (basis_.upper()[i] < infinity) {
      basis_.rest_at_upper(i, 0.0);
    } else {
      basis_.make_basic(i);
    }
  }
  return basis_.factor_start();
}

// Lemke's start: tau so large that every slack has its sign, then down to the first one that loses it. Rows
// that hold with equality are not covered, but for dependent ones, whose misfit has to go to zero along the
// path.
LinearPathResult LinearPath::pursue_from_infinity(const Eigen::VectorXd& cover, Eigen::VectorXd& z) {
  assert(cover.size() == 0 || cover.minCoeff() > 0.0);
  z.resize(basis_.size());
  if (!start_at_bounds() || !basis_.solve_at_target()) return finish(LinearPathStatus::singular_basis, z);
  if (target_is_feasible()) return finish(LinearPathStatus::solved, z);
  Eigen::VectorXd& slacks = basis_.slacks();
  double tau = 0.0;
  for (Index i = 0; i < basis_.size(); ++i) {
    const SlackDomain domain = basis_.slack_domain(i);
    const bool covered =
        basis_.slack_is_basic(i) && domain != SlackDomain::zero && domain != SlackDomain::any;
    const double sign = domain == SlackDomain::nonpositive ? -1.0 : 1.0;
    basis_.cover()[i] = covered ? sign * cover[i] : 0.0;
    if (covered) tau = std::max(tau, -sign * slacks[i] / cover[i]);
  }
  if (tau == 0.0) tau = 1.0;
  for (Index i = 0; i < basis_.size(); ++i) {
    if (basis_.slack_is_basic(i) && basis_.slack_domain(i) == SlackDomain::zero)
      basis_.cover()[i] = -slacks[i] / tau;
  }
  slacks += tau * basis_.cover();
  basis_.set_parameter(tau);
  return pursue(z);
}

bool LinearPath::target_is_feasible() const {
  const Eigen::VectorXd& z = basis_.unknowns();
  for (const Index j : basis_.basic_columns()) {
    if (!(z[j] >= basis_.lower()[j] - feasibility_) || !(z[j] <= basis_.upper()[j] + feasibility_))
      return false;
  }
  for (Index i = 0; i < basis_.size(); ++i) {
    if (!basis_.slack_is_basic(i)) continue;
    const double value = basis_.slacks()[i];
    const SlackDomain domain = basis_.slack_domain(i);
    const bool may_be_negative = domain == SlackDomain::nonpositive || domain == SlackDomain::any;
    const bool may_be_positive = domain == SlackDomain::nonnegative || domain == SlackDomain::any;
    if (!may_be_negative && !(value >= -feasibility_)) return false;
    if (!may_be_positive && !(value <= feasibility_)) return false;
  }
  return true;
}

// Rows found dependent are taken as they come out, if that is close enough to zero.
void LinearPath::accept_misfit(double misfit) {
  for (Index i = 0; i < basis_.size(); ++i) {
    if (!basis_.slack_is_basic(i) || basis_.slack_domain(i) != SlackDomain::zero) continue;
    const double value = basis_.slacks()[i];
    if (std::abs(value) > misfit) continue;
    basis_.shift_row(i, -value);
    basis_.slacks()[i] = 0.0;
  }
}

// Back from the values at tau = 0 to those at tau = 1, of which the misfit is the cover: normal-map start of
// Dirkse & Ferris 1995, with w and v the parts of F(z) that have the right sign.
void LinearPath::return_to_start(const Eigen::VectorXd& q) {
  basis_.return_to_origin();
  basis_.evaluate_base();
  Eigen::VectorXd& slacks = basis_.slacks();
  for (Index i = 0; i < basis_.size(); ++i) {
    slacks[i] = 0.0;
    if (!basis_.slack_is_basic(i)) continue;
    const SlackDomain domain = basis_.slack_domain(i);
    if (domain == SlackDomain::nonnegative) slacks[i] = std::max(q[i], 0.0);
    if (domain == SlackDomain::nonpositive) slacks[i] = std::min(q[i], 0.0);
    if (domain == SlackDomain::any) slacks[i] = q[i];
  }
  basis_.cover() = slacks - basis_.base();
  basis_.set_parameter(1.0);
}

LinearPathResult LinearPath::pursue(Eigen::VectorXd& z) {
  const Index automatic = 100 + 20 * basis_.size();
  const Index limit = options_.max_pivots > 0 ? options_.max_pivots : automatic;
  ratio_test_.begin(basis_);
  Move move{parameter, -1.0};
  for (; result_.pivots < limit; ++result_.pivots) {
    if (!basis_.direction(move.entering, move.sign)) return finish(LinearPathStatus::singular_basis, z);
    orient(move);
    const RatioTest::Leaving leaving = ratio_test_.choose(basis_, move.entering);
    if (leaving.unblocked) return finish(LinearPathStatus::ray, z);
    basis_.advance(leaving.step);
    if (leaving.variable != move.entering) basis_.exchange(move.entering, leaving.variable);
    if (leaving.variable == parameter) return arrive(z);
    move = successor(leaving);
  }
  return finish(LinearPathStatus::pivot_limit, z);
}

// The parameter is out of the basis at zero: the basis is complementary for the problem itself.
LinearPathResult LinearPath::arrive(Eigen::VectorXd& z) {
  ++result_.pivots;
  return finish(basis_.solve_at_target() ? LinearPathStatus::solved : LinearPathStatus::singular_basis, z);
}

// An unknown that left at a bound is followed by its slack, a slack by its unknown, into the side that the
// pair has left. Where dependent rows made the pair incomplete it is followed by the partner that was left
// out for that row.
LinearPath::Move LinearPath::successor(const RatioTest::Leaving& leaving) {
  const Index i = leaving.variable.index;
  const SlackDomain domain = basis_.slack_domain(i);
  if (leaving.variable.kind == Kind::slack) {
    basis_.slacks()[i] = 0.0;
    if (domain == SlackDomain::zero) return move_partner(i, leaving.at_upper ? -1.0 : 1.0);
    return {unknown(i), domain == SlackDomain::nonnegative ? 1.0 : -1.0};
  }
  basis_.unknowns()[i] = leaving.at_upper ? basis_.upper()[i] : basis_.lower()[i];
  basis_.set_slack_domain(i, leaving.at_upper ? SlackDomain::nonpositive : SlackDomain::nonnegative);
  const double sign = leaving.at_upper ? -1.0 : 1.0;
  if (basis_.slack_is_basic(i)) return {unknown(basis_.partner(i)), sign, i};
  return {slack(i), sign};
}

// The slack of a dependent row was about to leave zero: its partner moves instead. If the two are a pair it
// moves against the sign of the slack, as it would if a small multiple of the identity were added to M, which
// for a monotone problem is what leads on to tau = 0.
LinearPath::Move LinearPath::move_partner(Index row, double sign) const {
  const Index partner = basis_.partner(row);
  return {unknown(partner), sign, partner == row ? none : undecided};
}

// Otherwise a partner may move either way: the way that keeps the sign of the slack just released, or that
// brings the parameter down.
void LinearPath::orient(const Move& move) {
  if (move.open_row == none) return;
  const bool released = move.open_row != undecided;
  const double rate = released ? basis_.slack_rates()[move.open_row] : 0.0;
  const double wrong =
      released && basis_.slack_domain(move.open_row) == SlackDomain::nonnegative ? -rate : rate;
  if (wrong > 0.0 || (wrong == 0.0 && basis_.parameter_rate() > 0.0)) basis_.reverse_direction();
}

LinearPathResult LinearPath::finish(LinearPathStatus status, Eigen::VectorXd& z) {
  result_.status = status;
  result_.parameter = basis_.parameter();
  result_.repaired = basis_.repaired();
  result_.ties_broken = ratio_test_.ties_broken();
  z = basis_.unknowns().cwiseMax(basis_.lower()).cwiseMin(basis_.upper());
  return result_;
}

}  // namespace touchstone
