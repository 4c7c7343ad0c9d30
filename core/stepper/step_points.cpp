// Closest points in the unknowns of StepProblem, as they are found from cold or given.
#include "core/contact/closest_multipliers.h"
#include "core/stepper/step_problem.h"

namespace touchstone {

template <int Dim>
void StepProblem<Dim>::set_points(std::size_t i, const Vector<Dim>& a_1, const Vector<Dim>& a_2,
                                  Eigen::VectorXd& z) const {
  std::array<Pose<Dim>, 2> pose;  // of planes, which only are asked for
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const Side<Dim>& side = k == 0 ? contacts_[i].side_1 : contacts_[i].side_2;
    const int body = k == 0 ? contacts_[i].body_1 : contacts_[i].body_2;
    if (side.kind == SideKind::plane) pose[k] = bodies_.pose(body, prepared_[i].origin, z);
  }
  set_points(i, pose, a_1, a_2, z);
}

/// @param pose  of its bodies, which z leads to
template <int Dim>
void StepProblem<Dim>::set_points(std::size_t i, const std::array<Pose<Dim>, 2>& pose, const Vector<Dim>& a_1,
                                  const Vector<Dim>& a_2, Eigen::VectorXd& z) const {
  const ContactPair<Dim>& pair = contacts_[i];
  const ContactLayout& at = layout_.contact(i);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const bool first = k == 0;
    const Side<Dim>& side = first ? pair.side_1 : pair.side_2;
    const Eigen::Index column = first ? at.point_1 : at.point_2;
    const Vector<Dim>& relative = first ? a_1 : a_2;
    if (side.kind == SideKind::plane) {
      const PlaneAtStart<Dim>& plane = prepared_[i].plane[k];
      const PlaneChart<Dim> chart = pose[k].rotation.matrix() * plane.basis;
      z.template segment<Dim - 1>(column) = chart.transpose() * (relative - plane.moved_foot(pose[k]));
    } else {
      z.template segment<Dim>(column) = relative;
    }
  }
}

template <int Dim>
std::array<Pose<Dim>, 2> StepProblem<Dim>::poses(std::size_t i, const Eigen::VectorXd& z) const {
  const Vector<Dim>& origin = prepared_[i].origin;
  return {bodies_.pose(contacts_[i].body_1, origin, z), bodies_.pose(contacts_[i].body_2, origin, z)};
}

template <int Dim>
void StepProblem<Dim>::find_points(std::size_t i, Eigen::VectorXd& z, FindClosest<Dim> find) {
  place_points(i, poses(i, z), find, z);
}

template <int Dim>
void StepProblem<Dim>::evaluate_anew(std::size_t i, Eigen::VectorXd& z, ContactState<Dim>& state) {
  place_state(i, z, state);
  place_points(i, {state.body[0].pose, state.body[1].pose}, &closest_points<Dim>, z);
  evaluate_contact(contacts_[i], prepared_[i], layout_.contact(i), z, state);
}

template <int Dim>
void StepProblem<Dim>::place_points(std::size_t i, const std::array<Pose<Dim>, 2>& pose,
                                    FindClosest<Dim> find, Eigen::VectorXd& z) {
  const ContactPair<Dim>& pair = contacts_[i];
  const auto closest = find(*pair.side_1.surface, pose[0], *pair.side_2.surface, pose[1]);
  // The direction of t stays while it can, whatever the law's own does: friction in z is told in it.
  prepared_[i].reference = usable_reference(closest.normal, prepared_[i].reference);
  set_points(i, pose, closest.a_1, closest.a_2, z);
  set_multipliers(i, pose, closest, z);
}

template <int Dim>
void StepProblem<Dim>::set_multipliers(std::size_t i, const std::array<Pose<Dim>, 2>& pose,
                                       const ClosestPoints<Dim>& closest, Eigen::VectorXd& z) const {
  const ContactPair<Dim>& pair = contacts_[i];
  const ContactLayout& at = layout_.contact(i);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    const Side<Dim>& side = k == 0 ? pair.side_1 : pair.side_2;
    if (side.kind != SideKind::intersection) continue;
    const Vector<Dim> outward = k == 0 ? Vector<Dim>(-closest.normal) : closest.normal;
    const Vector<Dim>& point = k == 0 ? closest.a_1 : closest.a_2;
    double* const first = z.data() + (k == 0 ? at.multipliers_1 : at.multipliers_2);
    closest_multipliers(*side.surface, pose[k].to_body(point),
                        Vector<Dim>(pose[k].rotation.matrix().transpose() * outward),
                        std::span(first, static_cast<std::size_t>(side.multipliers())));
  }
}

template void StepProblem<2>::set_points(std::size_t, const Vector<2>&, const Vector<2>&,
                                         Eigen::VectorXd&) const;
template void StepProblem<3>::set_points(std::size_t, const Vector<3>&, const Vector<3>&,
                                         Eigen::VectorXd&) const;
template void StepProblem<2>::evaluate_anew(std::size_t, Eigen::VectorXd&, ContactState<2>&);
template void StepProblem<3>::evaluate_anew(std::size_t, Eigen::VectorXd&, ContactState<3>&);
template void StepProblem<2>::find_points(std::size_t, Eigen::VectorXd&, FindClosest<2>);
template void StepProblem<3>::find_points(std::size_t, Eigen::VectorXd&, FindClosest<3>);

}  // namespace touchstone
