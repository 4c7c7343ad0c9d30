#pragma once

#include <optional>
#include <vector>

#include "core/stepper/step_problem.h"

namespace touchstone {

/// Why impulses grow without bound on the central path of a step's problem.
///
/// Impulses lambda_i != 0 of contacts that put no wrench on any moving body, sum W_i lambda_i = 0, are a
/// self-stress. If each is in the interior of its friction cone the contacts wedge: any multiple of lambda
/// can be added to impulses that stick, and no row of the step's problem but these contacts' own cones sees
/// it. For all nu' then lambda . W^T nu' = 0, so that the closing and slip velocities of these contacts are
/// dependent: their rows (gap closed, slip 0) are one more than what motion and impulses, less that multiple,
/// can satisfy. The step is therefore solved with the rows relaxed along lambda,
///   psi_i / h = -s lambda_n,i,   w_i = -s lambda_t,i,
/// with s one more unknown and the multiple of lambda given. If s != 0, and is the same whatever the
/// multiple, then no impulses, however large, make the contacts close and stick: s is the drift that they
/// cannot close. It comes from the turn of normals and closest points within the step. With s > 0 a body
/// would have to go deeper into the wedge, with s < 0 it could come out of it by opening a contact.
struct Wedge {
  std::vector<std::size_t> contacts;  ///< of the problem, that carry the self-stress
  double epsilon = 0.0;               ///< where the path runs off
  double impulse = 0.0;               ///< largest normal impulse there, in m V
  // At the solution of the relaxed step:
  double residual = 0.0;     ///< of all its rows
  double imbalance = 0.0;    ///< |sum of W lambda| of the body where it is largest, over sum of |W lambda|
  double use_of_cone = 0.0;  ///< largest |E^-1 lambda_t| / (mu lambda_n): < 1 in the interior
  /// sum of lambda_n psi / h + lambda_t . v_t over sum of lambda_n, over V: -s in these units.
  double drift = 0.0;
  double drift_change = 0.0;  ///< of the drift, for ten times the multiple of lambda
};

/// Follows central paths until one runs off to infinity. @return nothing if none does
/// @param problem  see SmoothedStep::begin()
/// @param end      the point where the path was left
template <int Dim>
std::optional<Wedge> find_wedge(StepProblem<Dim>& problem, Eigen::VectorXd& end);

}  // namespace touchstone
