#pragma once

#include <vector>

#include "core/stepper/interior_contact.h"
#include "core/stepper/reduced_system.h"

namespace touchstone {

/// A primal-dual interior-point method for the step of many contacts, where contacts stick that are more than
/// the motion needs. Their impulses are not unique, which leaves Newton's method on an active set without a
/// direction; here every contact has for tau > 0 (InteriorContact)
///   p psi / (h V) = tau,   (mu p, y) o (sigma, w) = tau e,
/// with all else as in Eqs. 10-11, at the end of the step. Impulses are then unique, in the middle of those
/// that do, and a Newton step is a linear system in the velocities alone, since what impulses do follows
/// contact by contact. Coulomb's law is not that of a convex problem, and geometry moves: the path of
/// solutions for tau -> 0 may turn back in tau. Two ways lead along it:
/// - descend(): predictor and corrector (Mehrotra, SIAM J. Optim. 2, 1992) in the scaling of Nesterov and
///   Todd, without care for the path: 20 to 30 systems, and mostly enough, also across many a turn;
/// - follow(): pseudo-arclength continuation (Keller 1977), round every turn, in three to ten times that.
/// Either ends near a solution, at a tau at which it is nearly told which contacts stick; Newton's method
/// finishes.
///
/// Of problems without joints and intersections: each contact's closest points are to follow from the poses.
template <int Dim>
class InteriorPath {
 public:
  [[nodiscard]] static bool applies_to(const StepProblem<Dim>& problem);

  /// Starts at `tau` near z. @param problem  must outlive the use; in the projection form of friction, as
  /// which it is left after each call
  void begin(StepProblem<Dim>& problem, const Eigen::VectorXd& z, double tau);
  /// Goes on from where the last of both ended, until the mean product is at most `tau`. False if it is
  /// stuck.
  [[nodiscard]] bool descend(double tau);
  /// Follows the path from where it was left, or the start, until it is at `tau` or below. False if no step
  /// leads on.
  [[nodiscard]] bool follow(double tau);
  /// Where the last of both ended, into z.
  void write(Eigen::VectorXd& z) const { z.head(problem_->size()) = point_.z; }
  /// Mean of the products that are to be tau there, without those that are as small as they need be.
  [[nodiscard]] double mean_product() const;
  /// Linear systems since begin().
  [[nodiscard]] int factorisations() const { return factorisations_; }

 private:
  using Contact = InteriorContact<Dim>;
  using Unknowns = InteriorUnknowns<Dim>;
  using Goal = typename Contact::Goal;
  static constexpr int kVelocity = Dimension<Dim>::velocity;

  struct Point {
    Eigen::VectorXd z;  ///< of the problem's size
    std::vector<Unknowns> contacts;
    double log_tau = 0.0;
  };
  struct Step {
    Eigen::VectorXd velocity;
    std::vector<Unknowns> contacts;
    double log_tau = 0.0;
  };

  void write_impulses();
  [[nodiscard]] bool evaluate();
  [[nodiscard]] bool linearise();
  void find_direction(const Goal& goal, Step& step);
  [[nodiscard]] double slack() const;
  [[nodiscard]] double longest(const Step& step) const;
  void move(double factor, const Step& step, bool residual);
  // of follow()
  [[nodiscard]] bool centre();
  [[nodiscard]] bool advance();
  [[nodiscard]] bool find_tangent();
  [[nodiscard]] bool correct();
  [[nodiscard]] double scalar_product(const Step& a, const Step& b) const;
  [[nodiscard]] double largest(const Step& step) const;
  static void add(double factor, const Step& other, Step& step);

  StepProblem<Dim>* problem_ = nullptr;
  std::vector<Contact> contacts_;
  std::size_t count_ = 0;  ///< of them in use
  ReducedSystem system_;
  Eigen::VectorXd rows_;  ///< of momentum
  Eigen::VectorXd right_side_;
  Point point_, path_, kept_;
  Step step_, tangent_, along_;
  bool centred_ = false;  ///< path_ is on the path
  bool has_tangent_ = false;
  double first_sign_ = 0.0;  ///< of the determinant
  double length_ = 0.0;      ///< of the next step along the path
  int corrections_ = 0;      ///< of the last one
  int factorisations_ = 0;
  int path_systems_ = 0;  ///< of them, in follow()
  int most_systems_ = 0;  ///< at which follow() gives up
};

}  // namespace touchstone
