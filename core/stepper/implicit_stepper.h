#pragma once

#include <vector>

#include "core/stepper/contact_candidates.h"
#include "core/stepper/implicit_options.h"
#include "core/stepper/island_solver.h"
#include "core/stepper/islands.h"
#include "core/stepper/step_problem.h"
#include "core/stepper/warm_start.h"

namespace touchstone {

/// The geometrically implicit time-stepper (Eqs. 4-6, 9-11): each step solves closest points, contact,
/// friction and dynamics together, at the end of the step, as one mixed complementarity problem.
template <int Dim>
class ImplicitStepper final : public Method<Dim> {
 public:
  /// @throws InputError if the scene makes no sense, Unsupported if it asks for what this method cannot do
  ImplicitStepper(const Scene<Dim>& scene, const ImplicitOptions& options);

  [[nodiscard]] Capabilities capabilities() const override {
    return {
        .contact_impulses = true, .torsional_friction = true, .anisotropic_friction = true, .joints = true};
  }
  [[nodiscard]] const Scene<Dim>& scene() const override { return scene_; }
  [[nodiscard]] std::span<const BodyState<Dim>> state() const override { return state_; }
  [[nodiscard]] std::span<const ContactImpulse<Dim>> contacts() const override { return contacts_; }
  [[nodiscard]] std::span<const JointImpulse<Dim>> joints() const override { return joints_; }
  [[nodiscard]] StepReport step(double h) override;
  [[nodiscard]] Options effective_options() const override;

  /// The problem of the last step's last island and its solution, for certificates and tests.
  [[nodiscard]] const StepProblem<Dim>& problem() const { return problem_; }
  /// What the last step's solution says of contacts()[i], multipliers of both sides included.
  [[nodiscard]] const ContactSolution<Dim>& contact_solution(std::size_t i) const {
    return warm_start_.last(i);
  }
  /// How many islands so far elimination left to the full problem's solvers.
  [[nodiscard]] int fallbacks() const { return island_solver_.fallbacks(); }
  [[nodiscard]] Eigen::VectorXd solution() const { return z_.head(problem_.size()); }

 private:
  void collect_candidates();
  [[nodiscard]] SolveReport solve_selected(double h);
  [[nodiscard]] SolveReport solve_islands(double h, bool& may_leave_out);
  void select_island(const Islands::Island& island);
  void start_from_memory(Eigen::VectorXd& z);
  void keep_solution();
  void accept();

  const Scene<Dim> scene_;
  ImplicitOptions options_;
  std::vector<BodyState<Dim>> state_;
  std::vector<BodyState<Dim>> end_;  ///< of the step being solved
  ContactCandidates<Dim> candidates_;
  Islands islands_;
  StepProblem<Dim> problem_;
  IslandSolver<Dim> island_solver_;
  WarmStart<Dim> warm_start_;
  std::vector<ContactPair<Dim>> active_contacts_;  ///< of this step
  std::vector<std::size_t> island_;  ///< contacts of the current island, numbers in active_contacts_
  std::vector<ContactPair<Dim>> island_contacts_;
  Eigen::VectorXd z_;  ///< of the current island, in its first entries
  std::vector<ContactImpulse<Dim>> contacts_, solved_contacts_;
  std::vector<JointImpulse<Dim>> joints_, solved_joints_;
  /// Scaled impulses of each joint, of the last step and of this one.
  std::vector<Eigen::VectorXd> joint_memory_, solved_joint_memory_;
};

}  // namespace touchstone
