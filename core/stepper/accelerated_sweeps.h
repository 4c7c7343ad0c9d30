#pragma once

#include <span>
#include <vector>

#include "core/stepper/lanes.h"
#include "core/stepper/step_problem.h"
#include "core/stepper/sweep_acceleration.h"
#include "core/stepper/sweep_steps.h"

namespace touchstone {

/// Projected Gauss-Seidel as in contact_sweeps.h for rounds over many contacts: looks for the change of
/// impulses and velocities from where a round begins. To find a digit or two of a change, single precision
/// serves, however small it is against what it is added to, which stays in z in double precision.
///
/// What sweeps read of a contact is 0.5 kB, acceleration included, since with thousands of them memory is
/// what they wait for. Planar contacts are swept over as spatial ones between bodies that turn about z alone.
template <int Dim>
class AcceleratedSweeps {
 public:
  /// Makes room for the problem's contacts and bodies.
  void bind(const StepProblem<Dim>& problem);
  /// Freezes the geometry of contact i at z; a round begins there.
  /// @param state  of the contact at z
  /// @param z  with p >= 0, and y = 0 where p is
  void freeze(const StepProblem<Dim>& problem, std::size_t i, const ContactState<Dim>& state,
              const Eigen::VectorXd& z);

  /// Begins a round: nothing has changed yet.
  /// @param contacts  whose impulses may change
  /// @param size  about that of the changes, in the problem's units
  void start(std::span<const std::size_t> contacts, double size);
  /// Begins with the change of a body's velocity that restores its momentum.
  /// @param row  its momentum row of the problem, with the wrenches of its contacts
  void restore_momentum(const StepProblem<Dim>& problem, std::size_t body, const Twist<Dim>& row);
  /// Sweeps over `contacts`, every other time backwards and accelerated after each pair, which many contacts
  /// that carry each other's load need; until a pair changes no impulse by more than `tolerance`, in the
  /// problem's units.
  /// @return  sweeps made, about `limit` at most
  int run(std::span<const std::size_t> contacts, int limit, double tolerance, SweepAcceleration::Kind kind);
  /// Largest change of an impulse of contact i in the last pair of sweeps over it.
  [[nodiscard]] double change(std::size_t i) const {
    return size_ * static_cast<double>(courses_[i].change().cwiseAbs().maxCoeff());
  }
  /// Adds what has changed of the velocities of `bodies` and the impulses of `contacts` to z.
  void write(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
             std::span<const std::size_t> bodies, Eigen::VectorXd& z) const;

 private:
  static constexpr int kFriction = Dimension<Dim>::friction;
  static constexpr int kAngular = Dimension<Dim>::angular;
  /// Of vectors of rotation in space, where those of the plane begin.
  static constexpr int kFirstTurn = 3 - kAngular;
  using Course = SweepAcceleration::Block<4>;

  struct Body {
    Lanes velocity = no_lanes();  ///< change of it, over size_ [m/s]
    Lanes spin = no_lanes();      ///< likewise [rad/s]
    std::array<Lanes, 3> inverse_inertia{no_lanes(), no_lanes(), no_lanes()};  ///< columns
    float inverse_mass = 0.0F;
  };
  struct Contact {
    Lanes normal = no_lanes();
    Lanes along = no_lanes();   ///< t times its semi-axis
    Lanes across = no_lanes();  ///< o times its semi-axis
    std::array<Lanes, 2> arm{no_lanes(), no_lanes()};
    Lanes steps = no_lanes();   ///< (y, p) per (w, psi / h)
    Lanes change = no_lanes();  ///< of (y, p), over size_
    Lanes before = no_lanes();  ///< the same where the last pair of sweeps began
    // Of where the round began, over size_:
    Lanes stick = no_lanes();   ///< - steps (w, psi / h): what rows ask for, before friction is bounded
    Lanes anchor = no_lanes();  ///< y + stick
    Lanes slide = no_lanes();   ///< anchor / |anchor| mu p - y: what they ask for of a contact that slides
    float length = 0.0F;        ///< |anchor|
    float excess = 0.0F;        ///< |anchor|^2 - (mu p)^2, over size_ once more
    float load = 0.0F;          ///< p
    float mu = 0.0F;
    float unit = 1.0F;      ///< of impulses, m V [N s]
    float spinning = 0.0F;  ///< semi-axis of the moment about the normal [m]
    std::array<std::size_t, 2> body{};
  };
  /// Where the round begins, in the problem's units; w and psi / h in m/s.
  struct Start {
    FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
    double p = 0.0;
    double radius = 0.0;  ///< mu p
    FrictionVector<Dim> w = FrictionVector<Dim>::Zero();
    double gap = 0.0;  ///< psi / h
    SweepSteps steps;
  };

  void sweep(Contact& contact);
  void push(const Contact& contact, Lanes change);

  std::vector<BodyResponse<Dim>> responses_;  ///< of the bodies, of which the first one is all that is fixed
  std::vector<Body> bodies_;
  std::vector<Contact> contacts_;
  std::vector<Start> starts_;
  std::vector<Course> courses_;
  SweepAcceleration acceleration_;
  double size_ = 1.0;  ///< unit of changes
};

}  // namespace touchstone
