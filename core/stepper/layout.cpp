#include "core/stepper/layout.h"

namespace touchstone {

template <int Dim>
void StepLayout<Dim>::assign(int moving_bodies, Eigen::Index joint_rows,
                             const std::vector<ContactPair<Dim>>& contacts) {
  contacts_.resize(contacts.size());
  joints_ = velocity(moving_bodies);
  contacts_begin_ = joints_ + joint_rows;
  Eigen::Index next = contacts_begin_;
  const auto take = [&next](Eigen::Index count) {
    const Eigen::Index first = next;
    next += count;
    return first;
  };
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts_[i].point_1 = take(contacts[i].side_1.point_unknowns());
    contacts_[i].point_2 = take(contacts[i].side_2.point_unknowns());
    contacts_[i].friction = take(Dimension<Dim>::friction);
  }
  free_size_ = next;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts_[i].normal = take(1);
    contacts_[i].slip = take(1);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    contacts_[i].multipliers_1 = take(contacts[i].side_1.multipliers());
    contacts_[i].multipliers_2 = take(contacts[i].side_2.multipliers());
  }
  size_ = next;
}

template class StepLayout<2>;
template class StepLayout<3>;

}  // namespace touchstone
