#include "core/stepper/implicit_stepper.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/model/errors.h"
#include "core/stepper/step_start.h"

namespace touchstone {

namespace {

constexpr std::array kSolverNames = {"condensed", "path", "semismooth"};

/// Why a step is not solved whose central paths run off to infinity.
constexpr std::string_view kJammed = "jammed: impulses grow without bound";

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
      island_solver_(options),
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
  candidates_.select(state_, h);
  SolveReport report;
  do {
    report = solve_selected(h);
    if (!report.solved()) {
      return {StepStatus::not_converged, report.iterations, report.residual,
              island_solver_.is_jammed() ? kJammed : to_string(report.status)};
    }
  } while (candidates_.add_overlapping(end_));
  accept();
  return {StepStatus::solved, report.iterations, report.residual, {}};
}

/// With all contacts that are selected; where elimination fails with those alone that are near, since a
/// contact that is far joins islands and lets no search end while its own closest points are in doubt; and at
/// last with all of them by everything there is.
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_selected(double h) {
  int iterations = 0;
  bool may_leave_out = true;
  const auto attempt = [&] {
    collect_candidates();
    SolveReport report = solve_islands(h, may_leave_out);
    iterations += report.iterations;
    report.iterations = iterations;
    return report;
  };
  SolveReport report = attempt();
  if (!report.solved() && !may_leave_out) report = attempt();
  if (!report.solved() && candidates_.take_back()) report = attempt();
  return report;
}

/// Every island on its own, into end_, solved_contacts_ and so on; stops at the first that is not solved.
/// @param may_leave_out  whether contacts that are far may be left out where elimination fails; false once
/// they were, and islands are to be solved anew
/// @return  iterations of all, and the worst residual
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_islands(double h, bool& may_leave_out) {
  islands_.split<Dim>(scene_, active_contacts_);
  problem_.begin(state_, h);
  const typename IslandSolver<Dim>::Start start = [this](Eigen::VectorXd& z) { start_from_memory(z); };
  // Two pointers, no more: what a std::function holds without an allocation.
  const typename IslandSolver<Dim>::GivesWay gives_way = [this, &may_leave_out] {
    const bool leaves_out = may_leave_out && candidates_.leave_out_far(state_, problem_.step_size());
    may_leave_out = may_leave_out && !leaves_out;
    return leaves_out;
  };
  SolveReport all;
  all.status = SolveStatus::solved;
  all.residual = 0;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    select_island(islands_[i]);
    const SolveReport report = island_solver_.solve(problem_, start, z_, gives_way);
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

template <int Dim>
void ImplicitStepper<Dim>::start_from_memory(Eigen::VectorXd& z) {
  z.head(problem_.size()).setZero();
  for (const int joint : problem_.joints()) {
    const Eigen::VectorXd& impulses = joint_memory_[static_cast<std::size_t>(joint)];
    z.segment(problem_.joint_column(joint), impulses.size()) = impulses;
  }
  // Extrapolation brings a start within the tolerance at once, where full Newton steps from the last solution
  // end far below it: the full problem, which is there to compare with, is to be as exact as it can.
  const int depth = options_.solver == ImplicitOptions::Solver::condensed ? WarmStart<Dim>::kDepth : 1;
  start_from(warm_start_, island_, depth, problem_, z);
}

/// What the current island's solution says of the end of the step.
template <int Dim>
void ImplicitStepper<Dim>::keep_solution() {
  problem_.advance(z_, end_);
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const ContactImpulse<Dim>& impulse = solved_contacts_[island_[i]] = problem_.impulse(i);
    keep_contact(problem_, i, z_, impulse.normal, warm_start_.next(island_[i]));
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
