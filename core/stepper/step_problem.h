#pragma once

#include <span>
#include <vector>

#include "core/complementarity/problem.h"
#include "core/method.h"
#include "core/stepper/contact_rows.h"
#include "core/stepper/joint_rows.h"

namespace touchstone {

/// One step of the geometrically implicit time-stepper as a mixed complementarity problem: Eqs. 10-11 of
/// Chakraborty, Berard, Akella and Trinkle (2007), for any number of bodies and contacts.
///
/// Unknowns and rows are scaled: positions [m] and velocities [m/s, rad/s] as they are, impulses over m V and
/// sigma over V; rows that are lengths over L, velocities over V, angles and multipliers as they are (Scale).
/// Contact points are in world axes relative to the position of the contact's body 1 at the start of the
/// step, so that nothing cancels far from the world's origin.
template <int Dim>
class StepProblem final : public MixedComplementarityProblem {
 public:
  /// @param scene  must outlive the problem
  explicit StepProblem(const Scene<Dim>& scene);

  /// Sets the step that starts in `state` and lasts h [s], with `contacts` as its possible contacts.
  void prepare(std::span<const BodyState<Dim>> state, double h,
               const std::vector<ContactPair<Dim>>& contacts);

  void set_form(FrictionForm form);
  void set_gap(GapFunction gap) { row_options_.gap = gap; }
  [[nodiscard]] const Scale& scale() const { return row_options_.scale; }

  [[nodiscard]] Eigen::Index size() const override { return layout_.size(); }
  [[nodiscard]] const Eigen::VectorXd& lower() const override { return lower_; }
  [[nodiscard]] const Eigen::VectorXd& upper() const override { return upper_; }
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override;
  [[nodiscard]] std::string row_name(Eigen::Index row) const override;

  [[nodiscard]] const StepLayout<Dim>& layout() const { return layout_; }
  [[nodiscard]] const std::vector<ContactPair<Dim>>& contacts() const { return contacts_; }
  [[nodiscard]] const PreparedContact<Dim>& prepared(std::size_t i) const { return prepared_[i]; }
  [[nodiscard]] int moving_bodies() const { return static_cast<int>(moving_.size()); }

  /// nu' of a free step: no contact impulse. Entries of z below layout().velocity(moving_bodies()).
  void free_velocity(Eigen::VectorXd& z) const;
  /// Number of scalar joint constraints; their impulses are the entries of z from layout().joints() on.
  [[nodiscard]] Eigen::Index joint_row_count() const { return joint_row_count_; }
  /// What joint i of the scene does at a solution z.
  [[nodiscard]] JointImpulse<Dim> joint_impulse(std::size_t i, const Eigen::VectorXd& z) const;

  /// nu' = nu, the velocities at the start of the step.
  void start_velocity(Eigen::VectorXd& z) const;
  /// Writes the unknowns of contact i for given closest points, world frame; impulses and multipliers are
  /// left alone.
  void set_points(std::size_t i, const Vector<Dim>& a_1, const Vector<Dim>& a_2, Eigen::VectorXd& z) const;
  /// Chooses the direction whose projection is t, for a contact whose normal is near `normal`: the law's, or
  /// another where that one is too close to the normal to define t.
  void set_normal_estimate(std::size_t i, const Vector<Dim>& normal) {
    prepared_[i].reference = usable_reference(normal, contacts_[i].law.tangent);
  }
  /// Writes the multipliers of contact i, l of intersections, for closest points relative to
  /// prepared(i).origin whose normal out of body 2 is `normal`; does nothing for other shapes.
  void set_multipliers(std::size_t i, const Vector<Dim>& a_1, const Vector<Dim>& a_2,
                       const Vector<Dim>& normal, Eigen::VectorXd& z) const;
  /// Position of body 1 of contact i at the end of the step, relative to prepared(i).origin.
  [[nodiscard]] Vector<Dim> body_1_position(std::size_t i, const Eigen::VectorXd& z) const {
    return body_at_end(contacts_[i].body_1, prepared_[i].origin, z).pose.position;
  }
  /// The bodies' states at the end of the step for a solution z.
  void advance(const Eigen::VectorXd& z, std::span<BodyState<Dim>> state) const;
  /// Closest point of side k (0: body 1, 1: body 2) at the last z evaluated, relative to prepared(i).origin.
  [[nodiscard]] const Vector<Dim>& point(std::size_t i, std::size_t k) const {
    return states_[i].side[k].point;
  }
  /// Contact i as read back from z: points, frame and impulses in SI units.
  [[nodiscard]] ContactImpulse<Dim> impulse(std::size_t i, const Eigen::VectorXd& z) const;

 private:
  struct Moving {
    int body = 0;
    double mass = 1.0;
    Inertia<Dim> inertia =
        Inertia<Dim>::Identity();              ///< world frame, at the start of the step (as in the paper)
    Twist<Dim> momentum = Twist<Dim>::Zero();  ///< M nu + p_app + p_vp
    Twist<Dim> row_scale = Twist<Dim>::Zero();
  };

  void prepare_body(Moving& moving) const;
  void prepare_contact(std::size_t i);
  void assign_bounds();
  [[nodiscard]] BodyAtEnd<Dim> body_at_end(int body, const Vector<Dim>& origin,
                                           const Eigen::VectorXd& z) const;
  [[nodiscard]] std::array<BodyAtEnd<Dim>, 2> joint_bodies(const JointRows<Dim>& joint,
                                                           const Eigen::VectorXd& z) const;
  /// Mass of the lighter of two bodies that moves: the unit of impulses between them, over V.
  [[nodiscard]] double lighter_mass(int body_1, int body_2) const;
  void evaluate_state(std::size_t i, const Eigen::VectorXd& z) const;
  void momentum_rows(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const;

  const Scene<Dim>& scene_;
  ContactRowOptions row_options_{};
  std::vector<BodyState<Dim>> start_;
  std::vector<int> place_;  ///< of a body among those that move; -1 for a fixed one
  std::vector<Moving> moving_;
  std::vector<JointRows<Dim>> joints_;
  Eigen::Index joint_row_count_ = 0;
  std::vector<ContactPair<Dim>> contacts_;
  std::vector<PreparedContact<Dim>> prepared_;
  StepLayout<Dim> layout_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  mutable std::vector<ContactState<Dim>> states_;  ///< workspace of evaluate()
};

/// L and V of a scene (see Scale). @param sizes  radius of each moving body's bounding ball
template <int Dim>
Scale scene_scale(const Scene<Dim>& scene);

}  // namespace touchstone
