#include "core/stepper/implicit_stepper.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/contact/closest_points.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

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
      problem_(scene_),
      path_(path_options(options)),
      semismooth_(semismooth_options(options)) {
  problem_.set_gap(options.gap);
  const std::size_t known = candidates_.pairs().size();
  memory_.reserve(known);
  active_.reserve(known);
  active_contacts_.reserve(known);
  contacts_.reserve(known);
  joints_.resize(scene_.joints.size());
  joint_memory_.setZero(problem_.joint_row_count());
}

template <int Dim>
StepReport ImplicitStepper<Dim>::step(double h) {
  candidates_.select(state_, h);
  SolveReport report;
  do {
    collect_candidates();
    problem_.prepare(state_, h, active_contacts_);
    report = solve_step();
    if (!report.solved()) {
      return {StepStatus::not_converged, report.iterations, report.residual, to_string(report.status)};
    }
    problem_.advance(z_, end_);
  } while (candidates_.add_overlapping(end_));
  accept();
  return {StepStatus::solved, report.iterations, report.residual, {}};
}

template <int Dim>
void ImplicitStepper<Dim>::collect_candidates() {
  const auto pairs = candidates_.pairs();
  for (std::size_t i = memory_.size(); i < pairs.size(); ++i) {
    const ContactPair<Dim>& contact = pairs[i].contact;
    memory_.emplace_back().multipliers.resize(
        static_cast<std::size_t>(contact.side_1.multipliers() + contact.side_2.multipliers()));
  }
  for (const std::size_t i : active_) {
    if (!pairs[i].selected) memory_[i].valid = false;
  }
  active_.clear();
  active_contacts_.clear();
  for (const int i : candidates_.selected()) {
    active_.push_back(static_cast<std::size_t>(i));
    active_contacts_.push_back(pairs[active_.back()].contact);
  }
}

/// Warm start first; then from cold, where closest points are those of the predicted pose; then the other
/// solver.
template <int Dim>
SolveReport ImplicitStepper<Dim>::solve_step() {
  using Solver = ImplicitOptions::Solver;
  const Solver other = options_.solver == Solver::path ? Solver::semismooth : Solver::path;
  start_from_memory();
  SolveReport report = run_solver(options_.solver);
  int iterations = report.iterations;
  for (const Solver solver : {options_.solver, other}) {
    if (report.solved()) break;
    start_cold();
    report = run_solver(solver);
    iterations += report.iterations;
  }
  report.iterations = iterations;
  return report;
}

template <int Dim>
SolveReport ImplicitStepper<Dim>::run_solver(ImplicitOptions::Solver solver) {
  return solver == ImplicitOptions::Solver::path ? path_.solve(problem_, z_)
                                                 : semismooth_.solve(problem_, z_);
}

/// Contacts that were there in the last step start where it left them, with the velocities that it left;
/// where one is new the velocities are those of a free step and the new contact's points the closest ones of
/// the pose that these lead to.
template <int Dim>
void ImplicitStepper<Dim>::start_from_memory() {
  z_.setZero(problem_.size());
  z_.segment(problem_.layout().joints(), joint_memory_.size()) = joint_memory_;
  const bool all_known =
      std::all_of(active_.begin(), active_.end(), [this](std::size_t pair) { return memory_[pair].valid; });
  const bool constrained = !active_.empty() || !joints_.empty();
  if (all_known && constrained) {
    problem_.start_velocity(z_);
  } else {
    problem_.free_velocity(z_);
  }
  problem_.advance(z_, end_);
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (memory_[active_[i]].valid) {
      recall(i);
    } else {
      find_points(i);
    }
  }
}

template <int Dim>
void ImplicitStepper<Dim>::start_cold() {
  z_.setZero(problem_.size());
  problem_.free_velocity(z_);
  problem_.advance(z_, end_);
  for (std::size_t i = 0; i < active_contacts_.size(); ++i) find_points(i);
}

template <int Dim>
void ImplicitStepper<Dim>::recall(std::size_t i) {
  const Memory& memory = memory_[active_[i]];
  const ContactLayout& at = problem_.layout().contact(i);
  const Vector<Dim> center = problem_.body_1_position(i, z_);
  problem_.set_normal_estimate(i, memory.normal);
  problem_.set_points(i, center + memory.a_1, center + memory.a_2, z_);
  z_.template segment<Dimension<Dim>::friction>(at.friction) = memory.y;
  z_[at.normal] = memory.p;
  z_[at.slip] = memory.s;
  std::copy(memory.multipliers.begin(), memory.multipliers.end(), z_.data() + at.multipliers_1);
}

template <int Dim>
void ImplicitStepper<Dim>::find_points(std::size_t i) {
  const ContactPair<Dim>& contact = active_contacts_[i];
  const auto closest =
      closest_points(*contact.side_1.surface, end_[static_cast<std::size_t>(contact.body_1)].pose,
                     *contact.side_2.surface, end_[static_cast<std::size_t>(contact.body_2)].pose);
  const Vector<Dim>& origin = problem_.prepared(i).origin;
  const Vector<Dim> a_1 = closest.a_1 - origin;
  const Vector<Dim> a_2 = closest.a_2 - origin;
  problem_.set_normal_estimate(i, closest.normal);
  problem_.set_points(i, a_1, a_2, z_);
  problem_.set_multipliers(i, a_1, a_2, closest.normal, z_);
}

template <int Dim>
void ImplicitStepper<Dim>::accept() {
  contacts_.clear();
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const ContactLayout& at = problem_.layout().contact(i);
    contacts_.push_back(problem_.impulse(i, z_));
    Memory& memory = memory_[active_[i]];
    const Vector<Dim> center = problem_.body_1_position(i, z_);
    memory.valid = true;
    memory.normal = contacts_.back().normal;
    memory.a_1 = problem_.point(i, 0) - center;
    memory.a_2 = problem_.point(i, 1) - center;
    memory.y = z_.template segment<Dimension<Dim>::friction>(at.friction);
    memory.p = z_[at.normal];
    memory.s = z_[at.slip];
    std::copy_n(z_.data() + at.multipliers_1, memory.multipliers.size(), memory.multipliers.begin());
  }
  joint_memory_ = z_.segment(problem_.layout().joints(), joint_memory_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i] = problem_.joint_impulse(i, z_);
  std::swap(state_, end_);
}

template <int Dim>
Options ImplicitStepper<Dim>::effective_options() const {
  return {{"solver", options_.solver == ImplicitOptions::Solver::path ? "path" : "semismooth"},
          {"gap", options_.gap == GapFunction::workspace ? "workspace" : "distance"},
          {"tolerance", fmt::format("{}", options_.tolerance)},
          {"max_iterations", fmt::format("{}", options_.max_iterations)}};
}

template class ImplicitStepper<2>;
template class ImplicitStepper<3>;

}  // namespace touchstone
