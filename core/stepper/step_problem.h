#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/complementarity/problem.h"
#include "core/contact/closest_points.h"
#include "core/method.h"
#include "core/stepper/contact_rows.h"
#include "core/stepper/joint_rows.h"
#include "core/stepper/motion_jacobian.h"
#include "core/stepper/step_bodies.h"

namespace touchstone {

/// The rows of one contact or joint alone, as functions of its bodies' velocities and of its own unknowns.
/// Its unknowns and rows, in one order: nu' of body 1 and of body 2 if they move, and then its own.
template <int Dim>
struct StepBlock {
  std::array<int, 2> place{-1, -1};            ///< moving body of the island, -1 for a fixed one
  std::array<Eigen::Index, 2> column{-1, -1};  ///< of its nu' in the block
  ContactLayout at{};                          ///< of a contact's own unknowns in the block
  Eigen::Index own = 0;                        ///< where its own unknowns begin
  Eigen::Index size = 0;
  Eigen::VectorXd f;  ///< rows: the first `size` entries; the bodies' are what this block adds to them
  Eigen::MatrixXd j;  ///< derivatives: the leading `size` x `size` block

  /// Makes room; does not allocate once the largest size was seen.
  void set_size(Eigen::Index n) {
    size = n;
    if (f.size() >= n) return;
    f.resize(n);
    j.resize(n, n);
  }
};

/// A search for the closest points of two bodies, from cold.
template <int Dim>
using FindClosest = ClosestPoints<Dim> (*)(const ConvexSurface<Dim>&, const Pose<Dim>&,
                                           const ConvexSurface<Dim>&, const Pose<Dim>&);

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

  /// Sets the step that starts in `state` and lasts h [s], with `contacts` as its possible contacts, for all
  /// bodies and joints of the scene at once.
  void prepare(std::span<const BodyState<Dim>> state, double h,
               const std::vector<ContactPair<Dim>>& contacts);

  /// Sets the step that starts in `state` and lasts h [s]; its islands are then chosen one after the other.
  void begin(std::span<const BodyState<Dim>> state, double h);
  /// Makes this the problem of one island of the step that begin() set.
  /// @param bodies    indices of moving bodies
  /// @param joints    indices of the scene's joints, each between bodies of the island or fixed ones
  /// @param contacts  likewise
  void select(std::span<const int> bodies, std::span<const int> joints,
              std::span<const ContactPair<Dim>> contacts);

  void set_form(FrictionForm form);
  void set_gap(GapFunction gap) { row_options_.gap = gap; }
  /// Smooths the projection form of friction (see friction_rows()); 0: not at all.
  void set_smoothing(double smoothing) { row_options_.smoothing = smoothing; }
  [[nodiscard]] const Scale& scale() const { return row_options_.scale; }

  [[nodiscard]] Eigen::Index size() const override { return layout_.size(); }
  [[nodiscard]] double step_size() const { return row_options_.h; }
  [[nodiscard]] const Eigen::VectorXd& lower() const override;
  [[nodiscard]] const Eigen::VectorXd& upper() const override;
  void evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const override;
  [[nodiscard]] std::string row_name(Eigen::Index row) const override;

  // The same rows piece by piece, for whoever eliminates unknowns. z may be longer than size().

  // Of the moving bodies, by number in this island (StepBodies).
  [[nodiscard]] Twist<Dim> momentum_row(int place, const Eigen::VectorXd& z) const {
    return bodies_.momentum_row(place, z);
  }
  [[nodiscard]] MotionMatrix<Dim> momentum_matrix(int place) const { return bodies_.momentum_matrix(place); }
  [[nodiscard]] const Twist<Dim>& momentum_scale(int place) const { return bodies_.momentum_scale(place); }
  [[nodiscard]] const Twist<Dim>& start_velocity_of(int place) const { return bodies_.start_velocity(place); }
  [[nodiscard]] Twist<Dim> free_velocity_of(int place) const { return bodies_.free_velocity(place); }

  /// Evaluates contact i at z, for contact_block().
  void evaluate_state(std::size_t i, const Eigen::VectorXd& z) const;
  /// The same into a state of the caller's, which may have been another contact's: over thousands of
  /// contacts, which have 2 kB of state each, it is memory that evaluations wait for.
  void evaluate_state(std::size_t i, const Eigen::VectorXd& z, ContactState<Dim>& state) const;
  /// find_points(), and the contact there into a state of the caller's.
  void evaluate_anew(std::size_t i, Eigen::VectorXd& z, ContactState<Dim>& state);
  /// Rows of contact i where it was evaluated last, and their derivatives if asked for.
  void contact_block(std::size_t i, bool derivatives, StepBlock<Dim>& block) const {
    contact_block(i, states_[i], derivatives, block);
  }
  /// The same of a state of the caller's.
  void contact_block(std::size_t i, ContactState<Dim>& state, bool derivatives, StepBlock<Dim>& block) const;
  /// After contact_block() at the same z: what load_rows_by_motion() gives.
  void contact_block_by_motion(std::size_t i, StepBlock<Dim>& block, MotionJacobian<Dim>& motions) const;
  /// Numbers of the moving bodies of contact i in this island, -1 for a fixed one.
  [[nodiscard]] std::array<int, 2> places(std::size_t i) const;
  /// psi [m] of contact i where it was evaluated last.
  [[nodiscard]] double separation(std::size_t i) const { return states_[i].distance(); }
  /// Whether the closest points of contact i, where it was evaluated last, satisfy the rows and are none:
  /// - those of a smooth side ask for N_1 along n only, which its farthest point satisfies too (Eq. 9 does
  /// not);
  /// - f(a_2) >= 0 (Eq. 6) holds of a body that is through another one, since a_2 is then outside again.
  [[nodiscard]] bool is_spurious(std::size_t i) const { return is_spurious(states_[i]); }
  [[nodiscard]] bool is_spurious(const ContactState<Dim>& state) const;
  /// Counts as the residual of such points: N_1 is n where it should be -n.
  static constexpr double kSpuriousResidual = 2.0;
  /// Contact i where it was evaluated last.
  [[nodiscard]] const ContactState<Dim>& state(std::size_t i) const { return states_[i]; }
  /// Rows of joint i of the scene, one of this island, at z.
  void joint_block(int i, const Eigen::VectorXd& z, bool derivatives, StepBlock<Dim>& block) const;

  [[nodiscard]] const StepLayout<Dim>& layout() const { return layout_; }
  [[nodiscard]] const std::vector<ContactPair<Dim>>& contacts() const { return contacts_; }
  [[nodiscard]] const PreparedContact<Dim>& prepared(std::size_t i) const { return prepared_[i]; }
  /// Of this island.
  [[nodiscard]] int moving_bodies() const { return bodies_.count(); }
  /// Index in the scene of moving body number `place` of this island.
  [[nodiscard]] int body(int place) const { return bodies_.selected()[static_cast<std::size_t>(place)]; }
  [[nodiscard]] std::span<const int> bodies() const { return bodies_.selected(); }
  [[nodiscard]] std::span<const int> joints() const { return selected_joints_; }

  /// nu' of a free step: no contact impulse. Entries of z below layout().velocity(moving_bodies()).
  void free_velocity(Eigen::VectorXd& z) const;
  /// Number of scalar constraints of joint i of the scene.
  [[nodiscard]] int joint_row_count(int i) const {
    return static_cast<int>(joints_[static_cast<std::size_t>(i)].rows.size());
  }
  /// Where the impulses of joint i of the scene, one of this island, stand in z.
  [[nodiscard]] Eigen::Index joint_column(int i) const { return joint_column_[static_cast<std::size_t>(i)]; }
  /// What joint i of the scene, one of this island, does at a solution z.
  [[nodiscard]] JointImpulse<Dim> joint_impulse(int i, const Eigen::VectorXd& z) const;

  /// Writes the unknowns of contact i for given closest points, world frame; impulses and multipliers are
  /// left alone.
  void set_points(std::size_t i, const Vector<Dim>& a_1, const Vector<Dim>& a_2, Eigen::VectorXd& z) const;
  /// Chooses the direction whose projection is t, for a contact whose normal is near `normal`: the law's, or
  /// another where that one is too close to the normal to define t.
  void set_normal_estimate(std::size_t i, const Vector<Dim>& normal) {
    prepared_[i].reference = usable_reference(normal, contacts_[i].law.tangent);
  }
  /// Weighs slip in the friction rows of contact i by its load p > 1, in m V, until the next select(). The
  /// rows are y - proj(y - rho w): with a y of 1e3 they round as coarsely as w may be wrong, and Eq. 5 then
  /// multiplies that error by p.
  void expect_load(std::size_t i, double p) {
    const double largest = prepared_[i].semi_axes.template head<Dim - 1>().maxCoeff();
    prepared_[i].rho = std::max(1.0, p) / (3 * largest * largest);
  }
  /// Finds the closest points of contact i from cold, at the poses that nu' in z leads to, and writes its
  /// points, multipliers and reference direction.
  /// @param find  closest_points() or patch_middle()
  void find_points(std::size_t i, Eigen::VectorXd& z, FindClosest<Dim> find = &closest_points<Dim>);
  /// Position of body 1 of contact i at the end of the step, relative to prepared(i).origin.
  [[nodiscard]] Vector<Dim> body_1_position(std::size_t i, const Eigen::VectorXd& z) const {
    return bodies_.position(contacts_[i].body_1, prepared_[i].origin, z);
  }
  /// The states of this island's bodies at the end of the step for a solution z; others are left alone.
  void advance(const Eigen::VectorXd& z, std::span<BodyState<Dim>> state) const { bodies_.advance(z, state); }
  /// Closest point of side k (0: body 1, 1: body 2) at the last z evaluated, relative to prepared(i).origin.
  [[nodiscard]] const Vector<Dim>& point(std::size_t i, std::size_t k) const {
    return states_[i].side[k].point;
  }
  /// Contact i where it was evaluated last: points, frame and impulses in SI units.
  [[nodiscard]] ContactImpulse<Dim> impulse(std::size_t i) const;

 private:
  void prepare_contact(std::size_t i);
  void assign_bounds() const;
  void differentiate_state(std::size_t i, ContactState<Dim>& state) const;
  [[nodiscard]] std::array<BodyAtEnd<Dim>, 2> joint_bodies(const JointRows<Dim>& joint,
                                                           const Eigen::VectorXd& z) const;
  void place_state(std::size_t i, const Eigen::VectorXd& z, ContactState<Dim>& state) const;
  [[nodiscard]] std::array<Pose<Dim>, 2> poses(std::size_t i, const Eigen::VectorXd& z) const;
  void place_points(std::size_t i, const std::array<Pose<Dim>, 2>& pose, FindClosest<Dim> find,
                    Eigen::VectorXd& z);
  void set_points(std::size_t i, const std::array<Pose<Dim>, 2>& pose, const Vector<Dim>& a_1,
                  const Vector<Dim>& a_2, Eigen::VectorXd& z) const;
  void set_multipliers(std::size_t i, const std::array<Pose<Dim>, 2>& pose, const ClosestPoints<Dim>& closest,
                       Eigen::VectorXd& z) const;
  void place_bodies(std::array<int, 2> body, Eigen::Index own, StepBlock<Dim>& block) const;
  void momentum_rows(const Eigen::VectorXd& z, Eigen::VectorXd& f, Eigen::MatrixXd* jacobian) const;

  const Scene<Dim>& scene_;
  ContactRowOptions row_options_{};
  StepBodies<Dim> bodies_;
  std::vector<JointRows<Dim>> joints_;  ///< all joints
  std::vector<int> selected_joints_;
  std::vector<Eigen::Index> joint_column_;
  std::vector<ContactPair<Dim>> contacts_;
  std::vector<PreparedContact<Dim>> prepared_;
  StepLayout<Dim> layout_;
  mutable bool bounds_are_set_ = false;  ///< only the full problem's solvers ask for them
  mutable Eigen::VectorXd lower_;
  mutable Eigen::VectorXd upper_;
  mutable std::vector<ContactState<Dim>> states_;  ///< workspace of evaluate()
};

/// L and V of a scene (see Scale). @param sizes  radius of each moving body's bounding ball
template <int Dim>
Scale scene_scale(const Scene<Dim>& scene);

}  // namespace touchstone
