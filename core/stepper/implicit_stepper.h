#pragma once

#include <vector>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/stepper/central_path.h"
#include "core/stepper/condensed_newton.h"
#include "core/stepper/contact_candidates.h"
#include "core/stepper/islands.h"
#include "core/stepper/step_problem.h"
#include "core/stepper/warm_start.h"

namespace touchstone {

struct ImplicitOptions {
  enum class Solver {
    condensed,   ///< closest points eliminated (condensed_newton.h); the other two where that fails
    path,        ///< the full mixed problem by path-following Newton; the other one where that fails
    semismooth,  ///< likewise by semismooth Newton
  };

  Solver solver = Solver::condensed;
  /// f(a_2) of Eq. 6 does not see a body that is through a half-space by more than its own height, since a_2
  /// is then outside it again; the signed distance does, and is therefore the default.
  GapFunction gap = GapFunction::distance;
  /// A search ends where the natural residual of the step's problem is at most this; > 0, in StepProblem's
  /// units.
  double tolerance = 1e-13;
  /// Where rounding keeps a search from the tolerance (mass ratios of 1e4, say) a step is solved if the
  /// residual is at most this, or at most the tolerance if that is larger.
  static constexpr double kAcceptable = 2e-12;
  int max_iterations = 100;  ///< Newton steps of one attempt; >= 1
};

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
  [[nodiscard]] int fallbacks() const { return fallbacks_; }
  [[nodiscard]] Eigen::VectorXd solution() const { return z_.head(problem_.size()); }

 private:
  void collect_candidates();
  [[nodiscard]] SolveReport solve_islands(double h);
  void select_island(const Islands::Island& island);
  void start_from_memory();
  void start_cold(FindClosest<Dim> find);
  void recall(std::size_t i, int depth);
  [[nodiscard]] SolveReport solve_island();
  [[nodiscard]] SolveReport follow_central_path();
  [[nodiscard]] bool choose_frames();
  [[nodiscard]] SolveReport solve_again();
  static void accept_rounding(SolveReport& report);
  [[nodiscard]] SolveReport run_solver(ImplicitOptions::Solver solver);
  void keep_solution();
  void accept();

  const Scene<Dim> scene_;
  ImplicitOptions options_;
  std::vector<BodyState<Dim>> state_;
  std::vector<BodyState<Dim>> end_;  ///< of the step being solved
  ContactCandidates<Dim> candidates_;
  Islands islands_;
  StepProblem<Dim> problem_;
  CondensedNewton<Dim> condensed_;
  CentralPath<Dim> central_path_;
  bool jammed_ = false;  ///< central paths of the island that was given up ran off to infinity
  int fallbacks_ = 0;
  PathNewton path_;
  SemismoothNewton semismooth_;
  WarmStart<Dim> warm_start_;
  std::vector<ContactPair<Dim>> active_contacts_;  ///< of this step
  std::vector<std::size_t> island_;  ///< contacts of the current island, numbers in active_contacts_
  std::vector<ContactPair<Dim>> island_contacts_;
  Eigen::VectorXd z_;        ///< of the current island, in its first entries
  Eigen::VectorXd best_z_;   ///< of the searches from central paths
  Eigen::VectorXd exact_z_;  ///< of just its length, for the full problem's solvers
  std::vector<ContactImpulse<Dim>> contacts_, solved_contacts_;
  std::vector<JointImpulse<Dim>> joints_, solved_joints_;
  /// Scaled impulses of each joint, of the last step and of this one.
  std::vector<Eigen::VectorXd> joint_memory_, solved_joint_memory_;
};

}  // namespace touchstone
