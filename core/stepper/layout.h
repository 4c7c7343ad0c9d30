#pragma once

#include <vector>

#include "core/contact/side.h"
#include "core/model/scene.h"

namespace touchstone {

/// Two bodies that may touch. Body 2 owns the contact frame: n is its outward normal and points into body 1.
template <int Dim>
struct ContactPair {
  int body_1 = 0;
  int body_2 = 0;
  Side<Dim> side_1{};
  Side<Dim> side_2{};
  ContactLaw<Dim> law{};
};

/// Where the unknowns of one contact stand in z, and its rows in F. Point and multiplier unknowns are those
/// of the sides; the geometry rows are as many as the unknowns of both points (and the multipliers' rows as
/// many as the multipliers).
struct ContactLayout {
  Eigen::Index point_1 = 0;
  Eigen::Index point_2 = 0;
  Eigen::Index friction = 0;       ///< y = E^-1 p_f / (m V), Dimension::friction entries
  Eigen::Index normal = 0;         ///< p_n / (m V)
  Eigen::Index slip = 0;           ///< sigma / V
  Eigen::Index multipliers_1 = 0;  ///< l of an intersection
  Eigen::Index multipliers_2 = 0;
};

/// z = [u | v] as in the paper: u = [nu; joint impulses; a_1, a_2, p_t, p_o, p_r per contact] free, v = [p_n,
/// sigma per contact] >= 0, and after them the multipliers l >= 0 of bodies that are intersections
/// (appendix).
template <int Dim>
class StepLayout {
 public:
  void assign(int moving_bodies, Eigen::Index joint_rows, const std::vector<ContactPair<Dim>>& contacts);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Number of free unknowns: the length of u.
  [[nodiscard]] Eigen::Index free_size() const { return free_size_; }
  [[nodiscard]] const ContactLayout& contact(std::size_t i) const { return contacts_[i]; }
  [[nodiscard]] static Eigen::Index velocity(int moving) { return Dimension<Dim>::velocity * moving; }
  /// Where the contacts' unknowns begin.
  [[nodiscard]] Eigen::Index contacts_begin() const { return contacts_begin_; }
  /// Where the joints' impulses begin.
  [[nodiscard]] Eigen::Index joints() const { return joints_; }

 private:
  Eigen::Index size_ = 0;
  Eigen::Index free_size_ = 0;
  Eigen::Index joints_ = 0;
  Eigen::Index contacts_begin_ = 0;
  std::vector<ContactLayout> contacts_;
};

}  // namespace touchstone
