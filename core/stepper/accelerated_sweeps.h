#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/stepper/lanes.h"
#include "core/stepper/step_problem.h"
#include "core/stepper/sweep_acceleration.h"
#include "core/stepper/sweep_groups.h"
#include "core/stepper/sweep_steps.h"

namespace touchstone {

/// Projected Gauss-Seidel as in contact_sweeps.h for rounds over many contacts: looks for the change of
/// impulses and velocities from where a round begins. To find a digit or two of a change, single precision
/// serves, however small it is against what it is added to, which stays in z in double precision.
///
/// Four contacts that share no moving body are swept over at once, a lane each (sweep_groups.h). What sweeps
/// read of a contact is 0.5 kB, acceleration included, since with thousands of them memory is what they wait
/// for. Planar contacts are swept over as spatial ones between bodies that turn about z alone.
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
  [[nodiscard]] double change(std::size_t i) const { return size_ * static_cast<double>(last_change_[i]); }
  /// Adds what has changed of the velocities of `bodies` and the impulses of `contacts` to z.
  void write(const StepProblem<Dim>& problem, std::span<const std::size_t> contacts,
             std::span<const std::size_t> bodies, Eigen::VectorXd& z) const;

 private:
  static constexpr int kFriction = Dimension<Dim>::friction;
  static constexpr int kAngular = Dimension<Dim>::angular;
  /// Of vectors of rotation in space, where those of the plane begin.
  static constexpr int kFirstTurn = 3 - kAngular;
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  struct Body {
    Lanes velocity = no_lanes();  ///< change of it, over size_ [m/s]
    Lanes spin = no_lanes();      ///< likewise [rad/s]
    std::array<Lanes, 3> inverse_inertia{no_lanes(), no_lanes(), no_lanes()};  ///< columns
    float inverse_mass = 0.0F;
  };
  /// What sweeps read and write of a contact, or of a group of them, a lane each: Number is float or Lanes.
  template <typename Number>
  struct Contact {
    using Vector = std::array<Number, 3>;
    Vector normal{};
    Vector along{};   ///< t times its semi-axis
    Vector across{};  ///< o times its semi-axis
    std::array<Vector, 2> arm{};
    Number friction_step{};  ///< y per w
    Number normal_step{};    ///< p per psi / h
    Number mu{};
    Number unit{};                   ///< of impulses, m V [N s]
    Number spinning{};               ///< semi-axis of the moment about the normal [m]
    std::array<Number, 4> change{};  ///< of (y, p), over size_
    // Of where the round began, over size_:
    std::array<Number, 4> stick{};  ///< - steps (w, psi / h): what rows ask for, before friction is bounded
    Vector anchor{};                ///< y + the first three of stick
    Vector slide{};   ///< anchor / |anchor| mu p - y: what they ask for of a contact that slides
    Number length{};  ///< |anchor|
    Number excess{};  ///< |anchor|^2 - (mu p)^2, over size_ once more
    Number load{};    ///< p
    Number part{};    ///< mu p / |anchor|
    std::array<Number, 2> unused{};  ///< so that their numbers come in fours
  };
  /// Four contacts that share no moving body, or fewer: an empty lane is one of fixed bodies, without load.
  struct Group {
    Contact<Lanes> contact;
    std::array<Lanes, 4> before{};  ///< changes where the last pair of sweeps began; then what it added
    std::array<std::array<std::size_t, kLanes>, 2> body{};
    std::array<std::size_t, kLanes> member{kNone, kNone, kNone, kNone};
  };
  using Course = SweepAcceleration::Block<4 * kLanes>;

  /// Where the round begins, in the problem's units; w and psi / h in m/s.
  struct Start {
    FrictionVector<Dim> y = FrictionVector<Dim>::Zero();
    double p = 0.0;
    double radius = 0.0;  ///< mu p
    FrictionVector<Dim> w = FrictionVector<Dim>::Zero();
    double gap = 0.0;  ///< psi / h
    SweepSteps steps;
  };

  void group(std::span<const std::size_t> contacts);
  void ungroup();
  void sweep(Group& group);
  void push(const Group& group, const std::array<Lanes, 4>& change);
  [[nodiscard]] static Course::Short entries(const std::array<Lanes, 4>& change);

  std::vector<BodyResponse<Dim>> responses_;  ///< of the bodies, of which the first one is all that is fixed
  std::vector<Body> bodies_;
  std::vector<Contact<float>> contacts_;
  std::vector<std::array<std::size_t, 2>> bodies_of_contact_;
  std::vector<float>
      last_change_;  ///< of each contact, of its impulses the largest, in the last pair over it
  std::vector<Start> starts_;
  SweepGroups<kLanes> order_;
  std::vector<Group> groups_;    ///< of the contacts that are swept over
  std::vector<Course> courses_;  ///< of the groups
  SweepAcceleration acceleration_;
  double size_ = 1.0;  ///< unit of changes
};

}  // namespace touchstone
