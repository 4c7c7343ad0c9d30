#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace touchstone {

/// Puts contacts in groups of `Size` that share no moving body, so that a group's can be swept over at once.
/// Of two contacts that do share one the earlier is in an earlier group, so that a sweep over group after
/// group, forth or back, finds what one over contact after contact finds.
template <std::size_t Size>
class SweepGroups {
 public:
  /// Begins with no group.
  /// @param bodies  number of bodies, of which the first one stands for all that is fixed
  void begin(std::size_t bodies) {
    next_of_body_.assign(bodies, 0);
    filled_.clear();
    open_.clear();
  }
  /// Puts one more contact into the first group that has room behind those of its bodies.
  /// @param bodies  of the contact
  /// @return  Size * its group + its place there
  std::size_t place(const std::array<std::size_t, 2>& bodies) {
    std::size_t group = first_open(std::max(next_of_body_[bodies[0]], next_of_body_[bodies[1]]));
    if (group == filled_.size()) {
      filled_.push_back(0);
      open_.push_back(group);
    }
    const std::size_t place = Size * group + filled_[group]++;
    if (filled_[group] == Size) open_[group] = group + 1;
    for (const std::size_t body : bodies) {
      if (body > 0) next_of_body_[body] = group + 1;
    }
    return place;
  }
  [[nodiscard]] std::size_t groups() const { return filled_.size(); }

 private:
  /// First group from `group` on that has room; the way there is shortened for the next one.
  std::size_t first_open(std::size_t group) {
    while (group < open_.size() && open_[group] != group) {
      if (open_[group] < open_.size()) open_[group] = open_[open_[group]];
      group = open_[group];
    }
    return group;
  }

  std::vector<std::size_t> next_of_body_;  ///< group from which a body is free
  std::vector<std::size_t> filled_;        ///< places taken
  std::vector<std::size_t> open_;          ///< a group that has room: itself; else one after it
};

}  // namespace touchstone
