#include "core/stepper/interior_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchstone {

namespace {

constexpr double kRegular = 1e-8;  ///< smallest pivot, relative to its column, to eliminate points with
constexpr double kLost = 1e-2;     ///< residual of closest points above which they are found anew
constexpr int kHalvings = 60;      ///< of an interval, to rounding

}  // namespace

template <int Dim>
void InteriorContact<Dim>::bind(StepProblem<Dim>& problem, std::size_t i) {
  problem_ = &problem;
  i_ = i;
  mu_ = problem.contacts()[i].law.mu;
  gap_weight_ = problem.scale().length / (problem.step_size() * problem.scale().velocity);
}

template <int Dim>
auto InteriorContact<Dim>::start(const Eigen::VectorXd& z, double tau) -> Unknowns {
  problem_->evaluate_state(i_, z);
  problem_->contact_block(i_, false, block_);
  const ContactLayout& in_z = problem_->layout().contact(i_);
  Unknowns at;
  const double p_less_gap = z[in_z.normal] - gap_weight_ * block_.f[block_.at.normal];
  const double root = std::sqrt(p_less_gap * p_less_gap + 4 * tau);
  // The larger of the two without cancellation, the other one from the product.
  const double larger = (std::abs(p_less_gap) + root) / 2;
  at.p = p_less_gap > 0 ? larger : tau / larger;
  at.gap = p_less_gap > 0 ? tau / larger : larger;
  if (mu_ == 0) return at;
  // y = b d and w = -sigma b d / R, of a unit vector d and R = mu p, with sigma = tau R / (R^2 - b^2): b +
  // |w| grows with b, from 0 to infinity at R.
  const FrictionVector<Dim> difference =
      z.template segment<kFriction>(in_z.friction) - block_.f.template segment<kFriction>(block_.at.friction);
  const double length = difference.norm();
  const double radius = mu_ * at.p;
  const auto sigma = [&](double b) { return tau * radius / ((radius - b) * (radius + b)); };
  double below = 0;
  double above = radius;
  for (int k = 0; k < kHalvings; ++k) {
    const double b = (below + above) / 2;
    (b + sigma(b) / radius * b < length ? below : above) = b;
  }
  at.slip[0] = sigma(below);
  if (length > 0) {
    at.y = below / length * difference;
    at.slip.template tail<kFriction>() = -at.slip[0] / radius * at.y;
  }
  return at;
}

template <int Dim>
bool InteriorContact<Dim>::evaluate(const Unknowns& at, Eigen::VectorXd& z) {
  problem_->evaluate_state(i_, z);
  problem_->contact_block(i_, true, block_);
  if (!(points_residual() <= kLost)) {
    problem_->find_points(i_, z);
    problem_->evaluate_state(i_, z);
    problem_->contact_block(i_, true, block_);
  }
  std::iota(columns_.begin(), columns_.end(), Eigen::Index{0});
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (block_.place[k] < 0) continue;
    const auto first = places_.begin() + block_.column[k];
    std::iota(first, first + kVelocity, Eigen::Index{kVelocity} * block_.place[k]);
  }
  if (!factor_points()) return false;
  eliminate_points();
  slack_.template head<kFriction>() -= at.slip.template tail<kFriction>();
  slack_[kFriction] -= at.gap;
  set_answer(at);
  return true;
}

template <int Dim>
double InteriorContact<Dim>::points_residual() const {
  const Eigen::Index count = block_.at.friction - block_.own;
  const double residual = count > 0 ? block_.f.segment(block_.own, count).cwiseAbs().maxCoeff() : 0.0;
  return problem_->is_spurious(i_) ? StepProblem<Dim>::kSpuriousResidual : residual;
}

template <int Dim>
bool InteriorContact<Dim>::factor_points() {
  const Eigen::Index n = block_.own;
  const Eigen::Index count = block_.at.friction - n;
  lu_.matrix(count) = block_.j.block(n, n, count, count);
  return lu_.factor(kRegular);
}

/// Schur complement in the rows of momentum, slip and gap.
template <int Dim>
void InteriorContact<Dim>::eliminate_points() {
  const Eigen::Index n = block_.own;
  const Eigen::Index count = block_.at.friction - n;
  const Eigen::MatrixXd& j = block_.j;
  point_response_ = j.block(n, 0, count, n);
  point_offset_ = block_.f.segment(n, count);
  for (Eigen::Index c = 0; c < n; ++c) lu_.solve(point_response_.col(c).data());
  lu_.solve(point_offset_.data());
  stiffness_ = j.topLeftCorner(n, n);
  stiffness_.noalias() -= j.block(0, n, n, count) * point_response_;
  wrench_ = block_.f.head(n);
  wrench_.noalias() -= j.block(0, n, n, count) * point_offset_;
  by_impulse_ = j.block(0, block_.at.friction, n, kRows);
  motion_ = j.block(block_.at.friction, 0, kRows, n);
  motion_.noalias() -= j.block(block_.at.friction, n, kRows, count) * point_response_;
  slack_ = block_.f.template segment<kRows>(block_.at.friction);
  slack_.noalias() -= j.block(block_.at.friction, n, kRows, count) * point_offset_;
  motion_.row(kFriction) *= gap_weight_;
  slack_[kFriction] *= gap_weight_;
}

/// How impulses answer to a change of slip and gap. From p gap = tau follows dp = -p / gap d gap; from the
/// cone, d(mu p, y) = - W^2 d(sigma, w), whose first row gives d sigma.
template <int Dim>
void InteriorContact<Dim>::set_answer(const Unknowns& at) {
  answer_.setZero();
  answer_(kFriction, kFriction) = at.p / at.gap;
  if (mu_ == 0) return;
  scaling_ = ConeScaling<kRows>(at.load(mu_), at.slip);
  scaled_ = scaling_.apply(at.slip);
  answer_.template topLeftCorner<kFriction, kFriction>() = scaling_.schur_complement();
  answer_.template topRightCorner<kFriction, 1>() =
      mu_ * answer_(kFriction, kFriction) / scaling_.head() * scaling_.side();
}

template <int Dim>
double InteriorContact<Dim>::slack() const {
  return slack_.cwiseAbs().maxCoeff();
}

template <int Dim>
auto InteriorContact<Dim>::floors(const Unknowns& at, double floor) const -> Floors {
  const Element load = at.load(mu_);
  return {floor * at.p,
          mu_ == 0 ? 0.0 : floor * std::max(Cone::determinant(load) / load[0], load[0] * at.slip[0])};
}

template <int Dim>
double InteriorContact<Dim>::complementarity(const Unknowns& at, double floor) const {
  constexpr double kNear = 2.0;
  const Floors least = floors(at, floor);
  const double normal = at.p * at.gap;
  const double friction = mu_ == 0 ? 0.0 : at.load(mu_).dot(at.slip);
  return ((normal > kNear * least.normal ? normal : 0.0) +
          (friction > kNear * least.friction ? friction : 0.0)) /
         2;
}

template <int Dim>
auto InteriorContact<Dim>::matrix() const -> Block {
  Block matrix = stiffness_;
  matrix.noalias() -= by_impulse_ * (answer_ * motion_);
  return matrix;
}

template <int Dim>
auto InteriorContact<Dim>::begin_direction(const Unknowns& at, const Goal& goal) -> OfVelocities {
  moves_slack_ = !goal.tangent;
  const Rows slack = moves_slack_ ? slack_ : Rows::Zero();
  const Floors least = floors(at, goal.floor);
  double right_side = goal.tau > least.normal ? goal.tau : 0.0;
  if (!goal.tangent) right_side = std::max(goal.tau, least.normal) - at.p * at.gap;
  if (goal.second_order) right_side -= direction_.p * direction_.gap;
  offset_[kFriction] = right_side / at.gap - answer_(kFriction, kFriction) * slack[kFriction];
  offset_.template head<kFriction>().setZero();
  if (mu_ > 0) {
    Element right = Element::Zero();
    right[0] = goal.tau > least.friction ? goal.tau : 0.0;
    if (!goal.tangent) {
      right[0] = std::max(goal.tau, least.friction);
      right -= Cone::product(scaled_, scaled_);
    }
    if (goal.second_order)
      right -= Cone::product(scaling_.apply_inverse(direction_.load(mu_)), scaling_.apply(direction_.slip));
    centred_ = scaling_.apply(Cone::quotient(scaled_, right));
    offset_.template head<kFriction>() =
        centred_.template tail<kFriction>() +
        (mu_ * offset_[kFriction] - centred_[0]) / scaling_.head() * scaling_.side() -
        answer_.template topLeftCorner<kFriction, kFriction>() * slack.template head<kFriction>();
  }
  impulse_ = offset_;
  return by_impulse_ * offset_;
}

template <int Dim>
void InteriorContact<Dim>::respond(const Eigen::VectorXd& velocity) {
  impulse_.noalias() -= answer_ * (motion_ * gather(velocity));
}

template <int Dim>
auto InteriorContact<Dim>::momentum_change(const Eigen::VectorXd& velocity) const -> OfVelocities {
  return stiffness_ * gather(velocity) + by_impulse_ * impulse_;
}

template <int Dim>
auto InteriorContact<Dim>::end_direction(const Eigen::VectorXd& velocity) -> Unknowns {
  Rows motion = motion_ * gather(velocity);
  if (moves_slack_) motion += slack_;
  Unknowns step;
  step.y = impulse_.template head<kFriction>();
  step.p = impulse_[kFriction];
  step.gap = motion[kFriction];
  if (mu_ > 0) {
    const FrictionVector<Dim> slip = motion.template head<kFriction>();
    step.slip << (centred_[0] - mu_ * step.p - scaling_.side().dot(slip)) / scaling_.head(), slip;
  }
  direction_ = step;
  return step;
}

template <int Dim>
void InteriorContact<Dim>::move_points(const Eigen::VectorXd& velocity, double factor, bool residual,
                                       Eigen::VectorXd& z) const {
  auto points = z.segment(problem_->layout().contact(i_).point_1, point_offset_.size());
  points.noalias() -= factor * (point_response_ * gather(velocity));
  if (residual) points -= factor * point_offset_;
}

template <int Dim>
double InteriorContact<Dim>::longest_step(const Unknowns& at, const Unknowns& step) const {
  double longest = std::numeric_limits<double>::infinity();
  if (step.p < 0) longest = std::min(longest, -at.p / step.p);
  if (step.gap < 0) longest = std::min(longest, -at.gap / step.gap);
  if (mu_ == 0) return longest;
  return std::min(
      {longest, Cone::longest_step(at.load(mu_), step.load(mu_)), Cone::longest_step(at.slip, step.slip)});
}

template <int Dim>
double InteriorContact<Dim>::scalar_product(const Unknowns& at, const Unknowns& a, const Unknowns& b) const {
  double sum = a.p * b.p / (at.p * at.p) + a.gap * b.gap / (at.gap * at.gap);
  if (mu_ > 0) {
    const double radius = mu_ * at.p;
    sum += a.y.dot(b.y) / (radius * radius) + a.slip.dot(b.slip) / (at.slip[0] * at.slip[0]);
  }
  return sum;
}

template <int Dim>
double InteriorContact<Dim>::largest(const Unknowns& at, const Unknowns& step) const {
  const double normal = std::max(std::abs(step.p) / at.p, std::abs(step.gap) / at.gap);
  if (mu_ == 0) return normal;
  return std::max({normal, step.y.norm() / (mu_ * at.p), step.slip.norm() / at.slip[0]});
}

template <int Dim>
auto InteriorContact<Dim>::gather(const Eigen::VectorXd& velocity) const -> OfVelocities {
  OfVelocities own(block_.own);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (block_.place[k] >= 0)
      own.template segment<kVelocity>(block_.column[k]) =
          velocity.template segment<kVelocity>(kVelocity * block_.place[k]);
  }
  return own;
}

template class InteriorContact<2>;
template class InteriorContact<3>;

}  // namespace touchstone
