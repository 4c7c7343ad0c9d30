#pragma once

#include <vector>

#include "core/stepper/step_problem.h"
#include "core/stepper/sweep_steps.h"

namespace touchstone {

/// Projected Gauss-Seidel on a step's problem with its geometry frozen: contact after contact gets the normal
/// impulse and the friction that its own rows ask for while the others stay, over and over. Converges slowly
/// and from anywhere, so it tells Newton's method which of many contacts act and which of them slip.
template <int Dim>
class ContactSweeps {
 public:
  /// Freezes points, frames and gaps where `z` has them, and sweeps over all contacts and joints.
  /// @param z  on return its velocities and impulses are those found; points and multipliers are left alone
  void run(const StepProblem<Dim>& problem, int sweeps, Eigen::VectorXd& z);

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kTangent = Dimension<Dim>::tangent;
  static constexpr int kFriction = Dimension<Dim>::friction;
  static constexpr int kAngular = Dimension<Dim>::angular;
  using Impulse = Eigen::Matrix<double, kFriction + 1, 1>;  ///< (y, p)

  struct Body {
    Twist<Dim> nu = Twist<Dim>::Zero();
    BodyResponse<Dim> response;
  };
  struct Contact {
    std::array<int, 2> place{-1, -1};
    ContactFrame<Dim> frame;
    std::array<Vector<Dim>, 2> arm{};  ///< from the bodies' centres [m]
    double unit = 1.0;                 ///< of impulses, m V [N s]
    double gap_velocity = 0.0;         ///< psi / h less what nu' adds to it [m/s]
    SweepSteps step;
    FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
    double p = 0.0;
    double mu = 0.0;
    FrictionVector<Dim> semi_axes = FrictionVector<Dim>::Zero();

    [[nodiscard]] Impulse impulse() const { return (Impulse() << y, p).finished(); }
  };
  struct JointRow {
    std::array<int, 2> place{-1, -1};
    std::array<Twist<Dim>, 2> gradient{};  ///< of phi by nu'
    std::array<Twist<Dim>, 2> response{};
    double constant = 0.0;  ///< phi less what nu' adds to it
    double step = 0.0;
    Eigen::Index column = 0;  ///< in z
    double impulse = 0.0;
  };

  void freeze_all(const StepProblem<Dim>& problem, const Eigen::VectorXd& z);
  void freeze(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z);
  void freeze_joints(const StepProblem<Dim>& problem, const Eigen::VectorXd& z);
  void sweep_all(bool forward);
  void sweep(Contact& contact);
  void sweep(JointRow& row);
  [[nodiscard]] Twist<Dim> relative_velocity(const Contact& contact) const;
  void push(const Contact& contact, const Impulse& change);
  void write(const StepProblem<Dim>& problem, Eigen::VectorXd& z) const;
  void write_velocity(const StepProblem<Dim>& problem, std::size_t body, Eigen::VectorXd& z) const;
  void write_impulse(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) const;

  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
  std::vector<JointRow> joints_;
  StepBlock<Dim> block_;
};

}  // namespace touchstone
