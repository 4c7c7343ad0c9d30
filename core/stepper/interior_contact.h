#pragma once

#include <array>
#include <span>

#include "core/complementarity/dense_lu.h"
#include "core/stepper/friction_cone.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

/// What a contact has of its own in an interior-point method, or a change of it.
template <int Dim>
struct InteriorUnknowns {
  static constexpr int kFriction = Dimension<Dim>::friction;
  using Element = Eigen::Matrix<double, kFriction + 1, 1>;

  FrictionVector<Dim> y = FrictionVector<Dim>::Zero();  ///< friction, as StepProblem's
  double p = 0.0;                                       ///< p_n / (m V)
  double gap = 0.0;                                     ///< psi / (h V)
  Element slip = Element::Zero();                       ///< (sigma, w) over V

  /// (mu p, y): in the cone of friction.
  [[nodiscard]] Element load(double mu) const { return (Element() << mu * p, y).finished(); }
  /// Adds a multiple of another one.
  void add(double factor, const InteriorUnknowns& other) {
    y += factor * other.y;
    p += factor * other.p;
    gap += factor * other.gap;
    slip += factor * other.slip;
  }
};

/// A contact in InteriorPath: its rows with the closest points eliminated, and its part of a direction.
///
/// For tau > 0, (mu p, y) and (sigma, w) inside the cone of friction and p, gap > 0:
///   p gap = tau,   (mu p, y) o (sigma, w) = tau e,   gap = psi(nu') / (h V),   w = w(nu').
/// That is mu p w + sigma y = 0 and mu p sigma + y . w = tau: friction against the slip, viscous at low
/// speed. For tau = 0 it is Coulomb's law with sigma = |w|. Without friction (mu = 0) the second pair is left
/// out.
template <int Dim>
class InteriorContact {
 public:
  using Unknowns = InteriorUnknowns<Dim>;
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kFriction = Dimension<Dim>::friction;
  /// A number, or a row and column, for each velocity of the contact's moving bodies: one or two. There are
  /// no more unknowns of the closest points, nor impulses.
  using OfVelocities = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kVelocity, 1>;
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * kVelocity, 2 * kVelocity>;

  /// Least products that are of use: a contact that sticks or closes has a slip or gap of `floor` V at least,
  /// and one that slips is off its greatest friction by this part of it. Rounding does not tell what is less.
  struct Floors {
    double normal = 0.0;
    double friction = 0.0;
  };
  /// What a direction leads to.
  struct Goal {
    double tau = 0.0;
    double floor = 0.0;         ///< see Floors
    bool second_order = false;  ///< with the products of the last direction's changes (Mehrotra)
    bool tangent = false;       ///< derivative by log(tau) along the path instead
  };

  /// Becomes contact i of `problem`, which must outlive the use.
  void bind(StepProblem<Dim>& problem, std::size_t i);
  /// Unknowns of the path at tau that are near z, where rows are as frozen as they need be: those whose p -
  /// gap and y - w are those of z.
  [[nodiscard]] Unknowns start(const Eigen::VectorXd& z, double tau);

  /// Rows and derivatives at z, the contact's own entries of which are `at`, and the scaling there. Finds
  /// closest points anew, in z, where a step has lost them. False if these do not follow from the poses.
  [[nodiscard]] bool evaluate(const Unknowns& at, Eigen::VectorXd& z);
  /// Largest amount by which gap and w differ from those of the poses.
  [[nodiscard]] double slack() const;
  /// Mean of the products that are to be tau, without those that are as small as they need be.
  [[nodiscard]] double complementarity(const Unknowns& at, double floor) const;

  [[nodiscard]] const std::array<int, 2>& place() const { return block_.place; }
  /// What the contact adds to the momentum rows of body k.
  [[nodiscard]] Twist<Dim> wrench(std::size_t k) const {
    return wrench_.template segment<kVelocity>(block_.column[k]);
  }
  /// What it adds to the matrix: a row and column for each of its bodies' velocities, numbered by columns(),
  /// with their places.
  [[nodiscard]] Block matrix() const;
  [[nodiscard]] std::span<const Eigen::Index> columns() const { return {columns_.data(), velocities()}; }
  [[nodiscard]] std::span<const Eigen::Index> places() const { return {places_.data(), velocities()}; }

  /// Begins a direction. @return  what its impulses for no motion add to the momentum rows of the bodies
  [[nodiscard]] OfVelocities begin_direction(const Unknowns& at, const Goal& goal);
  /// Adds a change of velocities (of all bodies) to the direction.
  void respond(const Eigen::VectorXd& velocity);
  /// What the direction adds to the momentum rows: by velocities in all, and by impulses.
  [[nodiscard]] OfVelocities momentum_change(const Eigen::VectorXd& velocity) const;
  /// The direction, for the velocities it was given in all.
  [[nodiscard]] Unknowns end_direction(const Eigen::VectorXd& velocity);
  /// Moves closest points with the velocities; with what their rows are off if `residual`.
  void move_points(const Eigen::VectorXd& velocity, double factor, bool residual, Eigen::VectorXd& z) const;

  /// Longest step from `at` that stays inside.
  [[nodiscard]] double longest_step(const Unknowns& at, const Unknowns& step) const;
  /// Sum of products of changes relative to the size of what changes; and the largest relative change.
  [[nodiscard]] double scalar_product(const Unknowns& at, const Unknowns& a, const Unknowns& b) const;
  [[nodiscard]] double largest(const Unknowns& at, const Unknowns& step) const;

 private:
  static constexpr int kRows = kFriction + 1;
  using Element = typename Unknowns::Element;
  using Cone = FrictionCone<kRows>;
  using Rows = Eigen::Matrix<double, kRows, 1>;  ///< of (y, p) or (w, gap)

  [[nodiscard]] Floors floors(const Unknowns& at, double floor) const;
  void eliminate_points();
  [[nodiscard]] bool factor_points();
  [[nodiscard]] double points_residual() const;
  void set_answer(const Unknowns& at);
  [[nodiscard]] OfVelocities gather(const Eigen::VectorXd& velocity) const;
  [[nodiscard]] std::size_t velocities() const { return static_cast<std::size_t>(block_.own); }

  StepProblem<Dim>* problem_ = nullptr;
  std::size_t i_ = 0;
  double mu_ = 0.0;
  double gap_weight_ = 1.0;  ///< from psi / L to psi / (h V)
  StepBlock<Dim> block_;
  DenseLu lu_;
  std::array<Eigen::Index, 2 * kVelocity> columns_{}, places_{};
  Block point_response_;       ///< - d points / d nu'
  OfVelocities point_offset_;  ///< by which points are off
  Block stiffness_;            ///< of the momentum rows by nu' while impulses stay
  Block by_impulse_;           ///< of the momentum rows by (y, p)
  Block motion_;               ///< of (w, gap) by nu'
  OfVelocities wrench_;
  Rows slack_ = Rows::Zero();  ///< (w, gap) of the poses less those of the unknowns
  ConeScaling<kRows> scaling_;
  Element scaled_ = Element::Zero();  ///< W (sigma, w)
  Eigen::Matrix<double, kRows, kRows> answer_ =
      Eigen::Matrix<double, kRows, kRows>::Zero();  ///< - d (y, p) / d (w, gap)
  Rows offset_ = Rows::Zero();                      ///< of the impulses, in the direction
  Rows impulse_ = Rows::Zero();                     ///< change of (y, p) in the direction
  Element centred_ = Element::Zero();               ///< W (W (sigma, w) \ right side)
  Unknowns direction_;                              ///< the last one
  bool moves_slack_ = true;
};

}  // namespace touchstone
