#include "core/stepper/condensed_newton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/contact/patch_middle.h"

namespace touchstone {

namespace {

constexpr std::size_t kMany = 60;    ///< contacts above which sweeps come first
constexpr int kRounds = 100;         ///< of sweeps on frozen geometry
constexpr int kFewestSweeps = 100;   ///< at most in a round, at first ...
constexpr int kMostSweeps = 1600;    ///< ... and where rounds do not gain
constexpr int kSlowRounds = 10;      ///< without a gain, in a row, after which sweeps are given up: near rest
                                     ///< impulses that are not unique keep them from an end
constexpr double kRoundGain = 0.5;   ///< factor of the residual that counts as a gain of a round
constexpr double kSweepGain = 0.05;  ///< of the residual: largest change of an impulse that ends a round
constexpr double kNear = 1e-3;       ///< residual from which Newton's method goes on
constexpr int kFullSteps = 15;       ///< tried before anything else
constexpr int kFinishSteps = 30;     ///< from near a solution
constexpr int kSettlingSteps = 20;   ///< for the least of what rounding leaves
constexpr int kRescueSteps = 60;     ///< of each rescue
constexpr int kUndamped = 8;         ///< of those, before every other one is shortened
constexpr double kDamping = 0.3;     ///< to this part
constexpr double kAstray = 1e3;      ///< residual at which a search without a line search is given up
constexpr double kRestore = 1e-3;    ///< residual of closest points above which they are found anew
constexpr double kSpurious = 2.0;    ///< residual of points that satisfy their rows and are no closest points
constexpr std::size_t kMeritMemory = 5;  ///< of the nonmonotone line search
constexpr double kShortest = 1.0 / 128;  ///< its shortest step, relative to a Newton step
constexpr double kDecrease = 1e-4;       ///< Armijo's
constexpr double kTarget = 0.05;         ///< of the tolerance: where a search that still gains ends
constexpr double kWorthwhile = 0.1;      ///< factor of the residual that counts as a gain
constexpr int kIdle = 3;  ///< steps without a gain within what rounding explains that end a search
/// Below this residual the last factors are used once more: their step then gains as much as a new one would.
constexpr double kChordBelow = 1e-6;
constexpr double kChordGain = 0.03;  ///< factor of the residual that such a step must bring
/// Smallest pivot, relative to its column, with which closest points are eliminated.
constexpr double kRegular = 1e-8;
constexpr double kRegularisation = 1e-9;  ///< see newton_step()
constexpr double kHold = 0.1;             ///< see damp()
constexpr int kMonotoneAfter = 8;         ///< steps of a line search

/// Grows `vector` to n entries at least; what it held may be lost.
void make_room(Eigen::VectorXd& vector, Eigen::Index n) {
  if (vector.size() < n) vector.resize(n);
}

}  // namespace

template <int Dim>
SolveReport CondensedNewton<Dim>::solve(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  bind(problem);
  const Eigen::Index n = problem.size();
  start_.head(n) = z.head(n);
  int iterations = 0;
  const auto attempt = [&](auto&& way) {
    const SolveReport report = way();
    iterations += report.iterations;
    return report;
  };
  if (problem.contacts().size() > kMany && problem.joints().empty()) {
    iterations += approach(z);
    if (relaxation_.residual() <= options_.tolerance) {
      strategy_ = {};
      evaluate(z);
      if (residual_ <= options_.tolerance) { SolveReport r; r.iterations=iterations; return report_of(SolveStatus::solved, r); }
    }
  }
  SolveReport report =
      attempt([&] { return search({.limit = std::min(kFullSteps, options_.max_iterations)}, z); });
  for (const Rescue& way : kRescues) {
    if (is_acceptable(report) || problem.contacts().empty()) break;
    z.head(n) = start_.head(n);
    report = attempt([&] { return rescue(way, z); });
  }
  report.iterations = iterations;
  return report;
}

template <int Dim>
const std::array<typename CondensedNewton<Dim>::Rescue, 15> CondensedNewton<Dim>::kRescues = {{
    {.sweeps = 0, .search = Rescue::Search::smoothed},
    {.sweeps = 0, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::smoothed},
    {.sweeps = 50, .search = Rescue::Search::smoothed},
    {.sweeps = 0, .search = Rescue::Search::line_search},
    {.sweeps = 50, .search = Rescue::Search::full_steps},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 50, .from_cold = true, .search = Rescue::Search::full_steps},
    {.sweeps = 500, .search = Rescue::Search::smoothed},
    {.sweeps = 500, .search = Rescue::Search::line_search},
    {.sweeps = 500, .search = Rescue::Search::full_steps},
    {.sweeps = 500, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
    {.sweeps = 5, .from_cold = true, .search = Rescue::Search::smoothed},
    {.sweeps = 5, .search = Rescue::Search::full_steps},
    {.sweeps = 5000, .from_cold = true, .search = Rescue::Search::line_search, .damps = true},
}};

template <int Dim>
SolveReport CondensedNewton<Dim>::rescue(const Rescue& way, Eigen::VectorXd& z) {
  for (std::size_t i = 0; way.from_cold && i < problem_->contacts().size(); ++i)
    problem_->find_points(i, z, &patch_middle<Dim>);
  if (way.sweeps > 0) {
    evaluate(z);
    static_cast<void>(restore(z));
    sweeps_.run(*problem_, way.sweeps, z);
    evaluate(z);
    static_cast<void>(restore(z));
  }
  if (way.search == Rescue::Search::smoothed) return smoothed_search(z);
  const bool line_search = way.search == Rescue::Search::line_search;
  return search(
      {.line_search = line_search,
       .restores = !line_search,
       .follows = way.damps,
       .damps = way.damps,
       .limit = std::min(line_search ? options_.max_iterations : kRescueSteps, options_.max_iterations)},
      z);
}

template <int Dim>
SolveReport CondensedNewton<Dim>::finish(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  bind(problem);
  const Eigen::Index n = problem.size();
  start_.head(n) = z.head(n);
  SolveReport report = search({.limit = std::min(kFinishSteps, options_.max_iterations)}, z);
  if (report.solved() || report.residual <= options_.acceptable) return report;
  z.head(n) = start_.head(n);
  return search({.line_search = true, .limit = options_.max_iterations}, z);
}

template <int Dim>
SolveReport CondensedNewton<Dim>::settle(StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  bind(problem);
  strategy_ = {};
  for (std::size_t i = 0; i < problem.contacts().size(); ++i)
    problem.expect_load(i, z[problem.layout().contact(i).normal]);
  SolveReport report;
  report.status = SolveStatus::solved;
  const Eigen::Index n = problem.size();
  evaluate(z);
  const auto keep = [&] {
    report.residual = residual_;
    report.worst_row = worst_row_;
    start_.head(n) = z.head(n);
  };
  keep();
  while (report.residual > options_.acceptable && report.iterations < kSettlingSteps && newton_step(z)) {
    ++report.iterations;
    z.head(n) += step_.head(n);
    evaluate(z);
    if (residual_ < report.residual) keep();
  }
  z.head(n) = start_.head(n);
  evaluate(z);
  return report;
}

template <int Dim>
void CondensedNewton<Dim>::bind(StepProblem<Dim>& problem) {
  problem_ = &problem;
  make_room_for_problem();
  for (Eigen::VectorXd* v : {&step_, &start_, &trial_, &best_}) make_room(*v, problem.size());
  make_room(momentum_, problem.layout().joints());
  // A gap that a step could close, as a velocity: what p_n, an impulse over mass, is compared with.
  gap_weight_ = problem.scale().length / (problem.step_size() * problem.scale().velocity);
  evaluations_ = 0;
  factorisations_ = 0;
}

/// Many contacts: Gauss-Seidel on frozen geometry and the geometry anew, by turns, until the problem is
/// solved or rounds are used up. Takes a time and a memory in proportion to the contacts for each sweep,
/// where a sparse factorisation takes more than that, and finds which contacts act and slip, where Newton's
/// method goes astray.
/// @return  rounds
template <int Dim>
int CondensedNewton<Dim>::approach(Eigen::VectorXd& z) {
  const int rounds = relaxation_.run(*problem_, 0.5*options_.tolerance, z);
  const Eigen::Index n = problem_->size();
  if (relaxation_.residual() <= kNear) {
    start_.head(n) = z.head(n);
  } else {
    z.head(n) = start_.head(n);
  }
  return rounds;
}

/// Everything that any step of this problem may need, so that the first one that needs it allocates nothing.
template <int Dim>
void CondensedNewton<Dim>::make_room_for_problem() {
  const auto& contacts = problem_->contacts();
  if (elements_.size() < contacts.size()) elements_.resize(contacts.size());
  if (joints_.size() < problem_->joints().size()) joints_.resize(problem_->joints().size());
  recent_merits_.reserve(kMeritMemory);
  row_.reserve(2 * kVelocity);
  Eigen::Index reduced = problem_->layout().contacts_begin();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto& pair = contacts[i];
    const int points = pair.side_1.point_unknowns() + pair.side_2.point_unknowns() +
                       pair.side_1.multipliers() + pair.side_2.multipliers();
    const auto count = static_cast<std::size_t>(points);
    Element& element = elements_[i];
    element.eliminated.reserve(count);
    element.response.reserve(count * 2 * kVelocity);
    make_room(element.offset, points);
    static_cast<void>(element.lu.matrix(points));
    for (auto* list : {&element.kept, &element.place}) list->reserve(2 * kVelocity + kFriction + 1 + count);
    reduced += kFriction + 1;
  }
  make_room(solution_, reduced);
  reduced_.reserve(reduced);
}

template <int Dim>
SolveReport CondensedNewton<Dim>::search(const Strategy& strategy, Eigen::VectorXd& z) {
  strategy_ = strategy;
  SolveReport report;
  recent_merits_.clear();
  if (strategy.follows) follow_points(z);
  evaluate(z);
  report.history.push(residual_);
  const Eigen::Index n = problem_->size();
  bool factors_are_good = false;
  double before = std::numeric_limits<double>::infinity();
  double best = before;  // residual of best_, the nearest point to a solution within what rounding explains
  int idle = 0;
  const auto ended = [&](SolveStatus status) {
    if (status != SolveStatus::solved && best < residual_) {
      z.head(n) = best_.head(n);
      evaluate(z);
    }
    return report_of(status, report);
  };
  while (true) {
    if (!std::isfinite(merit_) || (!strategy.line_search && residual_ > kAstray))
      return ended(SolveStatus::non_finite);
    // Within the tolerance is solved; but a step that still gains much is cheaper than what its rest does to
    // the steps that follow.
    const bool gains = residual_ < kWorthwhile * before;
    if (residual_ <= (gains ? kTarget : 1.0) * options_.tolerance) return ended(SolveStatus::solved);
    if (report.iterations == strategy.limit) return ended(SolveStatus::iteration_limit);
    idle = best <= options_.acceptable && residual_ > kWorthwhile * best ? idle + 1 : 0;
    if (residual_ <= options_.acceptable && residual_ < best) {
      best = residual_;
      best_.head(n) = z.head(n);
    }
    if (idle > kIdle) return ended(SolveStatus::stalled);
    before = residual_;
    const bool chord = factors_are_good && residual_ < kChordBelow;
    if (chord) {
      chord_step(z);
    } else if (!newton_step(z)) {
      return ended(SolveStatus::singular_jacobian);
    }
    ++report.iterations;
    if (!advance(chord, report.iterations, z)) return ended(SolveStatus::stalled);
    report.history.push(residual_);
    factors_are_good = !chord || residual_ <= kChordGain * before;
  }
}

/// What a search says of z, where it was evaluated last.
template <int Dim>
SolveReport CondensedNewton<Dim>::report_of(SolveStatus status, const SolveReport& search) const {
  SolveReport report = search;
  report.status = status;
  report.residual = residual_;
  report.worst_row = worst_row_;
  report.evaluations = evaluations_;
  report.jacobian_evaluations = factorisations_;
  return report;
}

template <int Dim>
void CondensedNewton<Dim>::account(double value, Eigen::Index row) {
  const double size = std::abs(value);
  if (!(size <= residual_) && !std::isnan(residual_)) {  // NaN is larger than any number, and stays
    residual_ = size;
    worst_row_ = row;
  }
}

/// Rows, natural residual and merit at z; sigma is eliminated here.
template <int Dim>
void CondensedNewton<Dim>::evaluate(Eigen::VectorXd& z) {
  ++evaluations_;
  residual_ = 0.0;
  worst_row_ = -1;
  merit_ = 0.0;
  for (int b = 0; b < problem_->moving_bodies(); ++b)
    momentum_.template segment<kVelocity>(kVelocity * b) = problem_->momentum_row(b, z);
  const auto add_wrenches = [this](const StepBlock<Dim>& block) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      if (block.place[k] < 0) continue;
      momentum_.template segment<kVelocity>(kVelocity * block.place[k]) +=
          block.f.template segment<kVelocity>(block.column[k]);
    }
  };
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    StepBlock<Dim>& block = joints_[j].block;
    const int joint = problem_->joints()[j];
    problem_->joint_block(joint, z, false, block);
    add_wrenches(block);
    for (Eigen::Index r = block.own; r < block.size; ++r) {
      account(block.f[r], problem_->joint_column(joint) + r - block.own);
      merit_ += block.f[r] * block.f[r];
    }
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    problem_->evaluate_state(i, z);
    problem_->contact_block(i, false, elements_[i].block);
    add_wrenches(elements_[i].block);
    judge(elements_[i], i, z);
  }
  for (Eigen::Index r = 0; r < kVelocity * problem_->moving_bodies(); ++r) {
    account(momentum_[r], r);
    merit_ += momentum_[r] * momentum_[r];
  }
  merit_ *= 0.5;
}

/// A contact's part of the natural residual and of the merit.
template <int Dim>
void CondensedNewton<Dim>::judge(Element& element, std::size_t i, Eigen::VectorXd& z) {
  const ContactLayout& in_z = problem_->layout().contact(i);
  StepBlock<Dim>& block = element.block;
  z[in_z.slip] -= block.f[block.at.slip];  // sigma = |w|
  const auto take = [this](double value, Eigen::Index row) {
    account(value, row);
    merit_ += value * value;
  };
  element.geometry_residual = 0;
  const auto take_geometry = [&](double value, Eigen::Index row) {
    take(value, row);
    if (!(std::abs(value) <= element.geometry_residual)) element.geometry_residual = std::abs(value);
  };
  for (Eigen::Index r = block.own; r < block.at.friction; ++r)
    take_geometry(block.f[r], in_z.point_1 + r - block.own);
  for (Eigen::Index r = block.at.friction; r < block.at.normal; ++r)
    take(block.f[r], in_z.point_1 + r - block.own);
  if (problem_->is_spurious(i)) take_geometry(kSpurious, in_z.point_1);
  const double p = z[in_z.normal];
  const double gap = block.f[block.at.normal];
  account(std::min(p, gap), in_z.normal);
  const auto term = [this](double unknown, double row) {
    const double value = strategy_.line_search ? FischerBurmeisterTerm(unknown, row, smoothing_).value
                                               : std::min(unknown, row);
    return value * value;
  };
  merit_ += term(p, gap_weight_ * gap);
  for (Eigen::Index r = block.at.multipliers_1; r < block.size; ++r) {
    const Eigen::Index row = in_z.multipliers_1 + r - block.at.multipliers_1;
    const double least = std::min(z[row], block.f[r]);
    account(least, row);
    if (!(std::abs(least) <= element.geometry_residual)) element.geometry_residual = std::abs(least);
    merit_ += by_active_set() ? least * least : term(z[row], block.f[r]);
  }
}

/// Active set of the minimum function.
template <int Dim>
void CondensedNewton<Dim>::choose_rows(Element& element, std::size_t i, const Eigen::VectorXd& z) {
  const ContactLayout& in_z = problem_->layout().contact(i);
  const StepBlock<Dim>& block = element.block;
  const double p = z[in_z.normal];
  element.touching = p > gap_weight_ * block.f[block.at.normal];
  // Without load and open a contact acts on nothing: its impulse is 0 and stays 0.
  element.loaded = smoothing_ > 0 || element.touching || p != 0 ||
                   z.template segment<kFriction>(in_z.friction).squaredNorm() != 0;
  element.active.resize(static_cast<std::size_t>(block.size - block.at.multipliers_1));
  for (std::size_t l = 0; l < element.active.size(); ++l) {
    const auto offset = static_cast<Eigen::Index>(l);
    element.active[l] = z[in_z.multipliers_1 + offset] > block.f[block.at.multipliers_1 + offset];
  }
}

/// The block with the rows that stand: z_i = 0 in place of those that do not.
template <int Dim>
void CondensedNewton<Dim>::set_rows(Element& element, std::size_t i, const Eigen::VectorXd& z,
                                    bool derivatives) {
  const ContactLayout& in_z = problem_->layout().contact(i);
  StepBlock<Dim>& block = element.block;
  const auto replace = [&](Eigen::Index row, double value) {
    block.f[row] = value;
    if (!derivatives) return;
    block.j.row(row).head(block.size).setZero();
    block.j(row, row) = 1;
  };
  if (strategy_.line_search) {
    const auto combine = [&](Eigen::Index row, double unknown, double weight) {
      const FischerBurmeisterTerm term(unknown, weight * block.f[row], smoothing_);
      block.f[row] = term.value;
      if (!derivatives) return;
      block.j.row(row).head(block.size) *= weight * term.by_row;
      block.j(row, row) += term.by_unknown;
    };
    combine(block.at.normal, z[in_z.normal], gap_weight_);
    for (Eigen::Index r = block.at.multipliers_1; r < block.size && !by_active_set(); ++r)
      combine(r, z[in_z.multipliers_1 + r - block.at.multipliers_1], 1.0);
    if (!by_active_set()) return;
  } else if (!element.touching) {
    replace(block.at.normal, z[in_z.normal]);
  }
  for (std::size_t l = 0; l < element.active.size(); ++l) {
    const auto offset = static_cast<Eigen::Index>(l);
    if (!element.active[l]) replace(block.at.multipliers_1 + offset, z[in_z.multipliers_1 + offset]);
  }
}

/// Where contacts are more than the motion needs their impulses are not unique, and a step that nothing but
/// rounding ties down leads far from modes of contact that were right. This adds a multiple of the impulses'
/// change to their rows, as in Levenberg and Marquardt's method; it goes with the root of the residual, so
/// that what it allows of the change and what it costs in convergence both vanish at a solution.
template <int Dim>
void CondensedNewton<Dim>::damp(Element& element) const {
  if (!strategy_.damps) return;
  StepBlock<Dim>& block = element.block;
  const double hold = kHold * std::sqrt(std::min(residual_, 1.0));
  for (Eigen::Index r = block.at.friction; r <= block.at.normal; ++r) block.j(r, r) += hold;
}

template <int Dim>
void CondensedNewton<Dim>::list_velocities(Joint& part) const {
  part.kept.clear();
  part.place.clear();
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    if (part.block.place[k] < 0) continue;
    for (Eigen::Index c = 0; c < kVelocity; ++c) {
      part.kept.push_back(part.block.column[k] + c);
      part.place.push_back(kVelocity * part.block.place[k] + c);
    }
  }
}

template <int Dim>
void CondensedNewton<Dim>::list_unknowns(Element& element) {
  const StepBlock<Dim>& block = element.block;
  element.eliminated.clear();
  for (Eigen::Index c = block.own; c < block.at.friction; ++c) element.eliminated.push_back(c);
  for (Eigen::Index c = block.at.multipliers_1; c < block.size; ++c) element.eliminated.push_back(c);
  list_velocities(element);
  if (element.loaded) {
    for (Eigen::Index c = block.at.friction; c <= block.at.normal; ++c) keep(element, c);
  }
}

template <int Dim>
void CondensedNewton<Dim>::keep(Joint& part, Eigen::Index unknown) {
  part.kept.push_back(unknown);
  part.place.push_back(reduced_size_++);
}

template <int Dim>
void CondensedNewton<Dim>::fill_eliminated(Element& element) {
  const StepBlock<Dim>& block = element.block;
  const auto e = static_cast<Eigen::Index>(element.eliminated.size());
  auto matrix = element.lu.matrix(e);
  for (Eigen::Index c = 0; c < e; ++c) {
    for (Eigen::Index r = 0; r < e; ++r) {
      matrix(r, c) = block.j(element.eliminated[static_cast<std::size_t>(r)],
                             element.eliminated[static_cast<std::size_t>(c)]);
    }
  }
}

template <int Dim>
void CondensedNewton<Dim>::solve_points(Element& element, double* x) {
  if (element.regular) {
    element.lu.solve(x);
    return;
  }
  const auto e = static_cast<Eigen::Index>(element.eliminated.size());
  make_room(scratch_, e);
  std::copy_n(x, e, scratch_.data());
  element.lu.solve_least_norm(scratch_.data(), x);
}

/// Schur complement of the points (and multipliers): the block's kept rows and columns then hold what is
/// left, its `f` too.
template <int Dim>
void CondensedNewton<Dim>::eliminate(Element& element) {
  StepBlock<Dim>& block = element.block;
  const auto e = static_cast<Eigen::Index>(element.eliminated.size());
  fill_eliminated(element);
  element.regular = element.lu.factor(kRegular);
  element.keeps_points = !element.regular && element.loaded;
  if (element.keeps_points) {
    for (const Eigen::Index c : element.eliminated) keep(element, c);
    return;
  }
  // Of a face above a face any closest points will do while nothing acts there: the nearest to the last ones.
  if (!element.regular) {
    fill_eliminated(element);
    static_cast<void>(element.lu.factor_rank_revealing(kRegular));
  }
  // Impulses do not act on closest points: only the velocities' columns have a response.
  const Eigen::Index n = block.own;
  element.response.resize(static_cast<std::size_t>(e * n));
  double* const response = element.response.data();
  for (Eigen::Index c = 0; c < n; ++c) {
    for (Eigen::Index r = 0; r < e; ++r)
      response[r * n + c] = block.j(element.eliminated[static_cast<std::size_t>(r)], c);
  }
  if (element.regular && e < DenseLu::blocked_size) {
    element.lu.solve_rows(response, n);
  } else {
    make_room(column_, e);
    for (Eigen::Index c = 0; c < n; ++c) {
      for (Eigen::Index r = 0; r < e; ++r) column_[r] = response[r * n + c];
      solve_points(element, column_.data());
      for (Eigen::Index r = 0; r < e; ++r) response[r * n + c] = column_[r];
    }
  }
  row_.resize(static_cast<std::size_t>(n));
  double* __restrict const sum = row_.data();
  for (const Eigen::Index row : element.kept) {
    std::fill_n(sum, n, 0.0);
    for (Eigen::Index r = 0; r < e; ++r) {
      const double factor = block.j(row, element.eliminated[static_cast<std::size_t>(r)]);
      if (factor == 0) continue;
      const double* __restrict const source = response + r * n;
      for (Eigen::Index c = 0; c < n; ++c) sum[c] += factor * source[c];
    }
    for (Eigen::Index c = 0; c < n; ++c) block.j(row, c) -= sum[c];
  }
}

/// Rows that stand, closest points eliminated, and the places of what is left.
template <int Dim>
void CondensedNewton<Dim>::condense(const Eigen::VectorXd& z) {
  ++factorisations_;
  reduced_size_ = problem_->layout().joints();
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    Joint& joint = joints_[j];
    problem_->joint_block(problem_->joints()[j], z, true, joint.block);
    list_velocities(joint);
    for (Eigen::Index c = joint.block.own; c < joint.block.size; ++c) keep(joint, c);
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    Element& element = elements_[i];
    choose_rows(element, i, z);
    problem_->contact_block(i, true, element.block);
    set_rows(element, i, z, true);
    damp(element);
    list_unknowns(element);
    eliminate(element);
  }
}

/// @param regularisation  added to the diagonal of the impulses' rows
template <int Dim>
bool CondensedNewton<Dim>::factor(double regularisation) {
  reduced_.start(reduced_size_);
  std::array<Eigen::Index, kVelocity> unknown;
  std::array<Eigen::Index, kVelocity> place;
  std::iota(unknown.begin(), unknown.end(), Eigen::Index{0});
  for (int b = 0; b < problem_->moving_bodies(); ++b) {
    std::iota(place.begin(), place.end(), Eigen::Index{kVelocity} * b);
    body_matrix_ = problem_->momentum_matrix(b);
    reduced_.add(unknown, place, body_matrix_);
  }
  for (std::size_t j = 0; j < problem_->joints().size(); ++j)
    reduced_.add(joints_[j].kept, joints_[j].place, joints_[j].block.j);
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i)
    reduced_.add(elements_[i].kept, elements_[i].place, elements_[i].block.j);
  if (regularisation > 0) reduced_.add_to_diagonal(problem_->layout().joints(), regularisation);
  return reduced_.factor();
}

/// Where more contacts act than the motion needs (a body between several others, at rest) impulses are not
/// unique and the rows dependent. A small multiple of the impulses' change makes the system regular and
/// vanishes as the search converges.
template <int Dim>
bool CondensedNewton<Dim>::newton_step(const Eigen::VectorXd& z) {
  condense(z);
  if (!(reduced_.is_dense(reduced_size_) && factor(0.0)) && !factor(kRegularisation)) return false;
  solve_reduced();
  expand();
  return true;
}

/// A step with the factors of the last one and the rows at z.
template <int Dim>
void CondensedNewton<Dim>::chord_step(const Eigen::VectorXd& z) {
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) set_rows(elements_[i], i, z, false);
  solve_reduced();
  expand();
}

/// Right side and solution of the reduced system.
template <int Dim>
void CondensedNewton<Dim>::solve_reduced() {
  make_room(solution_, reduced_size_);
  solution_.head(reduced_size_).setZero();
  const Eigen::Index velocities = problem_->layout().joints();
  solution_.head(velocities) = -momentum_.head(velocities);
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    const StepBlock<Dim>& block = joints_[j].block;
    for (Eigen::Index r = block.own; r < block.size; ++r)
      solution_[joints_[j].place[static_cast<std::size_t>(r)]] = -block.f[r];
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    Element& element = elements_[i];
    const StepBlock<Dim>& block = element.block;
    for (std::size_t m = 0; m < element.kept.size(); ++m) {
      if (element.kept[m] >= block.own) solution_[element.place[m]] -= block.f[element.kept[m]];
    }
    if (element.keeps_points) continue;
    const std::size_t e = element.eliminated.size();
    make_room(element.offset, static_cast<Eigen::Index>(e));
    for (std::size_t r = 0; r < e; ++r)
      element.offset[static_cast<Eigen::Index>(r)] = block.f[element.eliminated[r]];
    solve_points(element, element.offset.data());
    for (std::size_t m = 0; m < element.kept.size(); ++m) {
      double sum = 0;
      for (std::size_t r = 0; r < e; ++r)
        sum += block.j(element.kept[m], element.eliminated[r]) * element.offset[static_cast<Eigen::Index>(r)];
      solution_[element.place[m]] += sum;
    }
  }
  reduced_.solve(solution_);
}

/// Step in z from the solution of the reduced system.
template <int Dim>
void CondensedNewton<Dim>::expand() {
  step_.head(problem_->size()).setZero();
  const Eigen::Index head = problem_->layout().joints();
  step_.head(head) = solution_.head(head);
  for (std::size_t j = 0; j < problem_->joints().size(); ++j) {
    const Joint& joint = joints_[j];
    const Eigen::Index column = problem_->joint_column(problem_->joints()[j]);
    for (Eigen::Index r = joint.block.own; r < joint.block.size; ++r)
      step_[column + r - joint.block.own] = solution_[joint.place[static_cast<std::size_t>(r)]];
  }
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    const Element& element = elements_[i];
    const StepBlock<Dim>& block = element.block;
    for (std::size_t m = 0; m < element.kept.size(); ++m) {
      if (element.kept[m] >= block.own) step_[column_in_z(i, element.kept[m])] = solution_[element.place[m]];
    }
    if (element.keeps_points) continue;
    for (std::size_t r = 0; r < element.eliminated.size(); ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      double change = -element.offset[row];
      const double* const response = element.response.data() + row * block.own;
      for (std::size_t c = 0; c < static_cast<std::size_t>(block.own); ++c)
        change -= response[c] * solution_[element.place[c]];
      step_[column_in_z(i, element.eliminated[r])] = change;
    }
  }
}

/// Column in z of an unknown of contact i's own.
template <int Dim>
Eigen::Index CondensedNewton<Dim>::column_in_z(std::size_t i, Eigen::Index unknown) const {
  const ContactLayout& in_z = problem_->layout().contact(i);
  const ContactLayout& at = elements_[i].block.at;
  if (unknown < at.normal) return in_z.point_1 + unknown - at.point_1;
  if (unknown == at.normal) return in_z.normal;
  return in_z.multipliers_1 + unknown - at.multipliers_1;
}

/// Takes the step, or the longest part of it that the line search allows. False if that allows none.
template <int Dim>
bool CondensedNewton<Dim>::advance(bool chord, int iteration, Eigen::VectorXd& z) {
  const Eigen::Index n = problem_->size();
  if (chord || !strategy_.line_search) {
    // A search that goes around in a circle is slowed down at every other step.
    const bool damped = strategy_.restores && iteration > kUndamped && iteration % 2 == 0;
    z.head(n) += (damped ? kDamping : 1.0) * step_.head(n);
    evaluate(z);
    if (strategy_.restores && restore(z)) evaluate(z);
    return true;
  }
  // A line search that may go up goes around in circles among active sets.
  if (iteration > kMonotoneAfter) recent_merits_.clear();
  if (recent_merits_.size() == kMeritMemory) recent_merits_.erase(recent_merits_.begin());
  recent_merits_.push_back(merit_);
  const double reference = *std::max_element(recent_merits_.begin(), recent_merits_.end());
  trial_.head(n) = z.head(n);
  for (double t = 1.0; t >= kShortest; t /= 2) {
    z.head(n) = trial_.head(n) + t * step_.head(n);
    if (strategy_.follows) follow_points(z);
    evaluate(z);
    if (merit_ <= (1 - 2 * kDecrease * t) * reference) return true;
  }
  return false;
}

/// Finds closest points anew where a step has left them far from their rows: an active set of faces and edges
/// that is guessed by complementarity from afar can lead anywhere, while the search from cold is certain.
template <int Dim>
bool CondensedNewton<Dim>::restore(Eigen::VectorXd& z) {
  bool any = false;
  for (std::size_t i = 0; i < problem_->contacts().size(); ++i) {
    if (elements_[i].geometry_residual <= kRestore) continue;
    problem_->find_points(i, z);
    any = true;
  }
  return any;
}

template class CondensedNewton<2>;
template class CondensedNewton<3>;

}  // namespace touchstone
