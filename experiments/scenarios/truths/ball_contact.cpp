#include "experiments/scenarios/truths/ball_contact.h"

#include <cmath>

namespace touchstone::truth::ball {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  return (Eigen::Matrix3d() << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0).finished();
}

Surface surface(const Eigen::Vector3d& vector, double about_normal) {
  return {vector.x(), vector.y(), vector.z(), about_normal};
}

Twist accelerated(const SphereOnSpheres& scene, const Twist& wrench) {
  Twist rate;
  rate << wrench.head<3>() / scene.mass, wrench.tail<3>() / scene.inertia;
  return rate;
}

Twist applied_wrench(const SphereOnSpheres& scene) {
  Twist wrench = Twist::Zero();
  wrench.head<3>() = scene.force;
  return wrench;
}

/// Bound of the eigenvalues of E J M^-1 J^T E, the scaled slip acceleration for a unit scaled friction force.
double largest_response(const SphereOnSpheres& scene) {
  return scene.e_slip * scene.e_slip * (1.0 / scene.mass + scene.radius * scene.radius / scene.inertia) +
         scene.e_r * scene.e_r / scene.inertia;
}

/// The linear equations of one contact: constraint rows * rate + offset = 0, wrench = columns * unknowns.
struct Block {
  static constexpr int max_rows = 4;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, max_rows, 6>;
  Rows rows;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_rows, 1> offset;
  Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, max_rows> force;  ///< Surface force for unit unknowns
};

Block block_of(const SphereOnSpheres& scene, const Contact& contact, const ContactState& state) {
  Block block;
  if (state.mode == BallContactMode::sticking) {
    block.rows = contact.jacobian;
    block.offset = contact.drift;
    block.force = Eigen::Matrix4d::Identity();
    return block;
  }
  const int count = state.mode == BallContactMode::sliding ? 1 : 0;
  block.rows.resize(count, 6);
  block.offset.resize(count);
  block.force.resize(4, count);
  if (count == 0) return block;
  block.rows.setZero();
  block.rows.leftCols<3>() = contact.normal.transpose();
  block.offset[0] = contact.normal_drift;
  const Surface w = contact.scaled_velocity(contact.slip);
  const double sigma = w.norm();
  const Surface direction = sigma > 0.0 && !state.prescribed ? Surface(w / sigma) : state.direction;
  block.force.col(0) = surface(contact.normal, 0.0) - scene.mu * contact.friction(direction);
  return block;
}

}  // namespace

Contact::Contact(const SphereOnSpheres& scene, const FixedBall& support, const Motion& motion)
    : e_slip_(scene.e_slip), e_r_(scene.e_r) {
  const Eigen::Vector3d offset = motion.x - support.center;
  const double distance = offset.norm();
  normal = offset / distance;
  gap = distance - support.radius - scene.radius;
  const Eigen::Vector3d normal_rate = (motion.v - normal * normal.dot(motion.v)) / distance;
  jacobian.setZero();
  jacobian.topLeftCorner<3, 3>().setIdentity();
  jacobian.topRightCorner<3, 3>() = scene.radius * cross_matrix(normal);  // v_c = v - radius omega x n
  jacobian.bottomRightCorner<1, 3>() = normal.transpose();
  drift = surface(-scene.radius * motion.omega.cross(normal_rate), motion.omega.dot(normal_rate));
  normal_drift = normal_rate.dot(motion.v);
  slip = tangential(surface(motion.v - scene.radius * motion.omega.cross(normal), motion.omega.dot(normal)));
}

Surface Contact::tangential(const Surface& s) const {
  const Eigen::Vector3d vector = s.head<3>();
  return surface(vector - normal * normal.dot(vector), s[3]);
}

Surface Contact::scaled_velocity(const Surface& velocity) const { return friction(velocity); }

Surface Contact::scaled_force(const Surface& force) const {
  const Surface t = tangential(force);
  return surface(t.head<3>() / e_slip_, t[3] / e_r_);
}

Surface Contact::friction(const Surface& y) const {
  const Surface t = tangential(y);
  return surface(e_slip_ * t.head<3>(), e_r_ * t[3]);
}

std::array<Contact, 2> contacts_of(const SphereOnSpheres& scene, const Motion& motion) {
  return {Contact(scene, scene.supports[0], motion), Contact(scene, scene.supports[1], motion)};
}

Dynamics dynamics(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts,
                  const ContactStates& states) {
  const std::array<Block, 2> blocks{block_of(scene, contacts[0], states[0]),
                                    block_of(scene, contacts[1], states[1])};
  const Eigen::Index split = blocks[0].rows.rows();
  const Eigen::Index size = split + blocks[1].rows.rows();
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 8, 6> rows(size, 6);
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 8> wrench(6, size);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> offset(size);
  rows << blocks[0].rows, blocks[1].rows;
  offset << blocks[0].offset, blocks[1].offset;
  wrench << contacts[0].jacobian.transpose() * blocks[0].force,
      contacts[1].jacobian.transpose() * blocks[1].force;

  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 8> response = wrench;
  response.topRows<3>() /= scene.mass;
  response.bottomRows<3>() /= scene.inertia;
  const Twist free = accelerated(scene, applied_wrench(scene));
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> unknowns(size);
  if (size > 0) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8> matrix = rows * response;
    unknowns = matrix.fullPivLu().solve(-(rows * free + offset));
  }
  Dynamics result;
  result.rate = free + response * unknowns;
  result.force[0] = blocks[0].force * unknowns.head(split);
  result.force[1] = blocks[1].force * unknowns.tail(size - split);
  return result;
}

Surface growing_slip_direction(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts,
                               ContactStates states, std::size_t index) {
  const Contact& contact = contacts[index];
  ContactState& state = states[index];
  state.prescribed = true;
  for (int iteration = 0; iteration < 100'000; ++iteration) {
    const Dynamics now = dynamics(scene, contacts, states);
    const Surface slip_rate = contact.jacobian * now.rate + contact.drift;
    const double limit = scene.mu * contact.normal.dot(now.force[index].head<3>());
    const Surface push = contact.scaled_velocity(slip_rate) / (limit * largest_response(scene));
    const Surface next = (state.direction + push).normalized();
    const double change = (next - state.direction).norm();
    state.direction = next;
    if (change < 1e-15) break;
  }
  return state.direction;
}

bool start_states(const SphereOnSpheres& scene, const std::array<Contact, 2>& contacts, ContactStates& states,
                  const std::array<Surface, 2>& start) {
  std::array<double, 2> normal_force{0.0, 0.0};
  std::array<Surface, 2> y{contacts[0].tangential(start[0]), contacts[1].tangential(start[1])};
  const double rho = 1.0 / largest_response(scene);
  const auto total_wrench = [&] {
    Twist wrench = applied_wrench(scene);
    for (std::size_t i = 0; i < 2; ++i) {
      const Surface force = surface(normal_force[i] * contacts[i].normal, 0.0) + contacts[i].friction(y[i]);
      wrench += contacts[i].jacobian.transpose() * force;
    }
    return wrench;
  };
  double change = 1.0;
  for (int sweep = 0; sweep < 200'000 && change > 1e-15 * scene.force.norm(); ++sweep) {
    change = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double before = normal_force[i];
      const double approach = contacts[i].normal.dot(accelerated(scene, total_wrench()).head<3>());
      normal_force[i] = std::max(0.0, before - scene.mass * approach);
      const Surface slip_rate = contacts[i].jacobian * accelerated(scene, total_wrench());
      Surface next = y[i] - rho * contacts[i].scaled_velocity(slip_rate);
      const double limit = scene.mu * normal_force[i];
      if (next.norm() > limit) next *= limit / next.norm();
      change = std::max({change, std::abs(normal_force[i] - before), (next - y[i]).norm()});
      y[i] = next;
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const bool open = normal_force[i] == 0.0;
    const bool inside = y[i].norm() < scene.mu * normal_force[i] * (1.0 - 1e-9);
    states[i].mode =
        open ? BallContactMode::apart : (inside ? BallContactMode::sticking : BallContactMode::sliding);
    states[i].direction = y[i].norm() > 0.0 ? Surface(-y[i].normalized()) : Surface::Zero();
  }
  return change <= 1e-15 * scene.force.norm();
}

}  // namespace touchstone::truth::ball
