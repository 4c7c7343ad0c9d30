#pragma once

#include <Eigen/LU>
#include <algorithm>

#include "core/stepper/step_problem.h"

/// What sweeps over contacts (contact_sweeps.h, accelerated_sweeps.h) have in common.
namespace touchstone {

/// How a body's velocity answers to impulses; not at all as it stands, as that of a fixed body.
template <int Dim>
struct BodyResponse {
  static constexpr int kAngular = Dimension<Dim>::angular;
  double inverse_mass = 0.0;  ///< [1/kg]
  Eigen::Matrix<double, kAngular, kAngular> inverse_inertia =
      Eigen::Matrix<double, kAngular, kAngular>::Zero();  ///< world axes [1/(kg m^2)]
};

/// @param place  of a moving body of the problem's island
template <int Dim>
BodyResponse<Dim> body_response(const StepProblem<Dim>& problem, int place) {
  constexpr int kAngular = Dimension<Dim>::angular;
  const MotionMatrix<Dim> matrix = problem.momentum_matrix(place);
  const Twist<Dim>& scale = problem.momentum_scale(place);
  return {scale[0] / matrix(0, 0),
          scale[Dim] * matrix.template bottomRightCorner<kAngular, kAngular>().inverse()};
}

/// By how much a sweep changes the impulses of a contact for what is missing in its rows, in the problem's
/// units.
struct SweepSteps {
  double normal = 0.0;    ///< p per [m/s]: Newton's
  double friction = 0.0;  ///< y per [m/s]: by the largest of the slips that a unit of y leads to
};

/// Steps of contact i of the problem, as it is evaluated in `state`.
/// @param bodies  how its two bodies answer
template <int Dim>
SweepSteps sweep_steps(const StepProblem<Dim>& problem, std::size_t i, const ContactState<Dim>& state,
                       const std::array<BodyResponse<Dim>, 2>& bodies) {
  constexpr int kTangent = Dimension<Dim>::tangent;
  const PreparedContact<Dim>& prepared = problem.prepared(i);
  const Vector<Dim>& normal = state.frame.normal;
  // How velocities answer to an impulse at the contact and to a moment about its normal.
  Matrix<Dim> response = Matrix<Dim>::Zero();
  double turn = 0;
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const auto arm = lever(state.side[k].arm);
    response.diagonal().array() += bodies[k].inverse_mass;
    response += arm * bodies[k].inverse_inertia * arm.transpose();
    if constexpr (Dim == 3) turn += normal.dot(bodies[k].inverse_inertia * normal);
  }
  const auto semi_axes = prepared.semi_axes.template head<kTangent>().asDiagonal();
  const Eigen::Matrix<double, kTangent, kTangent> along =
      semi_axes * (state.frame.tangents.transpose() * response * state.frame.tangents) * semi_axes;
  double largest = along.cwiseAbs().rowwise().sum().maxCoeff();
  if constexpr (Dim == 3) largest = std::max(largest, prepared.semi_axes[2] * prepared.semi_axes[2] * turn);
  const double unit = prepared.mass * problem.scale().velocity;
  return {1 / (unit * normal.dot(response * normal)), largest > 0 ? 1 / (unit * largest) : 0.0};
}

}  // namespace touchstone
