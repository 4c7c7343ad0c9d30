// Closest points and multipliers of a CondensedContact by the LU factors of their rows: of contacts with
// intersections, and where PointElimination does not apply.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/stepper/condensed_contact.h"
#include "core/stepper/fischer_burmeister.h"

namespace touchstone {

namespace {

/// Smallest pivot, relative to its column, with which closest points are eliminated.
constexpr double kRegular = 1e-8;

}  // namespace

template <int Dim>
void CondensedContact<Dim>::fill_eliminated() {
  const StepBlock<Dim>& block = part_.block;
  const auto e = static_cast<Eigen::Index>(eliminated_.size());
  auto matrix = lu_.matrix(e);
  for (Eigen::Index c = 0; c < e; ++c) {
    for (Eigen::Index r = 0; r < e; ++r) {
      matrix(r, c) =
          block.j(eliminated_[static_cast<std::size_t>(r)], eliminated_[static_cast<std::size_t>(c)]);
    }
  }
}

/// Factors of the eliminated rows; where these are singular under load their unknowns are kept.
template <int Dim>
void CondensedContact<Dim>::factor_points(Eigen::Index& reduced_size) {
  fill_eliminated();
  regular_ = lu_.factor(kRegular);
  keeps_points_ = !regular_ && loaded_;
  if (keeps_points_) {
    for (const Eigen::Index c : eliminated_) part_.keep(c, reduced_size);
    return;
  }
  // Of a face above a face any closest points will do while nothing acts there: the nearest to the last ones.
  if (!regular_) {
    fill_eliminated();
    static_cast<void>(lu_.factor_rank_revealing(kRegular));
  }
}

/// Of closest points and multipliers to velocities. Impulses do not act on them: no other column has one.
template <int Dim>
void CondensedContact<Dim>::find_response() {
  const StepBlock<Dim>& block = part_.block;
  const auto e = static_cast<Eigen::Index>(eliminated_.size());
  const Eigen::Index n = block.own;
  response_.resize(static_cast<std::size_t>(e * n));
  double* const response = response_.data();
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = 0; r < e; ++r)
      response[r * n + c] = block.j(eliminated_[static_cast<std::size_t>(r)], c);
  }
  if (regular_ && e < DenseLu::blocked_size) {
    lu_.solve_rows(response, n);
    return;
  }
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = 0; r < e; ++r) column_[r] = response[r * n + c];
    solve_points(column_.data());
    for (Eigen::Index r = 0; r < e; ++r) response[r * n + c] = column_[r];
  }
}

/// Schur complement: the block's kept rows and columns then hold what is left.
template <int Dim>
void CondensedContact<Dim>::subtract_response() {
  StepBlock<Dim>& block = part_.block;
  const auto e = static_cast<Eigen::Index>(eliminated_.size());
  const Eigen::Index n = block.own;
  const double* const response = response_.data();
  std::array<double, 2 * kVelocity> row_sum;
  double* __restrict const sum = row_sum.data();
  for (const Eigen::Index row : part_.kept) {
    std::fill_n(sum, n, 0.0);
    for (Eigen::Index r = 0; r < e; ++r) {
      const double factor = block.j(row, eliminated_[static_cast<std::size_t>(r)]);
      if (factor == 0) continue;
      const double* __restrict const source = response + r * n;
      for (Eigen::Index c = 0; c < n; ++c) sum[c] += factor * source[c];
    }
    for (Eigen::Index c = 0; c < n; ++c) block.j(row, c) -= sum[c];
  }
}

template <int Dim>
void CondensedContact<Dim>::solve_points(double* x) {
  if (regular_) {
    lu_.solve(x);
    return;
  }
  std::copy_n(x, eliminated_.size(), scratch_.data());
  lu_.solve_least_norm(scratch_.data(), x);
}

template <int Dim>
double CondensedContact<Dim>::points_residual(const CondensedForm& form, const Eigen::VectorXd& z) {
  StepBlock<Dim>& block = part_.block;
  const Eigen::Index first = problem_->layout().contact(i_).multipliers_1;
  problem_->evaluate_state(i_, z);
  problem_->contact_block(i_, true, block);
  double residual = problem_->is_spurious(i_) ? StepProblem<Dim>::kSpuriousResidual : 0.0;
  for (Eigen::Index r = block.own; r < block.at.friction; ++r)
    residual = std::max(residual, std::abs(block.f[r]));
  for (Eigen::Index r = block.at.multipliers_1; r < block.size; ++r) {
    const double multiplier = z[first + r - block.at.multipliers_1];
    const double value = form.multipliers_by_active_set()
                             ? std::min(multiplier, block.f[r])
                             : FischerBurmeisterTerm(multiplier, block.f[r], form.smoothing).value;
    residual = std::max(residual, std::abs(value));
  }
  return residual;
}

template <int Dim>
bool CondensedContact<Dim>::points_step(const CondensedForm& form, Eigen::VectorXd& z) {
  choose_rows(form, z);
  set_rows(form, z, true);
  list_points();
  fill_eliminated();
  if (!lu_.factor(kRegular)) return false;
  const std::size_t e = eliminated_.size();
  for (std::size_t r = 0; r < e; ++r) offset_[static_cast<Eigen::Index>(r)] = part_.block.f[eliminated_[r]];
  lu_.solve(offset_.data());
  for (std::size_t r = 0; r < e; ++r) z[column_in_z(eliminated_[r])] -= offset_[static_cast<Eigen::Index>(r)];
  return true;
}

template void CondensedContact<2>::factor_points(Eigen::Index&);
template void CondensedContact<3>::factor_points(Eigen::Index&);
template void CondensedContact<2>::find_response();
template void CondensedContact<3>::find_response();
template void CondensedContact<2>::subtract_response();
template void CondensedContact<3>::subtract_response();
template void CondensedContact<2>::solve_points(double*);
template void CondensedContact<3>::solve_points(double*);
template double CondensedContact<2>::points_residual(const CondensedForm&, const Eigen::VectorXd&);
template double CondensedContact<3>::points_residual(const CondensedForm&, const Eigen::VectorXd&);
template bool CondensedContact<2>::points_step(const CondensedForm&, Eigen::VectorXd&);
template bool CondensedContact<3>::points_step(const CondensedForm&, Eigen::VectorXd&);

}  // namespace touchstone
