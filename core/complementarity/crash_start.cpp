#include "core/complementarity/crash_start.h"

namespace touchstone {

using Eigen::Index;

namespace {

constexpr double singular_pivot = 1e-12;  // relative to the column

// Added to the diagonal of the equations that are solved, relative to their largest entry, where they are
// singular: far from a solution they often are.
constexpr double perturbation_of_singular = 1e-6;

}  // namespace

void CrashStart::run(const MixedComplementarityProblem& problem, int steps, MeritSearch& search) {
  places_.clear();
  for (int step = 0; step < steps && !search.converged(); ++step) {
    const Iterate& at = search.current();
    if (!choose_places(problem, at) || !find_direction(problem, at)) return;
    const double slope = -2.0 * at.merit;  // as that of a Newton direction for Phi
    if (!search.backtrack(direction_, slope, search.longest_step(direction_), /*project=*/true)) return;
  }
}

// Where the natural map sends each unknown; false if that is where they were a step before.
bool CrashStart::choose_places(const MixedComplementarityProblem& problem, const Iterate& at) {
  new_places_.assign(static_cast<std::size_t>(at.z.size()), Place::between);
  for (Index i = 0; i < at.z.size(); ++i) {
    const double target = at.z[i] - at.f[i];
    if (target <= problem.lower()[i]) new_places_[static_cast<std::size_t>(i)] = Place::lower;
    if (target >= problem.upper()[i]) new_places_[static_cast<std::size_t>(i)] = Place::upper;
  }
  if (new_places_ == places_) return false;
  places_.swap(new_places_);
  return true;
}

// K d = r with K the Jacobian in the rows of unknowns between their bounds, where r = -F, and the identity in
// the others, where r leads to the bound.
bool CrashStart::find_direction(const MixedComplementarityProblem& problem, const Iterate& at) {
  direction_ = -at.f;
  for (Index i = 0; i < at.z.size(); ++i) {
    const Place place = places_[static_cast<std::size_t>(i)];
    if (place == Place::lower) direction_[i] = problem.lower()[i] - at.z[i];
    if (place == Place::upper) direction_[i] = problem.upper()[i] - at.z[i];
  }
  return (at.is_sparse ? solve_sparse(at) : solve_dense(at)) && direction_.allFinite();
}

void CrashStart::fill_dense(const Iterate& at, double perturbation) {
  Eigen::Map<Eigen::MatrixXd> k = lu_.matrix(at.z.size());
  k = at.jacobian;
  for (Index i = 0; i < at.z.size(); ++i) {
    if (!is_between(i)) k.row(i).setZero();
    k(i, i) = is_between(i) ? k(i, i) + perturbation : 1.0;
  }
}

bool CrashStart::solve_dense(const Iterate& at) {
  fill_dense(at, 0.0);
  if (!lu_.factor(singular_pivot)) {
    fill_dense(at, perturbation_of_singular * at.jacobian.cwiseAbs().maxCoeff());
    if (!lu_.factor(singular_pivot)) return false;
  }
  lu_.solve(direction_.data());
  return true;
}

bool CrashStart::solve_sparse(const Iterate& at) {
  Eigen::VectorXd between(at.z.size());
  for (Index i = 0; i < between.size(); ++i) between[i] = is_between(i) ? 1.0 : 0.0;
  const double perturbation = perturbation_of_singular * at.sparse_jacobian.coeffs().abs().maxCoeff();
  for (const double added : {0.0, perturbation}) {
    Eigen::SparseMatrix<double> diagonal(between.size(), between.size());
    diagonal = Eigen::VectorXd((1.0 - between.array()) + added * between.array()).asDiagonal();
    Eigen::SparseMatrix<double> k = between.asDiagonal() * at.sparse_jacobian;
    k += diagonal;
    sparse_lu_.compute(k);
    if (sparse_lu_.info() != Eigen::Success) continue;
    direction_ = Eigen::VectorXd(sparse_lu_.solve(direction_));
    return true;
  }
  return false;
}

}  // namespace touchstone
