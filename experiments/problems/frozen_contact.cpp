#include "experiments/problems/frozen_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace touchstone::problems {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index at(std::size_t contact, Index row) { return 3 * static_cast<Index>(contact) + row; }

/// Wrench on body k of contact i per unit of (n, t, o), in units of the first contact's m V.
Eigen::Matrix<double, 6, 3> wrenches(const StepProblem<3>& step, std::size_t i, std::size_t k) {
  const PreparedContact<3>& contact = step.prepared(i);
  const ContactState<3>& state = step.state(i);
  const double unit = (k == 0 ? 1 : -1) * contact.mass * step.scale().velocity;  // [N s] per unit of z
  const auto column = [&](double size, const Vector<3>& direction) {
    return wrench<3>(size * direction, state.side[k].arm);
  };
  Eigen::Matrix<double, 6, 3> all;
  all << column(unit, state.frame.normal), column(unit * contact.semi_axes[0], state.frame.tangents.col(0)),
      column(unit * contact.semi_axes[1], state.frame.tangents.col(1));
  return all * (step.prepared(0).mass / contact.mass);
}

MotionMatrix<3> inverse_mass(const StepProblem<3>& step, int place) {
  const Twist<3> scale = step.momentum_scale(place);
  const MotionMatrix<3> mass = scale.cwiseInverse().asDiagonal() * step.momentum_matrix(place);
  return mass.inverse();
}

}  // namespace

std::optional<FrozenContactProblem> FrozenContactProblem::from(StepProblem<3> step) {
  const std::size_t count = step.contacts().size();
  if (count == 0 || !step.joints().empty()) return std::nullopt;
  VectorXd z = VectorXd::Zero(step.size());  // at rest, so that the end of the step is its start
  const auto rows = static_cast<Index>(3 * count);
  MatrixXd w = MatrixXd::Zero(rows, rows);
  VectorXd q = VectorXd::Zero(rows);
  VectorXd mu(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    if ((step.contacts()[i].law.e_t == 0) || (step.contacts()[i].law.e_o == 0)) return std::nullopt;
    step.find_points(i, z);
    step.evaluate_state(i, z);
    mu[static_cast<Index>(i)] = step.contacts()[i].law.mu;
  }
  const double speed = step.scale().velocity;
  const double unit = step.prepared(0).mass * speed * speed;
  for (std::size_t i = 0; i < count; ++i) {
    q[at(i, 0)] = step.separation(i) / step.step_size() / speed;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const int place = step.places(i)[k];
      if (place < 0) continue;
      const Eigen::Matrix<double, 6, 3> own = wrenches(step, i, k);
      q.segment<3>(at(i, 0)) += own.transpose() * step.free_velocity_of(place) / unit;
      for (std::size_t j = 0; j < count; ++j) {
        for (const std::size_t l : {std::size_t{0}, std::size_t{1}}) {
          if (step.places(j)[l] != place) continue;
          w.block<3, 3>(at(i, 0), at(j, 0)) +=
              own.transpose() * inverse_mass(step, place) * wrenches(step, j, l) / unit;
        }
      }
    }
  }
  return FrozenContactProblem(std::move(w), std::move(q), std::move(mu));
}

FrozenContactProblem::FrozenContactProblem(MatrixXd w, VectorXd q, VectorXd mu)
    : w_(std::move(w)), q_(std::move(q)), mu_(std::move(mu)) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  lower_.setConstant(q_.size(), -infinity);
  upper_.setConstant(q_.size(), infinity);
  for (Index i = 0; i < mu_.size(); ++i) lower_[3 * i] = 0;
  if (q_.size() > 0) rho_ = 1.0 / w_.diagonal().maxCoeff();
}

void FrozenContactProblem::evaluate(const VectorXd& z, VectorXd& f, MatrixXd* jacobian) const {
  f = q_;
  f.noalias() += w_ * z;
  if (jacobian != nullptr) *jacobian = w_;
  for (Index i = 0; i < mu_.size(); ++i) friction_rows(i, z, f, jacobian);
}

/// Turns the rows t and o of a contact from u_t into r_t - proj(r_t - rho u_t); likewise in the Jacobian.
void FrozenContactProblem::friction_rows(Index contact, const VectorXd& r, VectorXd& f,
                                         MatrixXd* jacobian) const {
  const Index n = 3 * contact, t = n + 1;
  const Eigen::Vector2d friction = r.segment<2>(t);
  const Eigen::Vector2d target = friction - rho_ * f.segment<2>(t);
  const double radius = mu_[contact] * std::max(r[n], 0.0);
  const double length = target.norm();
  const bool sticks = length <= radius;
  f.segment<2>(t) =
      sticks ? Eigen::Vector2d(friction - target) : Eigen::Vector2d(friction - target * (radius / length));
  if (jacobian == nullptr) return;
  auto rows = jacobian->middleRows<2>(t);
  // d proj / d target: the identity inside the disc; outside the radius over the length, across the target.
  Eigen::Matrix2d slope = Eigen::Matrix2d::Identity();
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  if (!sticks) {
    direction = target / length;
    slope = (radius / length) * (Eigen::Matrix2d::Identity() - direction * direction.transpose());
  }
  for (Index j = 0; j < rows.cols(); ++j) rows.col(j) = Eigen::Vector2d(rho_ * (slope * rows.col(j)));
  rows.middleCols<2>(t) += Eigen::Matrix2d::Identity() - slope;
  if (!sticks && r[n] > 0) rows.col(n) -= mu_[contact] * direction;
}

}  // namespace touchstone::problems
