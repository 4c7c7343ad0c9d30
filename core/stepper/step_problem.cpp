#include "core/stepper/step_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace touchstone {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

template <int Dim>
Scale scene_scale(const Scene<Dim>& scene) {
  Scale scale;
  double size = 0;
  for (const auto& body : scene.bodies) {
    if (body.fixed) continue;
    const double radius = make_surface(body.shape)->bounding_ball().radius;
    if (std::isfinite(radius)) size = std::max(size, radius);
  }
  if (size > 0) scale.length = size;
  const double g = scene.gravity.norm();
  scale.velocity = g > 0 ? std::sqrt(g * scale.length) : scale.length;
  return scale;
}

template <int Dim>
StepProblem<Dim>::StepProblem(const Scene<Dim>& scene) : scene_(scene), bodies_(scene) {
  row_options_.scale = scene_scale(scene);
  for (const Joint<Dim>& joint : scene.joints) {
    joints_.push_back(joint_rows(joint, scene.bodies[static_cast<std::size_t>(joint.body_a)].pose,
                                 scene.bodies[static_cast<std::size_t>(joint.body_b)].pose));
    joints_.back().mass = bodies_.lighter_mass(joint.body_a, joint.body_b);
  }
  joint_column_.assign(joints_.size(), -1);
  selected_joints_.reserve(joints_.size());
}

template <int Dim>
void StepProblem<Dim>::set_form(FrictionForm form) {
  row_options_.form = form;
  bounds_are_set_ = false;
}

template <int Dim>
void StepProblem<Dim>::prepare(std::span<const BodyState<Dim>> state, double h,
                               const std::vector<ContactPair<Dim>>& contacts) {
  begin(state, h);
  std::vector<int> joints(joints_.size());
  std::iota(joints.begin(), joints.end(), 0);
  select(bodies_.all_moving(), joints, contacts);
}

template <int Dim>
void StepProblem<Dim>::begin(std::span<const BodyState<Dim>> state, double h) {
  row_options_.h = h;
  bodies_.begin(state, h, row_options_.scale);
}

template <int Dim>
void StepProblem<Dim>::select(std::span<const int> bodies, std::span<const int> joints,
                              std::span<const ContactPair<Dim>> contacts) {
  bodies_.select(bodies);
  selected_joints_.assign(joints.begin(), joints.end());
  Eigen::Index next = layout_.velocity(moving_bodies());
  for (const int joint : joints) {
    joint_column_[static_cast<std::size_t>(joint)] = next;
    next += joint_row_count(joint);
  }
  contacts_.assign(contacts.begin(), contacts.end());
  prepared_.resize(contacts.size());
  if (states_.size() < contacts.size()) states_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) prepare_contact(i);
  layout_.assign(moving_bodies(), next - layout_.velocity(moving_bodies()), contacts_);
  bounds_are_set_ = false;
}

template <int Dim>
void StepProblem<Dim>::prepare_contact(std::size_t i) {
  const ContactPair<Dim>& pair = contacts_[i];
  PreparedContact<Dim>& prepared = prepared_[i];
  prepared.origin = bodies_.start(pair.body_1).position;
  prepared.reference = pair.law.tangent.normalized();
  prepared.semi_axes = pair.law.semi_axes();
  prepared.active = (prepared.semi_axes.array() != 0).template cast<double>();
  prepared.mass = bodies_.lighter_mass(pair.body_1, pair.body_2);
  expect_load(i, 1.0);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const Side<Dim>& side = k == 0 ? pair.side_1 : pair.side_2;
    if (side.kind != SideKind::plane) continue;
    const HalfSpace<Dim>& surface = *side.surface->plane();
    const Pose<Dim>& pose = bodies_.start(k == 0 ? pair.body_1 : pair.body_2);
    PlaneAtStart<Dim>& plane = prepared.plane[k];
    plane.rotation = pose.rotation.matrix();
    plane.position = pose.position - prepared.origin;
    plane.basis = plane_basis(surface.normal);
    const Vector<Dim> normal = plane.rotation * surface.normal;
    plane.foot = (normal.dot(plane.position) + surface.offset) * normal;
    plane.foot_body = plane.rotation.transpose() * (plane.foot - plane.position);
  }
  ContactState<Dim>& contact = states_[i];
  contact.side[0].reserve(pair.side_1);
  contact.side[1].reserve(pair.side_2);
  bodies_.start_body(pair.body_1, prepared.origin, contact.body[0]);
  bodies_.start_body(pair.body_2, prepared.origin, contact.body[1]);
}

template <int Dim>
const Eigen::VectorXd& StepProblem<Dim>::lower() const {
  if (!bounds_are_set_) assign_bounds();
  return lower_;
}

template <int Dim>
const Eigen::VectorXd& StepProblem<Dim>::upper() const {
  if (!bounds_are_set_) assign_bounds();
  return upper_;
}

template <int Dim>
void StepProblem<Dim>::assign_bounds() const {
  bounds_are_set_ = true;
  lower_.setConstant(layout_.size(), -kInfinity);
  upper_.setConstant(layout_.size(), kInfinity);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactLayout& at = layout_.contact(i);
    lower_[at.normal] = 0;
    // In the projection form sigma = |w| is an equation.
    lower_[at.slip] = row_options_.form == FrictionForm::fritz_john ? 0 : -kInfinity;
    for (int l = 0; l < contacts_[i].side_1.multipliers(); ++l) lower_[at.multipliers_1 + l] = 0;
    for (int l = 0; l < contacts_[i].side_2.multipliers(); ++l) lower_[at.multipliers_2 + l] = 0;
  }
}

template <int Dim>
void StepProblem<Dim>::free_velocity(Eigen::VectorXd& z) const {
  for (int b = 0; b < moving_bodies(); ++b)
    z.template segment<Dimension<Dim>::velocity>(layout_.velocity(b)) = free_velocity_of(b);
}

template <int Dim>
void StepProblem<Dim>::evaluate_state(std::size_t i, const Eigen::VectorXd& z) const {
  const ContactPair<Dim>& pair = contacts_[i];
  ContactState<Dim>& state = states_[i];
  bodies_.move_body(pair.body_1, prepared_[i].origin, z, state.body[0]);
  bodies_.move_body(pair.body_2, prepared_[i].origin, z, state.body[1]);
  evaluate_contact(pair, prepared_[i], layout_.contact(i), z, state);
}

template <int Dim>
void StepProblem<Dim>::evaluate_state(std::size_t i, const Eigen::VectorXd& z,
                                      ContactState<Dim>& state) const {
  place_state(i, z, state);
  evaluate_contact(contacts_[i], prepared_[i], layout_.contact(i), z, state);
}

/// Bodies at the end of the step, and room for what is evaluated there.
template <int Dim>
void StepProblem<Dim>::place_state(std::size_t i, const Eigen::VectorXd& z, ContactState<Dim>& state) const {
  const ContactPair<Dim>& pair = contacts_[i];
  state.side[0].reserve(pair.side_1);
  state.side[1].reserve(pair.side_2);
  bodies_.place_body(pair.body_1, prepared_[i].origin, z, state.body[0]);
  bodies_.place_body(pair.body_2, prepared_[i].origin, z, state.body[1]);
}

/// What derivatives of contact i need beyond evaluate_state().
template <int Dim>
void StepProblem<Dim>::differentiate_state(std::size_t i, ContactState<Dim>& state) const {
  const ContactPair<Dim>& pair = contacts_[i];
  bodies_.differentiate_body(pair.body_1, state.body[0]);
  bodies_.differentiate_body(pair.body_2, state.body[1]);
  differentiate_contact(pair, prepared_[i], state);
}

/// M nu' - M nu - p_app - p_vp, the first row of Eq. 10 without the contacts' wrenches.
template <int Dim>
void StepProblem<Dim>::momentum_rows(const Eigen::VectorXd& z, Eigen::VectorXd& f,
                                     Eigen::MatrixXd* jacobian) const {
  constexpr int n = Dimension<Dim>::velocity;
  for (int b = 0; b < moving_bodies(); ++b) {
    const Eigen::Index at = layout_.velocity(b);
    f.template segment<n>(at) = momentum_row(b, z);
    if (jacobian != nullptr) jacobian->template block<n, n>(at, at) += momentum_matrix(b);
  }
}

/// Columns of two bodies' velocities, and room for `own` unknowns behind them.
template <int Dim>
void StepProblem<Dim>::place_bodies(std::array<int, 2> body, Eigen::Index own, StepBlock<Dim>& block) const {
  Eigen::Index next = 0;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    block.place[k] = bodies_.place(body[k]);
    const bool moves = block.place[k] >= 0;
    block.column[k] = moves ? next : -1;
    if (moves) next += Dimension<Dim>::velocity;
  }
  block.own = next;
  block.set_size(next + own);
}

template <int Dim>
void StepProblem<Dim>::contact_block(std::size_t i, ContactState<Dim>& state, bool derivatives,
                                     StepBlock<Dim>& block) const {
  const ContactPair<Dim>& pair = contacts_[i];
  const Eigen::Index points = pair.side_1.point_unknowns() + pair.side_2.point_unknowns();
  const Eigen::Index multipliers = pair.side_1.multipliers() + pair.side_2.multipliers();
  constexpr Eigen::Index kFriction = Dimension<Dim>::friction;
  place_bodies({pair.body_1, pair.body_2}, points + kFriction + 2 + multipliers, block);
  block.at.point_1 = block.own;
  block.at.point_2 = block.own + pair.side_1.point_unknowns();
  block.at.friction = block.own + points;
  block.at.normal = block.at.friction + kFriction;
  block.at.slip = block.at.normal + 1;
  block.at.multipliers_1 = block.at.slip + 1;
  block.at.multipliers_2 = block.at.multipliers_1 + pair.side_1.multipliers();
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) state.body[k].column = block.column[k];
  block.f.head(block.own).setZero();
  if (derivatives) {
    differentiate_state(i, state);
    block.j.topLeftCorner(block.size, block.size).setZero();
  }
  contact_rows(pair, prepared_[i], block.at, row_options_, state, block.f, derivatives ? &block.j : nullptr);
}

template <int Dim>
void StepProblem<Dim>::contact_block_by_motion(std::size_t i, StepBlock<Dim>& block,
                                               MotionJacobian<Dim>& motions) const {
  constexpr Eigen::Index kImpulses = Dimension<Dim>::friction + 1;
  block.f.head(block.own).setZero();
  block.j.topLeftCorner(block.own, block.own).setZero();
  block.j.block(block.at.friction, 0, kImpulses, block.own).setZero();
  block.j.block(0, block.at.friction, block.own, kImpulses).setZero();
  block.j.template block<kImpulses, kImpulses>(block.at.friction, block.at.friction).setZero();
  differentiate_state(i, states_[i]);
  load_rows_by_motion(contacts_[i], prepared_[i], block.at, row_options_, states_[i], block.f, block.j,
                      motions);
}

template <int Dim>
std::array<int, 2> StepProblem<Dim>::places(std::size_t i) const {
  return {bodies_.place(contacts_[i].body_1), bodies_.place(contacts_[i].body_2)};
}

template <int Dim>
bool StepProblem<Dim>::is_spurious(const ContactState<Dim>& state) const {
  constexpr double kThrough = 1e-6;  // of L; overlap that no tolerance explains
  return state.side[0].normal.dot(state.frame.normal) > 0 ||
         (row_options_.gap == GapFunction::workspace && state.p <= 0 &&
          state.distance() < -kThrough * row_options_.scale.length);
}

template <int Dim>
void StepProblem<Dim>::joint_block(int i, const Eigen::VectorXd& z, bool derivatives,
                                   StepBlock<Dim>& block) const {
  const JointRows<Dim>& joint = joints_[static_cast<std::size_t>(i)];
  place_bodies(joint.body, joint_row_count(i), block);
  auto body = joint_bodies(joint, z);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) body[k].column = block.column[k];
  block.f.head(block.own).setZero();
  if (derivatives) block.j.topLeftCorner(block.size, block.size).setZero();
  add_joint(joint, body, row_options_.scale, row_options_.h, block.own,
            z.segment(joint_column(i), joint_row_count(i)), block.f, derivatives ? &block.j : nullptr);
}

template <int Dim>
void StepProblem<Dim>::evaluate(const Eigen::VectorXd& z, Eigen::VectorXd& f,
                                Eigen::MatrixXd* jacobian) const {
  if (jacobian != nullptr) jacobian->setZero();
  momentum_rows(z, f, jacobian);
  for (const int j : selected_joints_) {
    const JointRows<Dim>& joint = joints_[static_cast<std::size_t>(j)];
    add_joint(joint, joint_bodies(joint, z), row_options_.scale, row_options_.h, joint_column(j),
              z.segment(joint_column(j), joint_row_count(j)), f, jacobian);
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    evaluate_state(i, z);
    if (jacobian != nullptr) differentiate_state(i, states_[i]);
    contact_rows(contacts_[i], prepared_[i], layout_.contact(i), row_options_, states_[i], f, jacobian);
  }
}

/// Both bodies of a joint at the end of the step, relative to where body a started.
template <int Dim>
std::array<BodyAtEnd<Dim>, 2> StepProblem<Dim>::joint_bodies(const JointRows<Dim>& joint,
                                                             const Eigen::VectorXd& z) const {
  const Vector<Dim>& origin = bodies_.start(joint.body[0]).position;
  std::array<BodyAtEnd<Dim>, 2> bodies;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    bodies_.start_body(joint.body[k], origin, bodies[k]);
    bodies_.move_body(joint.body[k], origin, z, bodies[k]);
    bodies_.differentiate_body(joint.body[k], bodies[k]);
  }
  return bodies;
}

template <int Dim>
JointImpulse<Dim> StepProblem<Dim>::joint_impulse(int i, const Eigen::VectorXd& z) const {
  const JointRows<Dim>& joint = joints_[static_cast<std::size_t>(i)];
  const auto wrenches = joint_wrenches(joint, joint_bodies(joint, z), row_options_.scale,
                                       z.segment(joint_column(i), joint_row_count(i)));
  return {i, wrenches[0], wrenches[1]};
}

template <int Dim>
ContactImpulse<Dim> StepProblem<Dim>::impulse(std::size_t i) const {
  const ContactState<Dim>& state = states_[i];
  const double unit = prepared_[i].mass * row_options_.scale.velocity;
  ContactImpulse<Dim> impulse;
  impulse.body_a = contacts_[i].body_1;
  impulse.body_b = contacts_[i].body_2;
  impulse.point_a = prepared_[i].origin + state.side[0].point;
  impulse.point_b = prepared_[i].origin + state.side[1].point;
  impulse.normal = state.frame.normal;
  impulse.tangents = state.frame.tangents;
  impulse.normal_impulse = unit * state.p;
  impulse.friction_impulse = unit * prepared_[i].semi_axes.cwiseProduct(state.y);
  return impulse;
}

template <int Dim>
std::string StepProblem<Dim>::row_name(Eigen::Index row) const {
  const auto body_name = [this](int body) { return scene_.bodies[static_cast<std::size_t>(body)].name; };
  if (row < layout_.velocity(moving_bodies())) {
    return fmt::format("momentum of {}", body_name(body(static_cast<int>(row / Dimension<Dim>::velocity))));
  }
  for (const int j : selected_joints_) {
    const JointRows<Dim>& joint = joints_[static_cast<std::size_t>(j)];
    if (row < joint_column(j) + joint_row_count(j))
      return fmt::format("joint of {} and {}", body_name(joint.body[0]), body_name(joint.body[1]));
  }
  const auto named = [&](std::size_t i, const char* what) {
    return fmt::format("{} of {} on {}", what, body_name(contacts_[i].body_1),
                       body_name(contacts_[i].body_2));
  };
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ContactLayout& at = layout_.contact(i);
    if (row >= at.point_1 && row < at.friction) return named(i, "closest points");
    if (row >= at.friction && row < at.friction + Dimension<Dim>::friction) return named(i, "friction");
    if (row == at.normal) return named(i, "gap");
    if (row == at.slip) return named(i, "slip speed");
    if (row >= at.multipliers_1 && row < at.multipliers_2 + contacts_[i].side_2.multipliers()) {
      return named(i, "active inequalities");
    }
  }
  return MixedComplementarityProblem::row_name(row);
}

template Scale scene_scale(const Scene<2>&);
template Scale scene_scale(const Scene<3>&);
template class StepProblem<2>;
template class StepProblem<3>;

}  // namespace touchstone
