#include "core/stepper/interior_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/stepper/momentum_matrices.h"

namespace touchstone {

namespace {

// of descend()
constexpr int kMostSystems = 60;
constexpr double kToBoundary = 0.99;  ///< part of the way to the boundary that a step may go
constexpr double kGain = 0.7;         ///< factor of mean product or residual that counts as a gain
constexpr int kPatience = 10;         ///< steps without one that end it
constexpr double kNoise = 1e-13;      ///< residual below which a gain is chance
constexpr double kFloor = 1e-14;      ///< least gap and slip, over V: what rounding leaves of them
constexpr double kCloseRows = 1e-10;  ///< residual of momentum, gap and slip at the end

// of follow()
constexpr int kMostPathSystems = 600;
constexpr int kCentring = 60;         ///< systems to the path, at first
constexpr int kCorrections = 6;       ///< Newton steps back to the path
constexpr double kFirstLength = 0.5;  ///< of a step: changes relative to what changes, and of log(tau)
constexpr double kShortestLength = 1e-6;
constexpr double kLongestLength = 8;
constexpr double kPredictor = 0.7;  ///< part of the way to the boundary, along the tangent
constexpr double kCorrector = 0.9;  ///< and of a correction
constexpr double kHalf = 0.5;       ///< least part of a correction
constexpr double kShorter = 0.4;    ///< factors of the length, after a step that failed
constexpr double kSlower = 0.7;     ///< and after one with kManyCorrections
constexpr double kLonger = 2.0;     ///< and after one with kFewCorrections
constexpr int kFewCorrections = 2;
constexpr int kManyCorrections = 4;
constexpr double kClose = 0.05;       ///< largest relative change of the last correction
constexpr double kContraction = 0.5;  ///< of corrections
constexpr double kFarthest = 2.0;     ///< of log(tau), in a correction

constexpr int kRefinements = 2;  ///< of each direction: matrices range over 14 orders of magnitude

}  // namespace

template <int Dim>
bool InteriorPath<Dim>::applies_to(const StepProblem<Dim>& problem) {
  const auto is_simple = [](const Side<Dim>& side) { return side.kind != SideKind::intersection; };
  return problem.joints().empty() && !problem.contacts().empty() &&
         std::all_of(problem.contacts().begin(), problem.contacts().end(), [&](const ContactPair<Dim>& pair) {
           return is_simple(pair.side_1) && is_simple(pair.side_2);
         });
}

template <int Dim>
void InteriorPath<Dim>::begin(StepProblem<Dim>& problem, const Eigen::VectorXd& z, double tau) {
  problem_ = &problem;
  count_ = problem.contacts().size();
  if (contacts_.size() < count_) contacts_.resize(count_);
  path_.z = z.head(problem.size());
  path_.contacts.resize(count_);
  path_.log_tau = std::log(tau);
  problem.set_form(FrictionForm::no_slip);
  for (std::size_t i = 0; i < count_; ++i) {
    contacts_[i].bind(problem, i);
    path_.contacts[i] = contacts_[i].start(path_.z, tau);
  }
  problem.set_form(FrictionForm::projection);
  point_ = path_;
  write_impulses();
  path_.z = point_.z;
  centred_ = false;
  has_tangent_ = false;
  length_ = kFirstLength;
  factorisations_ = 0;
  path_systems_ = 0;
}

template <int Dim>
bool InteriorPath<Dim>::descend(double tau) {
  double best_mean = std::numeric_limits<double>::infinity();
  double best_residual = best_mean;
  int idle = 0;
  for (int k = 0; k < kMostSystems && idle < kPatience; ++k) {
    if (!evaluate()) return false;
    const double mean = mean_product();
    const double residual = std::max({rows_.cwiseAbs().maxCoeff(), slack(), kNoise});
    if (!std::isfinite(mean + residual)) return false;
    if (mean <= tau && residual <= kCloseRows) return true;
    idle = mean <= kGain * best_mean || residual <= kGain * best_residual ? 0 : idle + 1;
    best_mean = std::min(best_mean, mean);
    best_residual = std::min(best_residual, residual);
    if (!linearise()) return false;
    find_direction({}, step_);
    const double to_boundary = std::min(1.0, longest(step_));
    const double centring = std::pow(1 - to_boundary, 3);
    find_direction({.tau = centring * mean, .floor = kFloor, .second_order = true}, step_);
    move(std::min(1.0, kToBoundary * longest(step_)), step_, true);
  }
  return false;
}

template <int Dim>
bool InteriorPath<Dim>::follow(double tau) {
  point_ = path_;
  const int before = factorisations_;
  most_systems_ = before + kMostPathSystems - path_systems_;
  bool leads_on = centred_ || centre();
  if (leads_on && !centred_) path_ = point_;
  centred_ = leads_on;
  while (leads_on && point_.log_tau > std::log(tau)) {
    leads_on = advance();
    if (leads_on) path_ = point_;
  }
  path_systems_ += factorisations_ - before;
  return leads_on;
}

template <int Dim>
void InteriorPath<Dim>::write_impulses() {
  for (std::size_t i = 0; i < count_; ++i) {
    const ContactLayout& at = problem_->layout().contact(i);
    point_.z.template segment<Dimension<Dim>::friction>(at.friction) = point_.contacts[i].y;
    point_.z[at.normal] = point_.contacts[i].p;
  }
}

/// Rows and derivatives at the point.
template <int Dim>
bool InteriorPath<Dim>::evaluate() {
  rows_.resize(kVelocity * problem_->moving_bodies());
  for (int b = 0; b < problem_->moving_bodies(); ++b)
    rows_.template segment<kVelocity>(kVelocity * b) = problem_->momentum_row(b, point_.z);
  problem_->set_form(FrictionForm::no_slip);
  bool regular = true;
  for (std::size_t i = 0; i < count_ && regular; ++i) {
    Contact& contact = contacts_[i];
    regular = contact.evaluate(point_.contacts[i], point_.z);
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const int place = contact.place()[k];
      if (regular && place >= 0) rows_.template segment<kVelocity>(kVelocity * place) += contact.wrench(k);
    }
  }
  problem_->set_form(FrictionForm::projection);
  return regular;
}

/// Factors of the system in the velocities, where evaluate() was last.
template <int Dim>
bool InteriorPath<Dim>::linearise() {
  ++factorisations_;
  system_.start(rows_.size());
  add_momentum_matrices(*problem_, system_);
  for (std::size_t i = 0; i < count_; ++i)
    system_.add(contacts_[i].columns(), contacts_[i].places(), contacts_[i].matrix());
  return system_.factor();
}

/// The direction at the point, refined in what its own impulses leave of the momentum rows.
template <int Dim>
void InteriorPath<Dim>::find_direction(const Goal& goal, Step& step) {
  const auto add_at = [this](const Contact& contact, const typename Contact::OfVelocities& own) {
    for (std::size_t r = 0; r < contact.places().size(); ++r)
      right_side_[contact.places()[r]] -= own[static_cast<Eigen::Index>(r)];
  };
  const auto start_rows = [&] {
    if (goal.tangent) {
      right_side_.setZero(rows_.size());
    } else {
      right_side_ = -rows_;
    }
  };
  start_rows();
  for (std::size_t i = 0; i < count_; ++i)
    add_at(contacts_[i], contacts_[i].begin_direction(point_.contacts[i], goal));
  step.velocity.setZero(rows_.size());
  for (int k = 0; k <= kRefinements; ++k) {
    system_.solve(right_side_);
    step.velocity += right_side_;
    for (std::size_t i = 0; i < count_; ++i) contacts_[i].respond(right_side_);
    if (k == kRefinements) break;
    start_rows();
    for (int b = 0; b < problem_->moving_bodies(); ++b) {
      const Eigen::Index at = Eigen::Index{kVelocity} * b;
      right_side_.template segment<kVelocity>(at) -=
          problem_->momentum_matrix(b) * step.velocity.template segment<kVelocity>(at);
    }
    for (std::size_t i = 0; i < count_; ++i)
      add_at(contacts_[i], contacts_[i].momentum_change(step.velocity));
  }
  step.contacts.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) step.contacts[i] = contacts_[i].end_direction(step.velocity);
  step.log_tau = goal.tangent ? 1.0 : 0.0;
}

template <int Dim>
double InteriorPath<Dim>::mean_product() const {
  double sum = 0;
  for (std::size_t i = 0; i < count_; ++i) sum += contacts_[i].complementarity(point_.contacts[i], kFloor);
  return sum / static_cast<double>(count_);
}

template <int Dim>
double InteriorPath<Dim>::slack() const {
  double largest = 0;
  for (std::size_t i = 0; i < count_; ++i) largest = std::max(largest, contacts_[i].slack());
  return largest;
}

template <int Dim>
double InteriorPath<Dim>::longest(const Step& step) const {
  double longest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i)
    longest = std::min(longest, contacts_[i].longest_step(point_.contacts[i], step.contacts[i]));
  return longest;
}

/// @param residual  whether the step was one that takes away what rows are off
template <int Dim>
void InteriorPath<Dim>::move(double factor, const Step& step, bool residual) {
  point_.z.head(rows_.size()) += factor * step.velocity;
  point_.log_tau += factor * step.log_tau;
  for (std::size_t i = 0; i < count_; ++i) {
    point_.contacts[i].add(factor, step.contacts[i]);
    contacts_[i].move_points(step.velocity, factor, residual, point_.z);
  }
  write_impulses();
}

/// Newton's method to the path at the tau of the start.
template <int Dim>
bool InteriorPath<Dim>::centre() {
  for (int k = 0; k < kCentring; ++k) {
    if (!evaluate() || !linearise()) return false;
    find_direction({.tau = std::exp(point_.log_tau), .floor = kFloor}, step_);
    const double part = std::min(1.0, kCorrector * longest(step_));
    const bool close = part == 1.0 && largest(step_) < kClose;
    move(part, step_, true);
    if (close) return true;
  }
  return false;
}

/// One step along the path, as long as it can be. False if there is none.
template <int Dim>
bool InteriorPath<Dim>::advance() {
  if (!find_tangent()) return false;
  kept_ = point_;
  while (length_ >= kShortestLength && factorisations_ < most_systems_) {
    const double length = std::min(length_, kPredictor * longest(tangent_));
    move(length, tangent_, false);
    if (correct()) {
      if (corrections_ <= kFewCorrections)
        length_ = std::min(kLonger * std::max(length, length_), kLongestLength);
      if (corrections_ >= kManyCorrections) length_ = kSlower * length;
      return true;
    }
    length_ = kShorter * length;
    point_ = kept_;
    if (!evaluate()) return false;  // closest points move from there
  }
  return false;
}

/// The direction in which the path goes on: downwards at first, and up where the determinant has changed its
/// sign; where that is not known the one that keeps on in the last direction.
template <int Dim>
bool InteriorPath<Dim>::find_tangent() {
  if (!evaluate() || !linearise()) return false;
  find_direction({.tau = std::exp(point_.log_tau), .floor = kFloor, .tangent = true}, step_);
  const double size = std::sqrt(scalar_product(step_, step_));
  if (!std::isfinite(size)) return false;
  const double sign = system_.determinant_sign();
  double forward = -1;
  if (!has_tangent_) {
    first_sign_ = sign;
  } else {
    forward = sign != 0 ? -sign * first_sign_ : scalar_product(step_, tangent_);
  }
  tangent_ = step_;
  add((forward < 0 ? -1 : 1) / size - 1, step_, tangent_);
  has_tangent_ = true;
  return true;
}

/// Newton's method back to the path, across the tangent. False if it does not contract.
template <int Dim>
bool InteriorPath<Dim>::correct() {
  double before = std::numeric_limits<double>::infinity();
  for (corrections_ = 1; corrections_ <= kCorrections; ++corrections_) {
    if (!evaluate() || !linearise()) return false;
    const double tau = std::exp(point_.log_tau);
    find_direction({.tau = tau, .floor = kFloor}, step_);
    find_direction({.tau = tau, .floor = kFloor, .tangent = true}, along_);
    add(-scalar_product(tangent_, step_) / scalar_product(tangent_, along_), along_, step_);
    const double size = largest(step_);
    const double part = std::min(1.0, kCorrector * longest(step_));
    if (!(size <= kContraction * before && part >= kHalf && std::abs(step_.log_tau) <= kFarthest))
      return false;
    before = size;
    move(part, step_, true);
    if (part == 1.0 && size < kClose) return true;
  }
  return false;
}

/// Of changes relative to what changes, a contact's on average, and of those of log(tau).
template <int Dim>
double InteriorPath<Dim>::scalar_product(const Step& a, const Step& b) const {
  double sum = 0;
  for (std::size_t i = 0; i < count_; ++i)
    sum += contacts_[i].scalar_product(point_.contacts[i], a.contacts[i], b.contacts[i]);
  return sum / static_cast<double>(count_) + a.log_tau * b.log_tau;
}

template <int Dim>
double InteriorPath<Dim>::largest(const Step& step) const {
  double largest = std::abs(step.log_tau);
  for (std::size_t i = 0; i < count_; ++i)
    largest = std::max(largest, contacts_[i].largest(point_.contacts[i], step.contacts[i]));
  return largest;
}

template <int Dim>
void InteriorPath<Dim>::add(double factor, const Step& other, Step& step) {
  step.velocity += factor * other.velocity;
  for (std::size_t i = 0; i < step.contacts.size(); ++i) step.contacts[i].add(factor, other.contacts[i]);
  step.log_tau += factor * other.log_tau;
}

template class InteriorPath<2>;
template class InteriorPath<3>;

}  // namespace touchstone
