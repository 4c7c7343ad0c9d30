#include "core/stepper/islands.h"

#include <limits>
#include <numeric>

namespace touchstone {

namespace {
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
}  // namespace

template <int Dim>
Islands::Islands(const Scene<Dim>& scene) : parent_(scene.bodies.size()), island_(scene.bodies.size()) {
  for (const auto& body : scene.bodies) moves_.push_back(!body.fixed);
}

std::size_t Islands::root(int body) {
  auto at = static_cast<std::size_t>(body);
  while (parent_[at] != at) {
    parent_[at] = parent_[parent_[at]];  // halves the path for the next one
    at = parent_[at];
  }
  return at;
}

void Islands::join(int a, int b) {
  if (!moves_[static_cast<std::size_t>(a)] || !moves_[static_cast<std::size_t>(b)]) return;
  const std::size_t root_a = root(a);
  const std::size_t root_b = root(b);
  // The first body is the root, so that islands come in the order of their first bodies.
  parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

/// Counting sort of 0 ... count - 1 by island, those of no island left out.
template <typename Number, typename IslandOf>
void Islands::sort(std::size_t count, const IslandOf& island_of, std::vector<std::size_t>& begin,
                   std::vector<Number>& sorted) {
  begin.assign(count_ + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (const std::size_t island = island_of(i); island != kNone) ++begin[island + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  sorted.resize(begin.back());
  for (std::size_t i = 0; i < count; ++i) {
    if (const std::size_t island = island_of(i); island != kNone)
      sorted[begin[island]++] = static_cast<Number>(i);
  }
  for (std::size_t island = count_; island > 0; --island) begin[island] = begin[island - 1];
  begin[0] = 0;
}

template <int Dim>
void Islands::split(const Scene<Dim>& scene, std::span<const ContactPair<Dim>> contacts) {
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  for (const auto& contact : contacts) join(contact.body_1, contact.body_2);
  for (const auto& joint : scene.joints) join(joint.body_a, joint.body_b);
  count_ = 0;
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const std::size_t first = root(static_cast<int>(i));
    island_[i] = !moves_[i] ? kNone : first == i ? count_++ : island_[first];
  }
  const auto of_two = [this](int a, int b) {
    const std::size_t island = island_[static_cast<std::size_t>(a)];
    return island != kNone ? island : island_[static_cast<std::size_t>(b)];
  };
  sort(
      island_.size(), [this](std::size_t i) { return island_[i]; }, body_begin_, bodies_);
  sort(
      scene.joints.size(),
      [&](std::size_t i) { return of_two(scene.joints[i].body_a, scene.joints[i].body_b); }, joint_begin_,
      joints_);
  sort(
      contacts.size(), [&](std::size_t i) { return of_two(contacts[i].body_1, contacts[i].body_2); },
      contact_begin_, contacts_);
}

Islands::Island Islands::operator[](std::size_t i) const {
  const auto part = [i](const auto& sorted, const std::vector<std::size_t>& begin) {
    return std::span(sorted).subspan(begin[i], begin[i + 1] - begin[i]);
  };
  return {part(bodies_, body_begin_), part(joints_, joint_begin_), part(contacts_, contact_begin_)};
}

template Islands::Islands(const Scene<2>&);
template Islands::Islands(const Scene<3>&);
template void Islands::split(const Scene<2>&, std::span<const ContactPair<2>>);
template void Islands::split(const Scene<3>&, std::span<const ContactPair<3>>);

}  // namespace touchstone
