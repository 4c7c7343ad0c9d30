#include "core/stepper/implicit_stepper.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/contact/patch_middle.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

/// Unknowns of the largest problem that is handed to the full problem's solvers, whose matrices are dense.
constexpr Eigen::Index kLargestDense = 3000;

/// Unknowns of the largest problem whose central path is followed: a second or so a path.
constexpr Eigen::Index kLargestPath = 600;
/// Where central paths begin, in this order, and down to where they are followed: epsilon of SmoothedStep.
constexpr std::array kPathStarts = {0.1, 0.03, 0.01, 0.3, 1.0};
constexpr std::array kPathEnds = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};

constexpr std::array kSolverNames = {"condensed", "path", "semismooth"};

/// Residual of points that satisfy their rows and are no closest points: N_1 is n where it should be -n.
constexpr double kSpurious = 2.0;

/// Residual that is accepted of a step that nothing brings below kAcceptable: a tenth of what answers are
/// certified at.
constexpr double kLastAcceptable = 1e-11;

/// Unknowns of the largest problem that path-following Newton is left with after central paths: above, it may
/// pivot for minutes.
constexpr Eigen::Index kLargestPivoted = 100;

/// Why a step is not solved whose central paths run off to infinity.
constexpr std::string_view kJammed = "jammed: impulses grow without bound";

SearchOptions search_options(const ImplicitOptions& options) {
  SearchOptions search;
  search.tolerance = options.tolerance;
  search.max_iterations = options.max_iterations;
  return search;
}

PathNewtonOptions path_options(const ImplicitOptions& options) {
  PathNewtonOptions path;
  path.search = search_options(options);
  return path;
}

SemismoothNewtonOptions semismooth_options(const ImplicitOptions& options) {
  SemismoothNewtonOptions semismooth;
  semismooth.search = search_options(options);
  return semismooth;
}

template <int Dim>
const Scene<Dim>& checked(const Scene<Dim>& scene) {
  scene.validate();
  const auto refuse_bounce = [](const ContactLaw<Dim>& law) {
    if (law.restitution != 0) {
      throw Unsupported(
          fmt::format("restitution {}: the implicit NCP of Eqs. 10-11 is plastic", law.restitution));
    }
  };
  refuse_bounce(scene.contact_law);
  for (const auto& pair : scene.pair_laws) refuse_bounce(pair.law);
  return scene;
}

}  // namespace

template <int Dim>
ImplicitStepper<Dim>::ImplicitStepper(const Scene<Dim>& scene, const ImplicitOptions& options)
    : scene_(checked(scene)),
      options_(options),
      state_(initial_state(scene)),
      end_(state_),
      candidates_(scene_),
      islands_(scene_),
      problem_(scene_),
      condensed_({options.tolerance, options.max_iterations, ImplicitOptions::kAcceptable}),
      path_(path_options(options)),
      semismooth_(semismooth_options(options)),
      warm_start_(scene_) {
  problem_.set_gap(options.gap);
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
    const int rows = problem_.joint_row_count(static_cast<int>(i));
    joint_memory_.emplace_back(Eigen::VectorXd::Zero(rows));
    joints_.push_back({static_cast<int>(i)});
  }
  solved_joint_memory_ = joint_memory_;
  solved_joints_ = joints_;
}

template <int Dim>
StepReport ImplicitStepper<Dim>::step(double h) {
  jammed_ = false;
  candidates_.select(state_, h);
  SolveReport report;
  do {
    collect_candidates();
    report = solve_islands(h);
    if (!report.solved()) {
      return {StepStatus::not_converged, report.iterations, report.residual,
              jammed_ ? kJammed : to_string(report.status)};
    }
  } while (candidates_.add_overlapping(end_));
  accept();
  return {StepStatus::solved, report.iterations, report.residual, {}};
}

/// Every island on its own, into end_, solved_contacts_ and so on; stops at the first that is not solved.
/// @return  iterations of all, and the worst residual
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_islands(double h) {
  islands_.split<Dim>(scene_, active_contacts_);
  problem_.begin(state_, h);
  SolveReport all;
  all.status = SolveStatus::solved;
  all.residual = 0;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    select_island(islands_[i]);
    SolveReport report = solve_island();
    if (report.solved() && report.residual > options_.tolerance && !island_.empty()) {
      const int iterations = report.iterations;
      report = condensed_.settle(problem_, z_);
      report.iterations += iterations;
    }
    if (report.solved() && choose_frames()) report = solve_again();
    all.iterations += report.iterations;
    all.residual = std::max(all.residual, report.residual);
    if (!report.solved()) {
      all.status = report.status;
      break;
    }
    keep_solution();
  }
  return all;
}

template <int Dim>
void ImplicitStepper<Dim>::select_island(const Islands::Island& island) {
  island_.assign(island.contacts.begin(), island.contacts.end());
  island_contacts_.clear();
  for (const std::size_t i : island_) island_contacts_.push_back(active_contacts_[i]);
  problem_.select(island.bodies, island.joints, island_contacts_);
  if (z_.size() < problem_.size()) z_.resize(problem_.size());
}

template <int Dim>
void ImplicitStepper<Dim>::collect_candidates() {
  active_contacts_.clear();
  for (const int pair : candidates_.selected())
    active_contacts_.push_back(candidates_.pairs()[static_cast<std::size_t>(pair)].contact);
  warm_start_.match(active_contacts_);
  solved_contacts_.resize(active_contacts_.size());
  contacts_.reserve(active_contacts_.size());
}

/// The solver asked for, from the warm start; then the full problem's, from cold, where closest points are
/// those of the predicted pose; then from the middle of the patches in which bodies lie flat on each other,
/// because a box that is about to tip may be out of reach from a corner of its base.
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_island() {
  using Solver = ImplicitOptions::Solver;
  SolveReport report;
  int iterations = 0;
  bool pivots = true;
  if (options_.solver == Solver::condensed) {
    start_from_memory();
    report = condensed_.solve(problem_, z_);
    accept_rounding(report);
    if (report.solved() || problem_.size() > kLargestDense) return report;
    ++fallbacks_;
    iterations += report.iterations;
    if (!island_.empty() && problem_.size() <= kLargestPath) {
      const SolveReport path = follow_central_path();
      iterations += path.iterations;
      pivots = problem_.size() <= kLargestPivoted;
      if (path.solved() || jammed_) {
        report = path;
        report.iterations = iterations;
        return report;
      }
    }
  }
  const Solver first = options_.solver == Solver::path ? Solver::path : Solver::semismooth;
  const Solver other = first == Solver::path ? Solver::semismooth : Solver::path;
  const auto attempt = [&](Solver solver) {
    report = run_solver(solver);
    iterations += report.iterations;
  };
  for (const Solver solver : {first, other}) {
    start_from_memory();
    attempt(solver);
    for (const FindClosest<Dim> find : {&closest_points<Dim>, &patch_middle<Dim>}) {
      if (report.solved()) break;
      start_cold(find);
      attempt(solver);
    }
    if (report.solved() || !pivots) break;
  }
  report.iterations = iterations;
  return report;
}

/// Newton's method from points of central paths, ever farther down, and at last, from the end of each, the
/// full problem's.
template <int Dim>
SolveReport ImplicitStepper<Dim>::follow_central_path() {
  using State = typename CentralPath<Dim>::State;
  SolveReport best;
  best_z_ = z_.head(problem_.size());
  int iterations = 0;
  bool unbounded = false;
  bool arrived = false;
  const auto finish = [&](auto&& solver) {
    const SolveReport report = solver();
    iterations += report.iterations;
    if (report.residual < best.residual) {
      best = report;
      best_z_ = z_.head(problem_.size());
    }
    accept_rounding(best);
    return best.solved();
  };
  const auto walk = [&](double start) {
    central_path_.begin(problem_, start);
    State state = State::arrived;
    for (const double end : kPathEnds) {
      if (state != State::arrived) break;
      const int before = central_path_.factorisations();
      state = central_path_.follow_to(end);
      iterations += central_path_.factorisations() - before;
      for (const bool closed : {true, false}) {
        central_path_.estimate(z_, closed);
        if (finish([&] { return condensed_.finish(problem_, z_); })) return true;
      }
    }
    unbounded = unbounded || state == State::unbounded;
    arrived = arrived || state == State::arrived;
    if (state == State::unbounded) return false;
    central_path_.estimate(z_, false);
    return finish([&] { return run_solver(ImplicitOptions::Solver::semismooth); });
  };
  const bool solved = std::any_of(kPathStarts.begin(), kPathStarts.end(), walk);
  z_.head(problem_.size()) = best_z_;
  for (std::size_t i = 0; i < island_.size(); ++i) problem_.evaluate_state(i, z_);
  if (!solved && best.residual <= kLastAcceptable) best.status = SolveStatus::solved;
  jammed_ = !best.solved() && unbounded && !arrived;
  best.iterations = iterations;
  return best;
}

/// The direction that t is the projection of is chosen before a step is solved, for the normal expected then.
/// Where friction is not the same in all directions and the normal came out so that the law's own direction
/// serves, that one is to be it.
/// @return  whether one changed
template <int Dim>
bool ImplicitStepper<Dim>::choose_frames() {
  constexpr double kLeastSine = 0.2;  // well above that at which usable_reference() gives up the law's own
  bool changed = false;
  if constexpr (Dim == 3) {
    for (std::size_t i = 0; i < island_contacts_.size(); ++i) {
      const ContactLaw<Dim>& law = island_contacts_[i].law;
      const Vector<Dim> direction = law.tangent.normalized();
      if (law.e_t == law.e_o || problem_.prepared(i).reference == direction) continue;
      const Vector<Dim> normal = problem_.impulse(i).normal;
      if (normal.cross(direction).norm() < kLeastSine) continue;
      problem_.set_normal_estimate(i, normal);
      changed = true;
    }
  }
  return changed;
}

/// From the last solution, in other frames.
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_again() {
  constexpr int kTries = 5;  // of frames that may have to be chosen once more
  SolveReport report;
  int tries = 0;
  do {
    report = condensed_.finish(problem_, z_);
    accept_rounding(report);
  } while (report.solved() && ++tries < kTries && choose_frames());
  return report;
}

/// A search that ended, for whatever reason, so near to a solution that rounding is what is left.
template <int Dim>
void ImplicitStepper<Dim>::accept_rounding(SolveReport& report) {
  if (report.residual <= ImplicitOptions::kAcceptable) report.status = SolveStatus::solved;
}

template <int Dim>
SolveReport ImplicitStepper<Dim>::run_solver(ImplicitOptions::Solver solver) {
  exact_z_ = z_.head(problem_.size());
  SolveReport report = solver == ImplicitOptions::Solver::path ? path_.solve(problem_, exact_z_)
                                                               : semismooth_.solve(problem_, exact_z_);
  z_.head(problem_.size()) = exact_z_;
  accept_rounding(report);
  for (std::size_t i = 0; i < island_.size() && report.solved(); ++i) {
    problem_.evaluate_state(i, z_);
    if (!problem_.is_spurious(i)) continue;
    report.status = SolveStatus::local_minimum;
    report.residual = kSpurious;
  }
  return report;
}

/// Contacts that were there in the last step start where the last steps lead, and so do velocities; where one
/// is new the velocities are those of a free step and the new contact's points the closest ones of the pose
/// that these lead to.
template <int Dim>
void ImplicitStepper<Dim>::start_from_memory() {
  z_.head(problem_.size()).setZero();
  for (const int joint : problem_.joints()) {
    const Eigen::VectorXd& impulses = joint_memory_[static_cast<std::size_t>(joint)];
    z_.segment(problem_.joint_column(joint), impulses.size()) = impulses;
  }
  // Extrapolation brings a start within the tolerance at once, where full Newton steps from the last solution
  // end far below it: the full problem, which is there to compare with, is to be as exact as it can.
  const int allowed = options_.solver == ImplicitOptions::Solver::condensed ? WarmStart<Dim>::kDepth : 1;
  const int depth = std::min(allowed, warm_start_.depth(problem_.bodies(), island_));
  const bool constrained = !island_.empty() || !problem_.joints().empty();
  if (depth > 0 && constrained) {
    for (int place = 0; place < problem_.moving_bodies(); ++place) {
      z_.template segment<Dimension<Dim>::velocity>(problem_.layout().velocity(place)) =
          warm_start_.velocity(problem_.body(place), depth);
    }
  } else {
    problem_.free_velocity(z_);
  }
  for (std::size_t i = 0; i < island_.size(); ++i) {
    if (warm_start_.knows(island_[i])) {
      recall(i, depth);
    } else {
      problem_.find_points(i, z_);
    }
  }
}

template <int Dim>
void ImplicitStepper<Dim>::start_cold(FindClosest<Dim> find) {
  z_.head(problem_.size()).setZero();
  problem_.free_velocity(z_);
  for (std::size_t i = 0; i < island_contacts_.size(); ++i) problem_.find_points(i, z_, find);
}

template <int Dim>
void ImplicitStepper<Dim>::recall(std::size_t i, int depth) {
  const ContactSolution<Dim>& memory = warm_start_.contact(island_[i], depth);
  const ContactLayout& at = problem_.layout().contact(i);
  const Vector<Dim> center = problem_.body_1_position(i, z_);
  problem_.set_normal_estimate(i, memory.normal);
  problem_.set_points(i, center + memory.a_1, center + memory.a_2, z_);
  z_.template segment<Dimension<Dim>::friction>(at.friction) = memory.y;
  z_[at.normal] = memory.p;
  z_[at.slip] = memory.s;
  std::copy(memory.multipliers.begin(), memory.multipliers.end(), z_.data() + at.multipliers_1);
}

/// What the current island's solution says of the end of the step.
template <int Dim>
void ImplicitStepper<Dim>::keep_solution() {
  problem_.advance(z_, end_);
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const ContactLayout& at = problem_.layout().contact(i);
    solved_contacts_[island_[i]] = problem_.impulse(i);
    ContactSolution<Dim>& memory = warm_start_.next(island_[i]);
    const Vector<Dim> center = problem_.body_1_position(i, z_);
    memory.normal = solved_contacts_[island_[i]].normal;
    memory.a_1 = problem_.point(i, 0) - center;
    memory.a_2 = problem_.point(i, 1) - center;
    memory.y = z_.template segment<Dimension<Dim>::friction>(at.friction);
    memory.p = z_[at.normal];
    memory.s = z_[at.slip];
    const auto multipliers =
        island_contacts_[i].side_1.multipliers() + island_contacts_[i].side_2.multipliers();
    memory.multipliers.assign(z_.data() + at.multipliers_1, z_.data() + at.multipliers_1 + multipliers);
  }
  for (const int joint : problem_.joints()) {
    const auto index = static_cast<std::size_t>(joint);
    solved_joint_memory_[index] =
        z_.segment(problem_.joint_column(joint), solved_joint_memory_[index].size());
    solved_joints_[index] = problem_.joint_impulse(joint, z_);
  }
}

/// Makes what was solved the state; a step that is not solved never comes here and changes nothing.
template <int Dim>
void ImplicitStepper<Dim>::accept() {
  warm_start_.accept(active_contacts_, end_);
  std::swap(joint_memory_, solved_joint_memory_);
  std::swap(contacts_, solved_contacts_);
  std::swap(joints_, solved_joints_);
  std::swap(state_, end_);
}

template <int Dim>
Options ImplicitStepper<Dim>::effective_options() const {
  return {{"solver", kSolverNames[static_cast<std::size_t>(options_.solver)]},
          {"gap", options_.gap == GapFunction::workspace ? "workspace" : "distance"},
          {"tolerance", fmt::format("{}", options_.tolerance)},
          {"max_iterations", fmt::format("{}", options_.max_iterations)}};
}

template class ImplicitStepper<2>;
template class ImplicitStepper<3>;

}  // namespace touchstone
