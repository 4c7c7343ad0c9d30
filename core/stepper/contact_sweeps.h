#pragma once

#include <span>
#include <vector>

#include "core/stepper/step_problem.h"
#include "core/stepper/sweep_acceleration.h"

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

  // The same of some contacts among many, one call after the other; of problems without joints.

  /// Makes room for the problem's contacts and bodies.
  void bind(const StepProblem<Dim>& problem);
  /// Freezes the geometry of contact i at z, where the problem evaluated it last, and takes its impulses.
  void freeze(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z);
  /// Sets the velocities of `bodies` to what the impulses of all their contacts lead to.
  /// @param contacts  all of `bodies` that have impulses among them
  /// @param bodies  by number in the island
  void start(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
             std::span<const std::size_t> bodies);
  /// Sweeps over `contacts`, every other time backwards and accelerated after each pair, which many contacts
  /// that carry each other's load need; until a pair changes no impulse by more than `tolerance`, in the
  /// problem's units.
  /// @return  sweeps made, about `limit` at most
  int run_accelerated(std::span<const std::size_t> contacts, int limit, double tolerance,
                      SweepAcceleration::Kind kind);
  /// Largest change of an impulse of contact i in the last pair of sweeps over it.
  [[nodiscard]] double change(std::size_t i) const {
    return static_cast<double>(contact_courses_[i].change().cwiseAbs().maxCoeff());
  }
  /// Velocities of `bodies` and impulses of `contacts` into z.
  void write(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
             std::span<const std::size_t> bodies, Eigen::VectorXd& z) const;

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kTangent = Dimension<Dim>::tangent;
  static constexpr int kFriction = Dimension<Dim>::friction;
  static constexpr int kAngular = Dimension<Dim>::angular;
  using Impulse = Eigen::Matrix<double, kFriction + 1, 1>;  ///< (y, p)

  struct Body {
    Twist<Dim> nu = Twist<Dim>::Zero();
    double inverse_mass = 0.0;  ///< [1/kg]
    Eigen::Matrix<double, kAngular, kAngular> inverse_inertia =
        Eigen::Matrix<double, kAngular, kAngular>::Zero();  ///< [1/(kg m^2)]
    Twist<Dim> before = Twist<Dim>::Zero();                 ///< where the last pair of sweeps began
    bool moves = false;                                     ///< since the last start()
    bool listed = false;                                    ///< among swept_bodies_
  };
  struct Contact {
    std::array<int, 2> place{-1, -1};
    Vector<Dim> normal = Vector<Dim>::Zero();
    std::array<Vector<Dim>, 2> arm{};  ///< from the bodies' centres [m]
    double unit = 1.0;                 ///< of impulses, m V [N s]
    double gap_velocity = 0.0;         ///< psi / h less what nu' adds to it [m/s]
    double normal_step = 0.0;          ///< p per [m/s]
    double friction_step = 0.0;        ///< y per [m/s]
    FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
    double p = 0.0;
    double mu = 0.0;
    Impulse before = Impulse::Zero();  ///< where the last pair of sweeps began
    Eigen::Matrix<double, Dim, kTangent> tangents = Eigen::Matrix<double, Dim, kTangent>::Zero();
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
  void freeze_joints(const StepProblem<Dim>& problem, const Eigen::VectorXd& z);
  void sweep_all(bool forward);
  void sweep(Contact& contact);
  void sweep(JointRow& row);
  void list_bodies(std::span<const std::size_t> contacts);
  void take_step(std::size_t i);
  [[nodiscard]] Twist<Dim> relative_velocity(const Contact& contact) const;
  [[nodiscard]] FrictionVector<Dim> slip(const Contact& contact, const Twist<Dim>& velocity) const;
  void push(const Contact& contact, const Impulse& change, bool only_moving = false);
  void write(const StepProblem<Dim>& problem, Eigen::VectorXd& z) const;
  void write_velocity(const StepProblem<Dim>& problem, std::size_t body, Eigen::VectorXd& z) const;
  void write_impulse(const StepProblem<Dim>& problem, std::size_t i, Eigen::VectorXd& z) const;

  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
  std::vector<std::size_t> swept_bodies_;  ///< of the contacts that run_accelerated() sweeps over
  SweepAcceleration acceleration_;
  std::vector<SweepAcceleration::Leader<kFriction + 1>> contact_courses_;
  std::vector<SweepAcceleration::Follower<kVelocity>> body_courses_;
  std::vector<JointRow> joints_;
  StepBlock<Dim> block_;
};

}  // namespace touchstone
