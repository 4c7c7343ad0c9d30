#include "core/stepper/step_bodies.h"

#include <algorithm>

namespace touchstone {

namespace {

/// p_vp = -h omega x (I omega), the gyroscopic impulse; none in the plane.
Angular<2> gyroscopic(const Angular<2>&, const Inertia<2>&) { return Angular<2>(0.0); }
Angular<3> gyroscopic(const Angular<3>& omega, const Inertia<3>& inertia) {
  return -omega.cross(Vector<3>(inertia * omega));
}

}  // namespace

template <int Dim>
StepBodies<Dim>::StepBodies(const Scene<Dim>& scene)
    : scene_(scene),
      inertial_(scene.bodies.size()),
      fixed_(scene.bodies.size()),
      place_(scene.bodies.size(), -1),
      moving_(scene.bodies.size()) {
  selected_.reserve(scene.bodies.size());
  std::transform(scene.bodies.begin(), scene.bodies.end(), fixed_.begin(),
                 [](const Body<Dim>& body) { return static_cast<char>(body.fixed); });
}

template <int Dim>
void StepBodies<Dim>::begin(std::span<const BodyState<Dim>> state, double h, const Scale& scale) {
  h_ = h;
  start_.assign(state.begin(), state.end());
  for (std::size_t body = 0; body < start_.size(); ++body) {
    if (is_fixed(body)) continue;
    prepare(body, scale);
    moving_[body] = {};
    moving_[body].position = start_[body].pose.position;
    moving_[body].row_scale = inertial_[body].row_scale;
  }
}

template <int Dim>
void StepBodies<Dim>::prepare(std::size_t body, const Scale& scale) {
  const Body<Dim>& given = scene_.bodies[body];
  const BodyState<Dim>& state = start_[body];
  Inertial& inertial = inertial_[body];
  inertial.mass = given.mass;
  inertial.inertia = world_inertia(given.inertia, state.pose.rotation);
  const Angular<Dim> omega = state.velocity.template tail<kAngular>();
  inertial.momentum.template head<Dim>() =
      given.mass * state.velocity.template head<Dim>() + h_ * (given.mass * scene_.gravity + given.force);
  inertial.momentum.template tail<kAngular>() =
      inertial.inertia * omega + h_ * gyroscopic(omega, inertial.inertia);
  const double gyration = std::sqrt(given.inertia.trace() / (kAngular * given.mass));
  inertial.row_scale.setConstant(1 / (given.mass * scale.velocity));
  inertial.row_scale.template tail<kAngular>() /= gyration;
}

template <int Dim>
void StepBodies<Dim>::select(std::span<const int> bodies) {
  selected_.assign(bodies.begin(), bodies.end());
  for (int place = 0; place < count(); ++place)
    place_[static_cast<std::size_t>(selected_[static_cast<std::size_t>(place)])] = place;
}

template <int Dim>
std::vector<int> StepBodies<Dim>::all_moving() const {
  std::vector<int> moving;
  for (std::size_t body = 0; body < scene_.bodies.size(); ++body) {
    if (!is_fixed(body)) moving.push_back(static_cast<int>(body));
  }
  return moving;
}

template <int Dim>
double StepBodies<Dim>::lighter_mass(int body_1, int body_2) const {
  double mass = std::numeric_limits<double>::infinity();
  for (const int index : {body_1, body_2}) {
    const Body<Dim>& body = scene_.bodies[static_cast<std::size_t>(index)];
    if (!body.fixed) mass = std::min(mass, body.mass);
  }
  return mass;
}

template <int Dim>
Twist<Dim> StepBodies<Dim>::momentum_row(int place, const Eigen::VectorXd& z) const {
  const Inertial& body = inertial(place);
  const Eigen::Index at = kVelocity * place;
  Twist<Dim> momentum = -body.momentum;
  momentum.template head<Dim>() += body.mass * z.template segment<Dim>(at);
  momentum.template tail<kAngular>() += body.inertia * z.template segment<kAngular>(at + Dim);
  return body.row_scale.cwiseProduct(momentum);
}

template <int Dim>
MotionMatrix<Dim> StepBodies<Dim>::momentum_matrix(int place) const {
  const Inertial& body = inertial(place);
  MotionMatrix<Dim> matrix = MotionMatrix<Dim>::Zero();
  matrix.diagonal().template head<Dim>().setConstant(body.row_scale[0] * body.mass);
  matrix.template bottomRightCorner<kAngular, kAngular>() = body.row_scale[Dim] * body.inertia;
  return matrix;
}

template <int Dim>
Twist<Dim> StepBodies<Dim>::free_velocity(int place) const {
  const Inertial& body = inertial(place);
  Twist<Dim> nu;
  nu.template head<Dim>() = body.momentum.template head<Dim>() / body.mass;
  nu.template tail<kAngular>() = body.inertia.inverse() * body.momentum.template tail<kAngular>();
  return nu;
}

template <int Dim>
auto StepBodies<Dim>::turned(std::size_t body, const Angular<Dim>& omega) const -> Moving& {
  Moving& turned = moving_[body];
  if (turned.omega != omega) {
    turned.omega = omega;
    turned.rotation = start_[body].pose.rotation.turned(h_ * omega);
    turned.has_jacobian = false;
  }
  return turned;
}

template <int Dim>
void StepBodies<Dim>::start_body(int body, const Vector<Dim>& origin, BodyAtEnd<Dim>& end) const {
  const auto index = static_cast<std::size_t>(body);
  end = {};
  end.pose = start_[index].pose;
  end.pose.position -= origin;
  if (!is_fixed(index)) end.row_scale = inertial_[index].row_scale;
}

template <int Dim>
void StepBodies<Dim>::move_body(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z,
                                BodyAtEnd<Dim>& end) const {
  const auto index = static_cast<std::size_t>(body);
  if (is_fixed(index)) return;
  end.column = kVelocity * place_[index];
  end.nu = z.template segment<kVelocity>(end.column);
  end.pose.position = position(body, origin, z);
  end.pose.rotation = turned(index, end.nu.template tail<kAngular>()).rotation;
}

template <int Dim>
void StepBodies<Dim>::place_body(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z,
                                 BodyAtEnd<Dim>& end) const {
  const auto index = static_cast<std::size_t>(body);
  if (is_fixed(index)) {
    start_body(body, origin, end);
  } else {
    end.row_scale = moving_[index].row_scale;
    move_body(body, origin, z, end);
  }
}

template <int Dim>
void StepBodies<Dim>::differentiate_body(int body, BodyAtEnd<Dim>& end) const {
  const auto index = static_cast<std::size_t>(body);
  if (is_fixed(index)) return;
  const Angular<Dim> omega = end.nu.template tail<kAngular>();
  Moving& turned = this->turned(index, omega);
  if (!turned.has_jacobian) {
    turned.jacobian = turn_jacobian(omega, h_);
    turned.has_jacobian = true;
  }
  end.turn = turned.jacobian;
}

template <int Dim>
Pose<Dim> StepBodies<Dim>::pose(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z) const {
  const auto index = static_cast<std::size_t>(body);
  if (is_fixed(index)) return {position(body, origin, z), start_[index].pose.rotation};
  const Angular<Dim> omega = z.template segment<kAngular>(kVelocity * place_[index] + Dim);
  return {position(body, origin, z), turned(index, omega).rotation};
}

template <int Dim>
Vector<Dim> StepBodies<Dim>::position(int body, const Vector<Dim>& origin, const Eigen::VectorXd& z) const {
  const auto index = static_cast<std::size_t>(body);
  if (is_fixed(index)) return start_[index].pose.position - origin;
  return moving_[index].position - origin + h_ * z.template segment<Dim>(kVelocity * place_[index]);
}

template <int Dim>
void StepBodies<Dim>::advance(const Eigen::VectorXd& z, std::span<BodyState<Dim>> state) const {
  for (int place = 0; place < count(); ++place) {
    const auto index = static_cast<std::size_t>(selected_[static_cast<std::size_t>(place)]);
    state[index].velocity = z.template segment<kVelocity>(kVelocity * place);
    state[index].pose = advanced(start_[index].pose, state[index].velocity, h_);
  }
}

template class StepBodies<2>;
template class StepBodies<3>;

}  // namespace touchstone
