#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/model/dimension.h"

namespace touchstone {

/// An axis-aligned box, world frame [m].
template <int Dim>
struct AlignedBox {
  Vector<Dim> low = Vector<Dim>::Zero();
  Vector<Dim> high = Vector<Dim>::Zero();

  [[nodiscard]] bool overlaps(const AlignedBox& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// A tree of boxes over boxes, built anew for every set: split at the median along the axis on which the
/// centres spread most. Building takes O(n log n); finding what overlaps a box O(log n) and what is found,
/// for boxes of like size that do not crowd. Sizes may differ by any factor. Allocates only while it has not
/// seen as many boxes before.
template <int Dim>
class BoxTree {
 public:
  /// Makes room for `count` boxes.
  void reserve(std::size_t count);
  /// @param boxes  not empty, finite or infinite but without NaN; must stay as they are until the next build
  void build(std::span<const AlignedBox<Dim>> boxes);

  /// Calls visit(i) for every box i that overlaps `box`, touching included, in no particular order.
  template <typename Visit>
  void for_each_overlapping(const AlignedBox<Dim>& box, Visit visit) const {
    std::array<int, kDeepest> open{};  // nodes to look into
    std::size_t count = 0;
    open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(open[--count])];
      if (!node.box.overlaps(box)) continue;
      if (node.second == 0) {
        for (int k = node.begin; k < node.end; ++k) {
          const int i = order_[static_cast<std::size_t>(k)];
          if (boxes_[static_cast<std::size_t>(i)].overlaps(box)) visit(i);
        }
      } else {
        open[count++] = node.second;
        open[count++] = static_cast<int>(&node - nodes_.data()) + 1;
      }
    }
  }

 private:
  static constexpr int kLeaf = 4;              ///< boxes of a node that is not split
  static constexpr std::size_t kDeepest = 64;  ///< halving reaches one box from any number within as many

  struct Node {
    AlignedBox<Dim> box;
    int begin = 0;  ///< of its boxes in order_
    int end = 0;
    int second = 0;  ///< its second child; the first follows it. 0 of a leaf
  };

  int add_node(int begin, int end);

  std::span<const AlignedBox<Dim>> boxes_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace touchstone
