#pragma once

#include <vector>

#include "core/complementarity/path_newton.h"
#include "core/complementarity/semismooth_newton.h"
#include "core/stepper/contact_candidates.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

struct ImplicitOptions {
  enum class Solver { path, semismooth };

  Solver solver = Solver::path;
  GapFunction gap = GapFunction::workspace;
  /// A step is solved if the natural residual of its problem is at most this; > 0, in StepProblem's units.
  double tolerance = 1e-13;
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

  /// The last step's problem and its solution, for certificates and tests.
  [[nodiscard]] const StepProblem<Dim>& problem() const { return problem_; }
  [[nodiscard]] const Eigen::VectorXd& solution() const { return z_; }

 private:
  /// What a pair's last step left for the next one to start from.
  struct Memory {
    bool valid = false;
    Vector<Dim> a_1 = Vector<Dim>::Zero();  ///< relative to body 1, world axes
    Vector<Dim> a_2 = Vector<Dim>::Zero();
    Vector<Dim> normal = Vector<Dim>::Zero();
    FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
    double p = 0.0;
    double s = 0.0;
    std::vector<double> multipliers;
  };

  void collect_candidates();
  void start_from_memory();
  void start_cold();
  void recall(std::size_t i);
  void find_points(std::size_t i);
  [[nodiscard]] SolveReport solve_step();
  [[nodiscard]] SolveReport run_solver(ImplicitOptions::Solver solver);
  void accept();

  const Scene<Dim> scene_;
  ImplicitOptions options_;
  std::vector<BodyState<Dim>> state_;
  std::vector<BodyState<Dim>> end_;  ///< of the step being solved
  ContactCandidates<Dim> candidates_;
  StepProblem<Dim> problem_;
  PathNewton path_;
  SemismoothNewton semismooth_;
  std::vector<Memory> memory_;       ///< one a pair of candidates_
  std::vector<std::size_t> active_;  ///< pairs of this step, in the order of active_contacts_
  std::vector<ContactPair<Dim>> active_contacts_;
  Eigen::VectorXd z_;
  std::vector<ContactImpulse<Dim>> contacts_;
  std::vector<JointImpulse<Dim>> joints_;
  Eigen::VectorXd joint_memory_;  ///< scaled joint impulses of the last step
};

}  // namespace touchstone
