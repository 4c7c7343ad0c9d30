#include "core/stepper/box_tree.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace touchstone {

template <int Dim>
void BoxTree<Dim>::reserve(std::size_t count) {
  order_.reserve(count);
  nodes_.reserve(2 * count);
}

template <int Dim>
void BoxTree<Dim>::build(std::span<const AlignedBox<Dim>> boxes) {
  assert(!boxes.empty());
  boxes_ = boxes;
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.clear();
  add_node(0, static_cast<int>(boxes.size()));
}

/// The tree over order_[begin ... end - 1]; @return its root's place
template <int Dim>
int BoxTree<Dim>::add_node(int begin, int end) {
  const auto box_of = [this](int i) -> const AlignedBox<Dim>& { return boxes_[static_cast<std::size_t>(i)]; };
  // Twice the centre; that of an infinite box is put in the middle of everything.
  const auto center = [&](int i, int axis) {
    const double sum = box_of(i).low[axis] + box_of(i).high[axis];
    return std::isfinite(sum) ? sum : 0.0;
  };
  AlignedBox<Dim> around = box_of(order_[static_cast<std::size_t>(begin)]);
  AlignedBox<Dim> centers;
  for (int axis = 0; axis < Dim; ++axis)
    centers.low[axis] = centers.high[axis] = center(order_[static_cast<std::size_t>(begin)], axis);
  for (int k = begin + 1; k < end; ++k) {
    const int i = order_[static_cast<std::size_t>(k)];
    around.low = around.low.cwiseMin(box_of(i).low);
    around.high = around.high.cwiseMax(box_of(i).high);
    for (int axis = 0; axis < Dim; ++axis) {
      centers.low[axis] = std::min(centers.low[axis], center(i, axis));
      centers.high[axis] = std::max(centers.high[axis], center(i, axis));
    }
  }
  const int place = static_cast<int>(nodes_.size());
  nodes_.push_back({around, begin, end, 0});
  if (end - begin <= kLeaf) return place;
  int axis = 0;
  (centers.high - centers.low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int i, int j) {
    return std::pair(center(i, axis), i) < std::pair(center(j, axis), j);
  });
  add_node(begin, middle);
  const int second = add_node(middle, end);
  nodes_[static_cast<std::size_t>(place)].second = second;
  return place;
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace touchstone
