#include "core/stepper/central_path.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kMostSteps = 400;
constexpr int kCorrections = 6;           ///< Newton steps back to the path
constexpr double kFirstLength = 0.1;      ///< of a step, in units of the unknowns and of log(epsilon)
constexpr double kShortestLength = 1e-9;  ///< below which the path is given up
constexpr double kShorter = 0.4;          ///< factors of the length, after a step that failed
constexpr double kSlower = 0.7;           ///< and after one with kManyCorrections
constexpr double kLonger = 2.0;           ///< and after one with kFewCorrections
constexpr int kFewCorrections = 2;
constexpr int kManyCorrections = 4;
/// In m V: normal impulses that no step calls for, and those that tell why a path ends.
constexpr double kUnbounded = 1e6;
constexpr double kLarge = 1e5;
constexpr double kContraction = 0.5;  ///< of the corrections, below which a step is too long
/// Where the curvature of a surface jumps (a capsule, where cylinder and cap meet) the path has a kink,
/// across which even a short step needs a long correction. Steps below this length may be such.
constexpr double kKinkLength = 1e-3;
constexpr double kKinkCorrection = 10;  ///< the first correction of such a step, over its length
constexpr double kClose = 1e-3;         ///< last correction, over the step
constexpr double kNoise = 1e-10;        ///< of a correction, by rounding
constexpr double kCloseRows = 1e-2;     ///< residual, over epsilon

}  // namespace

template <int Dim>
void CentralPath<Dim>::begin(StepProblem<Dim>& problem, double epsilon) {
  system_.begin(problem, epsilon);
  z_ = system_.start();
  tau_ = 0;
  tangent_.setZero(z_.size() + 1);
  tangent_[z_.size()] = -1;
  length_ = kFirstLength;
  steps_ = 0;
  factorisations_ = 0;
}

template <int Dim>
auto CentralPath<Dim>::follow_to(double epsilon) -> State {
  constexpr double kNear = 1e-3;  // a part of epsilon that makes no difference
  const double end = system_.parameter(epsilon);
  while (tau_ > end + kNear) {
    if (largest_impulse() > kUnbounded) return State::unbounded;
    if (!advance(end)) return largest_impulse() > kLarge ? State::unbounded : State::stuck;
  }
  return State::arrived;
}

/// One step, as long as it can be. False if there is none.
template <int Dim>
bool CentralPath<Dim>::advance(double end) {
  if (!find_tangent()) return false;
  const double slope = tangent_[z_.size()];
  while (++steps_ <= kMostSteps && length_ >= kShortestLength) {
    const double length = slope < 0 ? std::min(length_, (end - tau_) / slope) : length_;
    if (!try_step(length)) {
      length_ = kShorter * length;
      continue;
    }
    z_ = trial_;
    tau_ = trial_tau_;
    const double factor = corrections_ <= kFewCorrections    ? kLonger
                          : corrections_ >= kManyCorrections ? kSlower
                                                             : 1.0;
    // One that ended where it was told to says nothing of the next one's length.
    const double next = std::max(factor * length, length < length_ ? length_ : 0.0);
    length_ = std::min(next, std::max(1.0, 0.5 * z_.cwiseQuotient(system_.unit()).norm()));
    return true;
  }
  return false;
}

template <int Dim>
double CentralPath<Dim>::largest_impulse() const {
  double largest = 0;
  for (Eigen::Index i = 0; i < z_.size(); ++i) {
    if (system_.is_impulse(i)) largest = std::max(largest, z_[i]);
  }
  return largest;
}

template <int Dim>
void CentralPath<Dim>::estimate(Eigen::VectorXd& z, bool closed) const {
  z.head(z_.size()) = z_;
  if (closed) system_.close(z);
}

/// The direction in which the path goes on from z: the one that keeps on in the last direction.
template <int Dim>
bool CentralPath<Dim>::find_tangent() {
  if (!system_.differentiate(z_, tau_)) return false;
  factor(tangent_);
  solution_.setZero(z_.size() + 1);
  solution_[z_.size()] = 1;
  solution_ = lu_.solve(solution_);
  if (!solution_.allFinite()) return false;
  tangent_ = solution_.normalized();
  return true;
}

/// Euler's step, and Newton's method across it. False if that does not contract, which a shorter one will.
template <int Dim>
bool CentralPath<Dim>::try_step(double length) {
  const Eigen::Index n = z_.size();
  trial_ = z_ + length * system_.unit().cwiseProduct(tangent_.head(n));
  trial_tau_ = tau_ + length * tangent_[n];
  double before = length;
  for (corrections_ = 0; corrections_ < kCorrections; ++corrections_) {
    if (!system_.differentiate(trial_, trial_tau_)) return false;
    const double residual = system_.rows().cwiseAbs().maxCoeff();
    const bool close = residual < kCloseRows * system_.epsilon(trial_tau_);
    factor(tangent_);
    solution_.setZero(n + 1);
    solution_.head(n) = -system_.rows().cwiseProduct(row_scale_);
    solution_ = lu_.solve(solution_);
    const double size = solution_.norm();
    const bool at_kink = corrections_ == 0 && length < kKinkLength;
    if (!(size <= (at_kink ? kKinkCorrection : kContraction) * before)) return false;
    before = size;
    trial_ += system_.unit().cwiseProduct(solution_.head(n));
    trial_tau_ += solution_[n];
    if (close && size < std::max(kClose * std::min(1.0, length), kNoise)) return true;
  }
  return false;
}

/// Derivatives by (z over its units, tau), rows of one size, bordered by `last_row`.
template <int Dim>
void CentralPath<Dim>::factor(const Eigen::VectorXd& last_row) {
  const Eigen::Index n = z_.size();
  matrix_.resize(n + 1, n + 1);
  matrix_.topLeftCorner(n, n) = system_.by_z() * system_.unit().asDiagonal();
  row_scale_ = matrix_.topLeftCorner(n, n).cwiseAbs().rowwise().maxCoeff();
  row_scale_ = (row_scale_.array() > 0).select(row_scale_.cwiseInverse(), 1.0);
  matrix_.topRightCorner(n, 1) = system_.by_tau();
  matrix_.topRows(n) = row_scale_.asDiagonal() * matrix_.topRows(n);
  matrix_.row(n) = last_row.transpose();
  lu_.compute(matrix_);
  ++factorisations_;
}

template class CentralPath<2>;
template class CentralPath<3>;

}  // namespace touchstone
