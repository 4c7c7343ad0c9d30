#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/stepper/box_tree.h"
#include "core/stepper/layout.h"

namespace touchstone {

/// The pairs of a scene's bodies that may touch during a step.
///
/// A pair enters a step's problem if its bounding balls come within reach of each other during the step at
/// the speeds that the bodies have. That is a guess, since impulses change speeds: after the solve the
/// stepper asks for the pairs that were left out and overlap nevertheless, adds them, and solves again. So
/// the result does not depend on the guess.
///
/// Pairs are found by a tree of boxes around the balls and their reach, in O(n log n) for n bodies of like
/// size; half-spaces are held against every moving body. What the boxes find is then judged by the balls, so
/// that the selection is that of all pairs, one by one.
template <int Dim>
class ContactCandidates {
 public:
  /// One pair of bodies, not both fixed and not coupled by a joint, and its surfaces.
  struct Pair {
    ContactPair<Dim> contact{};
    bool selected = false;
    bool needed = false;  ///< found to overlap at the end of the step being solved
  };

  /// @throws Unsupported for a shape without a surface, or two half-spaces of which one moves
  explicit ContactCandidates(const Scene<Dim>& scene);

  /// Selects the pairs within reach of a step of h [s] from `state`. Allocates only for pairs not met before.
  void select(std::span<const BodyState<Dim>> state, double h);
  /// Selects those that are not selected and overlap in `state`. @return whether there were any
  bool add_overlapping(std::span<const BodyState<Dim>> state);
  /// Leaves out of the selected pairs those that are farther apart in `state` than what moves fastest would
  /// come in a few steps of h [s]: a closer guess than select()'s, which costs closest points. Pairs found to
  /// overlap in the step stay. @return whether there were any
  bool leave_out_far(std::span<const BodyState<Dim>> state, double h);
  /// Selects again what leave_out_far() has left out since select(). @return whether there was any
  bool take_back();

  /// The pairs met so far. A pair keeps its index; select() and add_overlapping() may append.
  [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }
  /// Indices into pairs() of those selected, ascending by the pair's lower body and then by its higher one.
  [[nodiscard]] std::span<const int> selected() const { return selected_; }
  [[nodiscard]] const ConvexSurface<Dim>& surface(int body) const {
    return *surfaces_[static_cast<std::size_t>(body)];
  }

 private:
  using State = std::span<const BodyState<Dim>>;

  /// The pair of bodies i < j, with the order that the contact frame asks for.
  [[nodiscard]] Pair make_pair(int i, int j) const;
  [[nodiscard]] bool excluded(int i, int j) const;
  /// Index of the pair of bodies i < j, new if it was not met before.
  [[nodiscard]] int find_or_add(int i, int j);
  /// Finds the bodies whose boxes overlap and calls visit(pair) for each, and for each with a half-space.
  /// @param h  of the step whose reach is added to the boxes; 0: none
  template <typename Visit>
  void for_each_near(State state, double h, Visit visit);
  void sort_selected();

  /// Least distance of the bounding balls, or of ball and half-space, [m].
  [[nodiscard]] double ball_gap(const ContactPair<Dim>& contact, State state) const;
  [[nodiscard]] double reach(const ContactPair<Dim>& contact, State state, double h) const;
  /// Largest speed of any point of a moving body in a free step, or somewhat more [m/s].
  [[nodiscard]] double fastest(State state, double h) const;
  /// A box with the ball of body i and its share of any pair's reach.
  [[nodiscard]] AlignedBox<Dim> box(int i, State state, double h) const;

  const Scene<Dim>& scene_;
  std::vector<std::shared_ptr<const ConvexSurface<Dim>>> surfaces_;
  std::vector<typename ConvexSurface<Dim>::BoundingBall> balls_;  ///< body frame
  std::vector<std::pair<int, int>> jointed_;                      ///< lower body first, sorted
  std::vector<Pair> pairs_;
  std::vector<int> with_plane_;                   ///< pairs of which one body is a half-space: the first ones
  std::unordered_map<std::uint64_t, int> index_;  ///< of a pair, by its bodies
  std::vector<int> bounded_;                      ///< bodies that are no half-spaces
  std::vector<AlignedBox<Dim>> boxes_;            ///< of these
  std::vector<std::pair<int, int>> found_;
  BoxTree<Dim> tree_;
  std::vector<int> selected_;
  std::vector<int> left_out_;  ///< by leave_out_far(), since select()
};

}  // namespace touchstone
