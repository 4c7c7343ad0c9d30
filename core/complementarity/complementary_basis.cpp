#include "core/complementarity/complementary_basis.h"

#include <algorithm>
#include <cassert>

namespace touchstone {

using Eigen::Index;
using Kind = PathVariable::Kind;

void ComplementaryBasis::reserve(Index n) {
  set_size(n);
  q_.resize(n);
  origin_.resize(n);
  for (std::vector<Index>* list : {&column_position_, &row_position_, &partner_}) list->reserve(at(n + 1));
  domain_.reserve(at(n));
  columns_.reserve(n);
  core_.reserve(n + 1);
}

void ComplementaryBasis::set_size(Index n) {
  if (n == n_ && z_.size() == n) return;
  for (Eigen::VectorXd* v : {&cover_, &base_, &z_, &s_, &dz_, &ds_}) v->setZero(n);
  const Index core = n + 1;
  for (Eigen::VectorXd* v : {&entering_column_, &solved_, &row_, &probe_column_, &probe_}) v->resize(core);
  for (std::vector<Index>* list : {&basic_columns_, &rows_, &all_columns_, &all_rows_})
    list->reserve(at(core));
  n_ = n;
}

void ComplementaryBasis::bind_vectors(const Eigen::VectorXd& q, const Eigen::VectorXd& lower,
                                      const Eigen::VectorXd& upper, const Eigen::VectorXd& origin) {
  const Index n = columns_.size();
  assert(q.size() == n && lower.size() == n && upper.size() == n && origin.size() == n);
  set_size(n);
  lower_ = &lower;
  upper_ = &upper;
  q_ = q;
  origin_ = origin;
  basic_columns_.clear();
  rows_.clear();
  column_position_.assign(at(n + 1), -1);
  row_position_.assign(at(n), -1);
  domain_.assign(at(n), SlackDomain::nonnegative);
  partner_.assign(at(n), -1);
  repaired_ = false;
  tau_ = 0.0;
}

void ComplementaryBasis::rest(Index i, double value, double slack, SlackDomain domain) {
  z_[i] = value;
  s_[i] = slack;
  domain_[at(i)] = (*lower_)[i] == (*upper_)[i] ? SlackDomain::any : domain;
}

void ComplementaryBasis::rest_at_lower(Index i, double slack) {
  rest(i, (*lower_)[i], slack, SlackDomain::nonnegative);
}

void ComplementaryBasis::rest_at_upper(Index i, double slack) {
  rest(i, (*upper_)[i], slack, SlackDomain::nonpositive);
}

void ComplementaryBasis::make_basic(Index i) {
  z_[i] = origin_[i];
  s_[i] = 0.0;
  add_column(i);
  add_row(i);
}

void ComplementaryBasis::add_row(Index row) {
  row_position_[at(row)] = static_cast<Index>(rows_.size());
  rows_.push_back(row);
}

void ComplementaryBasis::add_column(Index j) {
  column_position_[at(j)] = static_cast<Index>(basic_columns_.size());
  basic_columns_.push_back(j);
}

bool ComplementaryBasis::factor_start() {
  fill_core();
  if (core_.factor()) return true;
  repaired_ = true;
  const Index rank = core_.reveal_rank();
  rows_.swap(all_rows_);
  basic_columns_.swap(all_columns_);
  // The null spaces of a monotone block and of its transpose are the same, so that the rows of the dependent
  // columns are dependent themselves: pairs stay pairs. Otherwise the rows are those that the elimination
  // found.
  return keep_independent(rank, core_.independent_columns()) ||
         keep_independent(rank, core_.independent_rows());
}

void ComplementaryBasis::fill_core() {
  const auto k = static_cast<Index>(rows_.size());
  core_.resize(k);
  for (Index c = 0; c < k; ++c) {
    const double* const values = column(basic_columns_[at(c)]);
    for (Index r = 0; r < k; ++r) core_.entry(r, c) = values[rows_[at(r)]];
  }
}

// Leaves the unknowns of the dependent columns nonbasic where they are and takes the slacks of as many rows
// into the basis, held at zero, each with one of those unknowns as its partner: the one to enter should that
// slack have to move. A consistent system thus keeps its undetermined unknowns unchanged.
bool ComplementaryBasis::keep_independent(Index rank, const std::vector<Index>& row_order) {
  const std::vector<Index>& column_order = core_.independent_columns();
  rows_.clear();
  basic_columns_.clear();
  std::fill(row_position_.begin(), row_position_.end(), Index{-1});
  std::fill(column_position_.begin(), column_position_.end(), Index{-1});
  for (std::size_t p = 0; p < all_rows_.size(); ++p) {
    const Index row = all_rows_[at(row_order[p])];
    const Index unknown = all_columns_[at(column_order[p])];
    domain_[at(row)] = SlackDomain::nonnegative;
    if (static_cast<Index>(p) < rank) {
      add_row(row);
      add_column(unknown);
    } else {
      domain_[at(row)] = SlackDomain::zero;
      partner_[at(row)] = unknown;
    }
  }
  fill_core();
  return core_.factor();
}

void ComplementaryBasis::return_to_origin() {
  for (const Index j : basic_columns_) z_[j] = origin_[j];
}

void ComplementaryBasis::evaluate_base() {
  base_ = q_;
  for (Index j = 0; j < n_; ++j) {
    const double moved = z_[j] - origin_[j];
    if (moved == 0.0 || column_position_[at(j)] >= 0) continue;
    base_.noalias() += moved * Eigen::Map<const Eigen::VectorXd>(column(j), n_);
    columns_.release(j);
  }
}

bool ComplementaryBasis::solve_at_target() {
  assert(column_position_[at(n_)] < 0);
  evaluate_base();
  const Index k = core_.size();
  for (Index r = 0; r < k; ++r) entering_column_[r] = -base_[rows_[at(r)]];
  if (!core_.solve(entering_column_, solved_)) return false;
  s_ = base_;
  for (Index c = 0; c < k; ++c) {
    const Index j = basic_columns_[at(c)];
    z_[j] = origin_[j] + solved_[c];
  }
  add_basic_columns(1.0, s_);
  for (const Index row : rows_) s_[row] = 0.0;
  tau_ = 0.0;
  return true;
}

// target += factor * (basic columns) * solved_, in the rows whose slack is basic; what the others get is of
// no use. Few such rows are summed up one by one; many by columns, four at a time so that the target is read
// and written less.
void ComplementaryBasis::add_basic_columns(double factor, Eigen::VectorXd& target) {
  const Index k = core_.size();
  if (4 * (n_ - k) <= n_) {
    for (Index i = 0; i < n_; ++i) {
      if (!slack_is_basic(i)) continue;
      double sum = 0.0;
      for (Index c = 0; c < k; ++c) sum += solved_[c] * column(basic_columns_[at(c)])[i];
      target[i] += factor * sum;
    }
    return;
  }
  const auto values = [this](Index c) {
    return Eigen::Map<const Eigen::VectorXd>(column(basic_columns_[at(c)]), n_);
  };
  Index c = 0;
  for (; c + 3 < k; c += 4) {
    target.noalias() += (factor * solved_[c]) * values(c) + (factor * solved_[c + 1]) * values(c + 1) +
                        (factor * solved_[c + 2]) * values(c + 2) + (factor * solved_[c + 3]) * values(c + 3);
  }
  for (; c < k; ++c) target.noalias() += (factor * solved_[c]) * values(c);
}

bool ComplementaryBasis::is_basic(PathVariable variable) const {
  if (variable.kind == Kind::slack) return slack_is_basic(variable.index);
  return column_position_[at(structural(variable, n_))] >= 0;
}

Index ComplementaryBasis::structural(PathVariable variable, Index n) {
  return variable.kind == Kind::parameter ? n : variable.index;
}

// The solution is K^-1 times the entering column: of a structural variable its entries in the rows of the
// core, of a slack the unit vector of its row.
bool ComplementaryBasis::solve_entering(PathVariable entering, Eigen::VectorXd& solution) {
  const Index k = core_.size();
  Eigen::VectorXd& right = &solution == &probe_ ? probe_column_ : entering_column_;
  if (entering.kind == Kind::slack) {
    right.head(k).setZero();
    right[row_position_[at(entering.index)]] = 1.0;
  } else {
    const double* const values = column(structural(entering, n_));
    for (Index r = 0; r < k; ++r) right[r] = values[rows_[at(r)]];
  }
  return core_.solve(right, solution);
}

bool ComplementaryBasis::direction(PathVariable entering, double sign) {
  assert(!is_basic(entering));
  if (!solve_entering(entering, solved_)) return false;
  const bool slack_enters = entering.kind == Kind::slack;
  dz_.setZero();
  dtau_ = 0.0;
  if (slack_enters) {
    ds_.setZero();
  } else {
    ds_ = sign * Eigen::Map<const Eigen::VectorXd>(column(structural(entering, n_)), n_);
  }
  for (Index c = 0; c < core_.size(); ++c) {
    const Index j = basic_columns_[at(c)];
    const double rate = slack_enters ? sign * solved_[c] : -sign * solved_[c];
    (j == n_ ? dtau_ : dz_[j]) = rate;
  }
  add_basic_columns(slack_enters ? sign : -sign, ds_);
  for (const Index row : rows_) ds_[row] = 0.0;
  if (slack_enters) {
    ds_[entering.index] = sign;
  } else {
    (entering.kind == Kind::parameter ? dtau_ : dz_[entering.index]) = sign;
  }
  return true;
}

void ComplementaryBasis::reverse_direction() {
  dz_ = -dz_;
  ds_ = -ds_;
  dtau_ = -dtau_;
}

void ComplementaryBasis::advance(double step) {
  z_ += step * dz_;
  s_ += step * ds_;
  tau_ += step * dtau_;
}

void ComplementaryBasis::gather_row(Index row) {
  for (Index c = 0; c < core_.size(); ++c) row_[c] = column(basic_columns_[at(c)])[row];
}

void ComplementaryBasis::exchange(PathVariable entering, PathVariable leaving) {
  const bool slack_enters = entering.kind == Kind::slack;
  const bool slack_leaves = leaving.kind == Kind::slack;
  const Index in = slack_enters ? entering.index : structural(entering, n_);
  const Index out = slack_leaves ? leaving.index : structural(leaving, n_);
  if (slack_leaves) gather_row(out);
  if (!slack_enters && slack_leaves) {
    core_.append(entering_column_, row_, column(in)[out], solved_);
    add_row(out);
    add_column(in);
    return;
  }
  if (!slack_enters) {
    const Index position = column_position_[at(out)];
    core_.replace_column(position, entering_column_, solved_);
    basic_columns_[at(position)] = in;
    column_position_[at(in)] = position;
  } else if (slack_leaves) {
    const Index position = row_position_[at(in)];
    core_.replace_row(position, row_);
    rows_[at(position)] = out;
    row_position_[at(out)] = position;
    row_position_[at(in)] = -1;
    return;
  } else {
    const Index r = row_position_[at(in)];
    const Index c = column_position_[at(out)];
    core_.remove(r, c);
    rows_[at(r)] = rows_.back();
    row_position_[at(rows_[at(r)])] = r;
    rows_.pop_back();
    row_position_[at(in)] = -1;
    basic_columns_[at(c)] = basic_columns_.back();
    column_position_[at(basic_columns_[at(c)])] = c;
    basic_columns_.pop_back();
  }
  column_position_[at(out)] = -1;
  if (out != n_) columns_.release(out);
}

bool ComplementaryBasis::probe(PathVariable nonbasic) {
  if (probed_.kind == Kind::unknown && probed_.index < n_ && column_position_[at(probed_.index)] < 0) {
    columns_.release(probed_.index);
  }
  probed_ = nonbasic;
  return solve_entering(nonbasic, probe_);
}

double ComplementaryBasis::probed_rate(PathVariable basic) {
  const bool slack_moves = probed_.kind == Kind::slack;
  const double sign = slack_moves ? 1.0 : -1.0;
  if (basic.kind != Kind::slack) return sign * probe_[column_position_[at(structural(basic, n_))]];
  double rate = slack_moves ? 0.0 : column(structural(probed_, n_))[basic.index];
  for (Index c = 0; c < core_.size(); ++c)
    rate += sign * probe_[c] * column(basic_columns_[at(c)])[basic.index];
  return rate;
}

}  // namespace touchstone
