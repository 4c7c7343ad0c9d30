#pragma once

#include <Eigen/Core>
#include <span>

#include "core/stepper/step_problem.h"
#include "core/stepper/warm_start.h"

/// From solutions to memory and back: where a step's search starts.
namespace touchstone {

/// What solution z says of contact i of the problem, which was evaluated there last (evaluate_state()).
/// @param normal  of the contact there
template <int Dim>
void keep_contact(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z,
                  const Vector<Dim>& normal, ContactSolution<Dim>& memory);

/// Writes velocities, closest points, multipliers and impulses of contacts; joints are left alone. Contacts
/// that were there in the last step start where the last steps lead, and so do velocities; where one is new
/// the velocities are those of a free step and the new contact's points the closest ones of the pose that
/// these lead to. Frames are those of the last normals.
/// @param memory     matched with the step's contacts
/// @param contacts   numbers there of the problem's contacts, one each
/// @param max_depth  of the extrapolation, 1 to WarmStart<Dim>::kDepth; 1: the last solution
/// @param z          at least problem.size() entries, 0 but for joints
template <int Dim>
void start_from(WarmStart<Dim>& memory, std::span<const std::size_t> contacts, int max_depth,
                StepProblem<Dim>& problem, Eigen::VectorXd& z);

}  // namespace touchstone
