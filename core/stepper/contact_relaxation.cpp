#include "core/stepper/contact_relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace touchstone {

namespace {

constexpr double kMostEffort = 400;    ///< rounds over all contacts that a problem may cost
constexpr double kIdleEffort = 10;     ///< of them without a gain, after which it is given up: near rest
                                       ///< impulses that are not unique keep rounds from an end
constexpr int kIdleRounds = 60;        ///< the same, wherever they work
constexpr int kFewestSweeps = 100;     ///< at most in a round, at first ...
constexpr int kMostSweeps = 1600;      ///< ... and where rounds do not gain
constexpr double kRoundGain = 0.5;     ///< factor of the residual that counts as a gain
constexpr double kSweepGain = 0.05;    ///< of the residual: largest change of an impulse that ends a round
constexpr int kFirstStage = 40;        ///< sweeps before they are narrowed to where impulses change
constexpr double kNearLargest = 0.01;  ///< of the largest residual: bodies from there on are chosen ...
constexpr int kHops = 2;               ///< ... with their neighbours up to so many contacts away
constexpr int kPatience = 2;           ///< rounds without a gain after which one that rises is shortened
constexpr double kShortest = 0.25;     ///< part of a round that is taken at least
constexpr int kFalls = 3;              ///< rounds in a row that fall after which they are lengthened again
/// Slack over the largest residual from which a contact without load is left alone for a round, since
/// velocities change by less; were it wrong, the contact's residual would tell in the end.
constexpr double kFar = 30;

/// The larger of two; NaN is larger than any number.
double larger(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

}  // namespace

template <int Dim>
int ContactRelaxation<Dim>::run(StepProblem<Dim>& problem, double tolerance, Eigen::VectorXd& z) {
  bind(problem, z);
  Pace pace;
  pace.reference = residual_;
  pace.sweeps = kFewestSweeps;
  int rounds = 0;
  while (residual_ > tolerance && pace.effort < kMostEffort && pace.idle_effort < kIdleEffort &&
         pace.idle < kIdleRounds) {
    const double before = residual_;
    choose(std::max(tolerance, kNearLargest * before));
    relax(problem, pace, z);
    ++rounds;
    const double part = static_cast<double>(touched_.size()) / static_cast<double>(contacts_.size());
    pace.effort += part;
    pace.falls = residual_ < before ? pace.falls + 1 : 0;
    if (pace.falls == 0 && pace.idle >= kPatience) pace.part = std::max(pace.part / 2, kShortest);
    if (residual_ <= kRoundGain * pace.reference) {
      pace.reference = residual_;
      pace.idle = 0;
      pace.idle_effort = 0;
      pace.sweeps = std::max(pace.sweeps / 2, kFewestSweeps);
      pace.part = std::min(2 * pace.part, 1.0);
    } else {
      ++pace.idle;
      pace.idle_effort += part;
      pace.sweeps = std::min(2 * pace.sweeps, kMostSweeps);
      if (pace.falls > kFalls) pace.part = std::min(2 * pace.part, 1.0);
    }
    if (residual_ <= tolerance) take_up(problem, z);
  }
  if (!(residual_ <= tolerance)) take_up(problem, z);
  for (std::size_t i = 0; i < contacts_.size(); ++i) problem.evaluate_state(i, z);
  return rounds;
}

/// Geometry of the contacts that were left, and residuals anew.
template <int Dim>
void ContactRelaxation<Dim>::take_up(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (!contacts_[i].left) continue;
    evaluate_anew(problem, i, z);
  }
  judge_all(problem, z);
}

/// Sweeps over the contacts that are chosen, and geometry and residuals anew.
template <int Dim>
void ContactRelaxation<Dim>::relax(StepProblem<Dim>& problem, const Pace& pace, Eigen::VectorXd& z) {
  const bool shortened = pace.part < 1;
  if (shortened) start_ = z;
  sweeps_.start(touched_, residual_);
  for (const std::size_t b : chosen_) sweeps_.restore_momentum(problem, b, momentum(problem, b, z));
  written_ = swept_;
  sweep(pace.sweeps, kSweepGain * std::min(residual_, 1.0));
  sweeps_.write(problem, written_, chosen_, z);
  if (shortened) z = start_ + pace.part * (z - start_);
  for (const std::size_t i : touched_) {
    evaluate_anew(problem, i, z);
  }
  for (const std::size_t b : judged_) judge(problem, b, z);
  find_residual();
}

/// Sweeps over what is chosen, and then, longer each time, over where impulses still change.
template <int Dim>
void ContactRelaxation<Dim>::sweep(int limit, double tolerance) {
  using Acceleration = SweepAcceleration::Kind;
  int made = 0;
  for (int stage = kFirstStage; made < limit && !swept_.empty(); stage *= 2) {
    // Where impulses still change after the first stage, contacts open and slide in turn.
    const Acceleration kind = made == 0 ? Acceleration::anderson : Acceleration::conjugate_gradients;
    made += sweeps_.run(swept_, std::min(stage, limit - made), tolerance, kind);
    narrow(tolerance);
  }
}

/// Leaves among the contacts to be swept those near an impulse that changed by more than `tolerance`.
template <int Dim>
void ContactRelaxation<Dim>::narrow(double tolerance) {
  for (Body& body : bodies_) body.swept = false;
  moving_.clear();
  for (const std::size_t i : swept_) {
    if (sweeps_.change(i) <= tolerance) continue;
    for (const int place : contacts_[i].place) {
      if (place < 0 || has(&Body::swept, place)) continue;
      bodies_[static_cast<std::size_t>(place)].swept = true;
      moving_.push_back(static_cast<std::size_t>(place));
    }
  }
  spread(&Body::swept, moving_);
  std::erase_if(swept_, [&](std::size_t i) { return !have(&Body::swept, contacts_[i]); });
}

/// Which contacts each body has, and all residuals.
template <int Dim>
void ContactRelaxation<Dim>::bind(const StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  sweeps_.bind(problem);
  bodies_.assign(static_cast<std::size_t>(problem.moving_bodies()), {});
  contacts_.resize(problem.contacts().size());
  first_.assign(bodies_.size() + 1, 0);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    clear(problem, i, z);
    problem.evaluate_state(i, z, state_);
    evaluate(problem, i, z);
    for (const int place : contacts_[i].place) {
      if (place >= 0) ++first_[static_cast<std::size_t>(place) + 1];
    }
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  neighbours_.resize(first_.back());
  std::vector<std::size_t>& next = chosen_;
  next.assign(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    for (const int place : contacts_[i].place) {
      if (place >= 0) neighbours_[next[static_cast<std::size_t>(place)]++] = i;
    }
  }
  judge_all(problem, z);
}

/// Closest points of contact i found anew at z, and its rows.
template <int Dim>
void ContactRelaxation<Dim>::evaluate_anew(StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) {
  clear(problem, i, z);
  problem.evaluate_anew(i, z, state_);
  evaluate(problem, i, z);
}

/// Without load there is no friction.
template <int Dim>
void ContactRelaxation<Dim>::clear(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) const {
  const ContactLayout& in_z = problem.layout().contact(i);
  if (z[in_z.normal] > 0) return;
  z[in_z.normal] = 0;
  z.template segment<Dimension<Dim>::friction>(in_z.friction).setZero();
}

/// Rows of contact i at z, where state_ is; sigma = |w| is eliminated here.
template <int Dim>
void ContactRelaxation<Dim>::evaluate(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) {
  Contact& contact = contacts_[i];
  const ContactLayout& in_z = problem.layout().contact(i);
  sweeps_.freeze(problem, i, state_, z);
  problem.contact_block(i, state_, false, block_);
  contact.place = problem.places(i);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (contact.place[k] >= 0)
      contact.wrench[k] = block_.f.template segment<Dimension<Dim>::velocity>(block_.column[k]);
  }
  z[in_z.slip] -= block_.f[block_.at.slip];
  const double p = z[in_z.normal];
  contact.loaded = p > 0;
  contact.slack = contact.loaded ? 0.0 : state_.distance() / (problem.step_size() * problem.scale().velocity);
  contact.left = false;
  contact.residual = problem.is_spurious(state_) ? StepProblem<Dim>::kSpuriousResidual : 0.0;
  const auto take = [&](double value) { contact.residual = larger(contact.residual, std::abs(value)); };
  for (Eigen::Index r = block_.own; r < block_.at.normal; ++r) take(block_.f[r]);
  take(std::min(p, block_.f[block_.at.normal]));
  for (Eigen::Index r = block_.at.multipliers_1; r < block_.size; ++r)
    take(std::min(z[in_z.multipliers_1 + r - block_.at.multipliers_1], block_.f[r]));
}

template <int Dim>
void ContactRelaxation<Dim>::judge_all(const StepProblem<Dim>& problem, const Eigen::VectorXd& z) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) judge(problem, b, z);
  find_residual();
}

template <int Dim>
void ContactRelaxation<Dim>::judge(const StepProblem<Dim>& problem, std::size_t b, const Eigen::VectorXd& z) {
  double worst = 0;
  for (const std::size_t i : contacts_of(b)) worst = larger(worst, contacts_[i].residual);
  for (const double row : momentum(problem, b, z)) worst = larger(worst, std::abs(row));
  bodies_[b].residual = worst;
}

/// Momentum row of a body with the wrenches of its contacts.
template <int Dim>
Twist<Dim> ContactRelaxation<Dim>::momentum(const StepProblem<Dim>& problem, std::size_t b,
                                            const Eigen::VectorXd& z) const {
  const int body = static_cast<int>(b);
  Twist<Dim> row = problem.momentum_row(body, z);
  for (const std::size_t i : contacts_of(b))
    row += contacts_[i].wrench[contacts_[i].place[0] == body ? 0 : 1];
  return row;
}

template <int Dim>
void ContactRelaxation<Dim>::find_residual() {
  residual_ = 0;
  for (const Body& body : bodies_) residual_ = larger(residual_, body.residual);
}

/// Bodies whose residual is above `threshold` with their neighbours, and their contacts.
template <int Dim>
void ContactRelaxation<Dim>::choose(double threshold) {
  chosen_.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].chosen = bodies_[b].residual > threshold;
    if (bodies_[b].chosen) chosen_.push_back(b);
  }
  spread(&Body::chosen, chosen_);
  std::sort(chosen_.begin(), chosen_.end());
  touched_.clear();
  swept_.clear();
  for (Body& body : bodies_) body.judged = body.chosen;
  judged_ = chosen_;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const Contact& contact = contacts_[i];
    if (!has(&Body::chosen, contact.place[0]) && !has(&Body::chosen, contact.place[1])) continue;
    if (contact.slack > kFar * residual_ && contact.residual <= threshold) {
      contacts_[i].left = true;
      continue;
    }
    touched_.push_back(i);
    if (have(&Body::chosen, contact)) swept_.push_back(i);
    for (const int place : contact.place) {
      if (place < 0 || has(&Body::judged, place)) continue;
      bodies_[static_cast<std::size_t>(place)].judged = true;
      judged_.push_back(static_cast<std::size_t>(place));
    }
  }
}

/// Marks the neighbours of `bodies`, which are marked, and lists them: those up to kHops loaded contacts
/// away.
template <int Dim>
void ContactRelaxation<Dim>::spread(bool Body::*mark, std::vector<std::size_t>& bodies) {
  std::size_t from = 0;
  for (int hop = 0; hop < kHops; ++hop) {
    const std::size_t to = bodies.size();
    for (; from < to; ++from) {
      for (const std::size_t i : contacts_of(bodies[from])) {
        if (!contacts_[i].loaded) continue;
        for (const int place : contacts_[i].place) {
          if (place < 0 || has(mark, place)) continue;
          bodies_[static_cast<std::size_t>(place)].*mark = true;
          bodies.push_back(static_cast<std::size_t>(place));
        }
      }
    }
  }
}

template class ContactRelaxation<2>;
template class ContactRelaxation<3>;

}  // namespace touchstone
