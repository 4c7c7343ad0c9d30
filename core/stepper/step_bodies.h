#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/method.h"
#include "core/stepper/contact_rows.h"

namespace touchstone {

/// The moving bodies of a step's problem: their momentum rows, and where each is at the end of the step as a
/// function of its unknown nu', which stands in z before everything else, body after body.
template <int Dim>
class StepBodies {
 public:
  /// @param scene  must outlive this
  explicit StepBodies(const Scene<Dim>& scene);

  /// Sets the step that starts in `state` and lasts h [s].
  void begin(std::span<const BodyState<Dim>> state, double h, const Scale& scale);
  /// Chooses the bodies whose unknowns are in z, in this order.
  /// @param bodies  indices of moving bodies
  void select(std::span<const int> bodies);

  [[nodiscard]] std::span<const int> selected() const { return selected_; }
  [[nodiscard]] int count() const { return static_cast<int>(selected_.size()); }
  /// Number among those selected, -1 for a fixed body.
  [[nodiscard]] int place(int body) const { return place_[static_cast<std::size_t>(body)]; }
  [[nodiscard]] const Pose<Dim>& start(int body) const { return start_[static_cast<std::size_t>(body)].pose; }
  /// Indices in the scene of all bodies that move, selected or not.
  [[nodiscard]] std::vector<int> all_moving() const;
  /// Mass of the lighter of two bodies that moves: the unit of impulses between them, over V.
  [[nodiscard]] double lighter_mass(int body_1, int body_2) const;

  /// M nu' - M nu - p_app - p_vp, without contacts and joints, scaled: the first row of Eq. 10.
  [[nodiscard]] Twist<Dim> momentum_row(int place, const Eigen::VectorXd& z) const;
  /// Its derivative by nu': constant during the step.
  [[nodiscard]] MotionMatrix<Dim> momentum_matrix(int place) const;
  /// What the momentum rows are multiplied with.
  [[nodiscard]] const Twist<Dim>& momentum_scale(int place) const { return inertial(place).row_scale; }
  /// nu at the start of the step.
  [[nodiscard]] const Twist<Dim>& start_velocity(int place) const {
    return start_[static_cast<std::size_t>(selected_[static_cast<std::size_t>(place)])].velocity;
  }
  /// nu' of a free step.
  [[nodiscard]] Twist<Dim> free_velocity(int place) const;

  // A body at the end of the step, positions relative to `origin`; any body of the scene.

  /// What does not depend on z; of a fixed body that is everything.
  void start_body(int body, const Vector<Dim>& origin, BodyAtEnd<Dim>& end) const;
  /// Moves a body that start_body() has set to q' = q (+) h nu' (Eq. 4).
  void move_body(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z, BodyAtEnd<Dim>& end) const;
  /// Both, into an `end` that may have been another body's.
  void place_body(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z, BodyAtEnd<Dim>& end) const;
  /// Fills d(theta)/d(omega') of a body that move_body() has moved.
  void differentiate_body(int body, BodyAtEnd<Dim>& end) const;
  [[nodiscard]] Pose<Dim> pose(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z) const;
  [[nodiscard]] Vector<Dim> position(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z) const;
  /// The states of the selected bodies at the end of the step; others are left alone.
  void advance(const Eigen::VectorXd& z, std::span<BodyState<Dim>> state) const;

 private:
  static constexpr int kVelocity = Dimension<Dim>::velocity;
  static constexpr int kAngular = Dimension<Dim>::angular;
  static constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

  struct Inertial {
    double mass = 1.0;
    Inertia<Dim> inertia =
        Inertia<Dim>::Identity();              ///< world frame, at the start of the step (as in the paper)
    Twist<Dim> momentum = Twist<Dim>::Zero();  ///< M nu + p_app + p_vp
    Twist<Dim> row_scale = Twist<Dim>::Zero();
  };
  /// What each contact of a moving body asks for, close together. How the body has turned by the end of the
  /// step is kept from one to the next, which mostly asks with the same omega'.
  struct Moving {
    Vector<Dim> position = Vector<Dim>::Zero();  ///< at the start of the step
    Twist<Dim> row_scale = Twist<Dim>::Zero();
    Angular<Dim> omega = Angular<Dim>::Constant(kNotANumber);  ///< omega' that the others are for
    Rotation<Dim> rotation{};
    Inertia<Dim> jacobian = Inertia<Dim>::Zero();  ///< d(theta)/d(omega')
    bool has_jacobian = false;
  };

  [[nodiscard]] bool is_fixed(std::size_t body) const { return fixed_[body] != 0; }
  [[nodiscard]] const Inertial& inertial(int place) const {
    return inertial_[static_cast<std::size_t>(selected_[static_cast<std::size_t>(place)])];
  }
  void prepare(std::size_t body, const Scale& scale);
  [[nodiscard]] Moving& turned(std::size_t body, const Angular<Dim>& omega) const;

  const Scene<Dim>& scene_;
  double h_ = 0.0;
  // Each of these has an entry for every body of the scene.
  std::vector<BodyState<Dim>> start_;
  std::vector<Inertial> inertial_;
  std::vector<char> fixed_;  ///< close together, since each contact asks; the scene's bodies are large
  std::vector<int> place_;   ///< -1 for a fixed body; not meant for one that is not selected
  mutable std::vector<Moving> moving_;
  std::vector<int> selected_;
};

}  // namespace touchstone
