#include "experiments/problems/frozen_contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/stepper/friction_law.h"

namespace touchstone::problems {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr Index at(std::size_t contact, Index row) { return 3 * static_cast<Index>(contact) + row; }

/// Wrench on body k of contact i per unit of (n, t, o), in units of the first contact's m V.
Eigen::Matrix<double, 6, 3> wrenches(const StepProblem<3>& step, std::size_t i, std::size_t k) {
  const ContactWrenches<3> unit = step.unit_wrenches(i, k) * (step.prepared(0).mass / step.prepared(i).mass);
  Eigen::Matrix<double, 6, 3> ordered;
  ordered << unit.col(3), unit.col(0), unit.col(1);
  return ordered;
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
  FrozenContactProblem problem;
  const auto rows = static_cast<Index>(3 * count);
  problem.w_.setZero(rows, rows);
  problem.q_.setZero(rows);
  problem.mu_.resize(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    if ((step.contacts()[i].law.e_t == 0) || (step.contacts()[i].law.e_o == 0)) return std::nullopt;
    step.find_points(i, z);
    step.evaluate_state(i, z);
    problem.mu_[static_cast<Index>(i)] = step.contacts()[i].law.mu;
  }
  const double speed = step.scale().velocity;
  const double unit = step.prepared(0).mass * speed * speed;
  for (std::size_t i = 0; i < count; ++i) {
    problem.q_[at(i, 0)] = step.separation(i) / step.step_size() / speed;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      const int place = step.places(i)[k];
      if (place < 0) continue;
      const Eigen::Matrix<double, 6, 3> own = wrenches(step, i, k);
      problem.q_.segment<3>(at(i, 0)) += own.transpose() * step.free_velocity_of(place) / unit;
      for (std::size_t j = 0; j < count; ++j) {
        for (const std::size_t l : {std::size_t{0}, std::size_t{1}}) {
          if (step.places(j)[l] != place) continue;
          problem.w_.block<3, 3>(at(i, 0), at(j, 0)) +=
              own.transpose() * inverse_mass(step, place) * wrenches(step, j, l) / unit;
        }
      }
    }
  }
  problem.rho_ = 1.0 / problem.w_.diagonal().maxCoeff();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  problem.lower_.setConstant(kUnknowns * static_cast<Index>(count), -infinity);
  problem.upper_.setConstant(problem.lower_.size(), infinity);
  for (std::size_t i = 0; i < count; ++i) problem.lower_[kUnknowns * static_cast<Index>(i) + kNormal] = 0;
  return problem;
}

VectorXd FrozenContactProblem::reactions_of(const VectorXd& z) const {
  VectorXd r(w_.rows());
  for (Index i = 0; i < mu_.size(); ++i) {
    r[3 * i] = z[kUnknowns * i + kNormal];
    r.segment<2>(3 * i + 1) = z.segment<2>(kUnknowns * i);
  }
  return r;
}

VectorXd FrozenContactProblem::point_of(const VectorXd& reactions) const {
  const VectorXd u = w_ * reactions + q_;
  VectorXd z = VectorXd::Zero(size());
  for (Index i = 0; i < mu_.size(); ++i) {
    z.segment<2>(kUnknowns * i) = reactions.segment<2>(3 * i + 1);
    z[kUnknowns * i + kNormal] = reactions[3 * i];
    z[kUnknowns * i + kNormal + 1] = u.segment<2>(3 * i + 1).norm();
  }
  return z;
}

void FrozenContactProblem::evaluate(const VectorXd& z, VectorXd& f, MatrixXd* jacobian) const {
  const VectorXd u = w_ * reactions_of(z) + q_;
  if (jacobian != nullptr) jacobian->setZero();
  for (Index i = 0; i < mu_.size(); ++i) {
    const Index own = kUnknowns * i;
    const FrictionVector<3> w(u[3 * i + 1], u[3 * i + 2], 0.0);
    const FrictionRows<3> rows =
        friction_rows<3>(FrictionForm::projection, mu_[i], rho_, FrictionVector<3>(1, 1, 0),
                         z.segment<3>(own), w, z[own + kNormal], z[own + kNormal + 1]);
    f.segment<3>(own) = rows.value;
    f[own + kNormal] = u[3 * i];
    f[own + kNormal + 1] = rows.slip_value;
    if (jacobian == nullptr) continue;
    for (Index j = 0; j < mu_.size(); ++j) {
      // Columns n, t, o of the other contact's reactions, and where they stand in z.
      const Index to[] = {kUnknowns * j + kNormal, kUnknowns * j, kUnknowns * j + 1};
      for (Index c = 0; c < 3; ++c) {
        const FrictionVector<3> dw(w_(3 * i + 1, 3 * j + c), w_(3 * i + 2, 3 * j + c), 0.0);
        jacobian->col(to[c]).segment<3>(own) += rows.d_w * dw;
        (*jacobian)(own + kNormal, to[c]) += w_(3 * i, 3 * j + c);
        (*jacobian)(own + kNormal + 1, to[c]) += rows.slip_d_w.dot(dw);
      }
    }
    jacobian->block<3, 3>(own, own) += rows.d_y;
    jacobian->col(own + kNormal).segment<3>(own) += rows.d_p;
    jacobian->col(own + kNormal + 1).segment<3>(own) += rows.d_s;
    jacobian->row(own + kNormal + 1).segment<3>(own) += rows.slip_d_y;
    (*jacobian)(own + kNormal + 1, own + kNormal) += rows.slip_d_p;
    (*jacobian)(own + kNormal + 1, own + kNormal + 1) += rows.slip_d_s;
  }
}

}  // namespace touchstone::problems
