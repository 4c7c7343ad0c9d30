#include "core/stepper/step_start.h"

#include <algorithm>

namespace touchstone {

namespace {

template <int Dim>
void recall_contact(const ContactSolution<Dim>& memory, std::size_t i, StepProblem<Dim>& problem,
                    Eigen::VectorXd& z) {
  const ContactLayout& at = problem.layout().contact(i);
  const Vector<Dim> center = problem.body_1_position(i, z);
  problem.set_normal_estimate(i, memory.normal);
  problem.set_points(i, center + memory.a_1, center + memory.a_2, z);
  z.template segment<Dimension<Dim>::friction>(at.friction) = memory.y;
  z[at.normal] = memory.p;
  z[at.slip] = memory.s;
  std::copy(memory.multipliers.begin(), memory.multipliers.end(), z.data() + at.multipliers_1);
}

}  // namespace

template <int Dim>
void keep_contact(const StepProblem<Dim>& problem, std::size_t i, const Eigen::VectorXd& z,
                  const Vector<Dim>& normal, ContactSolution<Dim>& memory) {
  const ContactLayout& at = problem.layout().contact(i);
  const ContactPair<Dim>& pair = problem.contacts()[i];
  const Vector<Dim> center = problem.body_1_position(i, z);
  memory.normal = normal;
  memory.a_1 = problem.point(i, 0) - center;
  memory.a_2 = problem.point(i, 1) - center;
  memory.y = z.template segment<Dimension<Dim>::friction>(at.friction);
  memory.p = z[at.normal];
  memory.s = z[at.slip];
  const auto multipliers = pair.side_1.multipliers() + pair.side_2.multipliers();
  memory.multipliers.assign(z.data() + at.multipliers_1, z.data() + at.multipliers_1 + multipliers);
}

template <int Dim>
void start_from(WarmStart<Dim>& memory, std::span<const std::size_t> contacts, int max_depth,
                StepProblem<Dim>& problem, Eigen::VectorXd& z) {
  const int depth = std::min(max_depth, memory.depth(problem.bodies(), contacts));
  const bool constrained = !contacts.empty() || !problem.joints().empty();
  if (depth > 0 && constrained) {
    for (int place = 0; place < problem.moving_bodies(); ++place) {
      z.template segment<Dimension<Dim>::velocity>(problem.layout().velocity(place)) =
          memory.velocity(problem.body(place), depth);
    }
  } else {
    problem.free_velocity(z);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (memory.knows(contacts[i])) {
      recall_contact(memory.contact(contacts[i], depth), i, problem, z);
    } else {
      problem.find_points(i, z);
    }
  }
}

template void keep_contact(const StepProblem<2>&, std::size_t, const Eigen::VectorXd&, const Vector<2>&,
                           ContactSolution<2>&);
template void keep_contact(const StepProblem<3>&, std::size_t, const Eigen::VectorXd&, const Vector<3>&,
                           ContactSolution<3>&);
template void start_from(WarmStart<2>&, std::span<const std::size_t>, int, StepProblem<2>&, Eigen::VectorXd&);
template void start_from(WarmStart<3>&, std::span<const std::size_t>, int, StepProblem<3>&, Eigen::VectorXd&);

}  // namespace touchstone
