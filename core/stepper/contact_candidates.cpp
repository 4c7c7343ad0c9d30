#include "core/stepper/contact_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/closest_points.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

constexpr double kMargin = 0.02;  // of the body's size: a pair that just touches is in
/// Steps of the fastest body within which a pair may touch: impulses do not make much faster what is hit, but
/// they may turn it.
constexpr double kNearSteps = 3;
constexpr double kTouching = 1e-9;  // of the body's size: a pair of bodies at rest is in

std::pair<int, int> ordered(int i, int j) { return i < j ? std::pair(i, j) : std::pair(j, i); }

/// A box that overlaps nothing.
template <int Dim>
AlignedBox<Dim> nowhere() {
  const double infinity = std::numeric_limits<double>::infinity();
  return {Vector<Dim>::Constant(infinity), Vector<Dim>::Constant(-infinity)};
}

/// Body 2 owns the contact frame: the body with the simplest normal, a plane before a smooth surface before
/// an intersection, and among equals the fixed one.
template <int Dim>
int frame_rank(const Side<Dim>& side, bool fixed) {
  const int simplicity = side.kind == SideKind::plane ? 2 : side.kind == SideKind::smooth ? 1 : 0;
  return 2 * simplicity + (fixed ? 1 : 0);
}

}  // namespace

template <int Dim>
ContactCandidates<Dim>::ContactCandidates(const Scene<Dim>& scene) : scene_(scene) {
  for (const auto& body : scene.bodies) {
    surfaces_.push_back(make_surface(body.shape));
    balls_.push_back(surfaces_.back()->bounding_ball());
  }
  for (const auto& joint : scene.joints) jointed_.push_back(ordered(joint.body_a, joint.body_b));
  std::sort(jointed_.begin(), jointed_.end());
  const int count = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < count; ++i) {
    if (surface(i).plane() == nullptr) {
      bounded_.push_back(i);
      continue;
    }
    for (int j = 0; j < count; ++j) {
      if (j == i || (j < i && surface(j).plane() != nullptr) || excluded(i, j)) continue;
      if (surface(j).plane() != nullptr) {
        throw Unsupported(fmt::format("contact of two half-spaces ({} and {})",
                                      scene.bodies[static_cast<std::size_t>(i)].name,
                                      scene.bodies[static_cast<std::size_t>(j)].name));
      }
      with_plane_.push_back(static_cast<int>(pairs_.size()));
      pairs_.push_back(make_pair(std::min(i, j), std::max(i, j)));
    }
  }
  selected_.reserve(pairs_.size());
  boxes_.reserve(bounded_.size());
  tree_.reserve(bounded_.size());
}

template <int Dim>
auto ContactCandidates<Dim>::make_pair(int i, int j) const -> Pair {
  const Body<Dim>& a = scene_.bodies[static_cast<std::size_t>(i)];
  const Body<Dim>& b = scene_.bodies[static_cast<std::size_t>(j)];
  Pair pair{{i, j, make_side(surface(i)), make_side(surface(j)), scene_.law(i, j)}};
  ContactPair<Dim>& contact = pair.contact;
  if (frame_rank(contact.side_1, a.fixed) > frame_rank(contact.side_2, b.fixed)) {
    std::swap(contact.body_1, contact.body_2);
    std::swap(contact.side_1, contact.side_2);
  }
  return pair;
}

template <int Dim>
bool ContactCandidates<Dim>::excluded(int i, int j) const {
  const bool fixed =
      scene_.bodies[static_cast<std::size_t>(i)].fixed && scene_.bodies[static_cast<std::size_t>(j)].fixed;
  return fixed || std::binary_search(jointed_.begin(), jointed_.end(), ordered(i, j));
}

template <int Dim>
int ContactCandidates<Dim>::find_or_add(int i, int j) {
  const std::uint64_t key = static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint64_t>(j);
  const auto known = index_.find(key);
  if (known != index_.end()) return known->second;
  const int index = static_cast<int>(pairs_.size());
  index_.emplace(key, index);
  pairs_.push_back(make_pair(i, j));
  return index;
}

template <int Dim>
template <typename Visit>
void ContactCandidates<Dim>::for_each_near(State state, double h, Visit visit) {
  for (const int pair : with_plane_) visit(pair);
  if (bounded_.size() < 2) return;
  boxes_.clear();
  for (const int body : bounded_) boxes_.push_back(box(body, state, h));
  tree_.build(boxes_);
  found_.clear();
  for (std::size_t k = 0; k < bounded_.size(); ++k) {
    const int i = bounded_[k];
    if (scene_.bodies[static_cast<std::size_t>(i)].fixed) continue;
    tree_.for_each_overlapping(boxes_[k], [&](int other) {
      const int j = bounded_[static_cast<std::size_t>(other)];
      const bool twice = !scene_.bodies[static_cast<std::size_t>(j)].fixed && j < i;
      if (j != i && !twice && !excluded(i, j)) found_.push_back(ordered(i, j));
    });
  }
  for (const auto& [i, j] : found_) visit(find_or_add(i, j));
}

template <int Dim>
double ContactCandidates<Dim>::ball_gap(const ContactPair<Dim>& contact,
                                        std::span<const BodyState<Dim>> state) const {
  const auto i = static_cast<std::size_t>(contact.body_1);
  const auto j = static_cast<std::size_t>(contact.body_2);
  const Vector<Dim> center = state[i].pose.to_world(balls_[i].center);
  if (contact.side_2.kind == SideKind::plane) {
    return contact.side_2.surface->value(0, state[j].pose.to_body(center)) - balls_[i].radius;
  }
  return (center - state[j].pose.to_world(balls_[j].center)).norm() - balls_[i].radius - balls_[j].radius;
}

template <int Dim>
double ContactCandidates<Dim>::reach(const ContactPair<Dim>& contact, std::span<const BodyState<Dim>> state,
                                     double h) const {
  double speed = h * scene_.gravity.norm();
  double size = 0;
  for (const int index : {contact.body_1, contact.body_2}) {
    const auto i = static_cast<std::size_t>(index);
    if (scene_.bodies[i].fixed) continue;
    speed += state[i].velocity.template head<Dim>().norm();
    if (std::isfinite(balls_[i].radius)) size = std::max(size, balls_[i].radius);
  }
  return h * speed + kMargin * size;
}

template <int Dim>
AlignedBox<Dim> ContactCandidates<Dim>::box(int i, State state, double h) const {
  constexpr double kRounding = 1e-12;  // far above that of ball_gap() and reach()
  const auto index = static_cast<std::size_t>(i);
  const Vector<Dim> center = state[index].pose.to_world(balls_[index].center);
  const double radius = balls_[index].radius;
  double extent = radius;
  if (h > 0) {
    // Half of what gravity adds to a pair, and all of what the body itself does: two boxes together have at
    // least the pair's reach.
    extent += 0.5 * h * h * scene_.gravity.norm();
    if (!scene_.bodies[index].fixed)
      extent += h * state[index].velocity.template head<Dim>().norm() + kMargin * radius;
  }
  extent += kRounding * (extent + center.template lpNorm<Eigen::Infinity>());
  // A body that is nowhere is near nothing, as its balls would say.
  if (!(std::isfinite(extent) && center.allFinite())) return nowhere<Dim>();
  return {center.array() - extent, center.array() + extent};
}

template <int Dim>
void ContactCandidates<Dim>::sort_selected() {
  const auto bodies = [this](int pair) {
    const ContactPair<Dim>& contact = pairs_[static_cast<std::size_t>(pair)].contact;
    return ordered(contact.body_1, contact.body_2);
  };
  std::sort(selected_.begin(), selected_.end(), [&](int x, int y) { return bodies(x) < bodies(y); });
}

template <int Dim>
void ContactCandidates<Dim>::select(State state, double h) {
  for (const int pair : selected_) pairs_[static_cast<std::size_t>(pair)].selected = false;
  selected_.clear();
  left_out_.clear();
  for_each_near(state, h, [&](int index) {
    Pair& pair = pairs_[static_cast<std::size_t>(index)];
    if (!(ball_gap(pair.contact, state) <= reach(pair.contact, state, h))) return;
    pair.selected = true;
    pair.needed = false;
    selected_.push_back(index);
  });
  sort_selected();
}

template <int Dim>
bool ContactCandidates<Dim>::add_overlapping(State state) {
  const std::size_t before = selected_.size();
  for_each_near(state, 0.0, [&](int index) {
    Pair& pair = pairs_[static_cast<std::size_t>(index)];
    if (pair.selected || !(ball_gap(pair.contact, state) < 0)) return;
    const auto i = static_cast<std::size_t>(pair.contact.body_1);
    const auto j = static_cast<std::size_t>(pair.contact.body_2);
    const auto closest = closest_points(*pair.contact.side_1.surface, state[i].pose,
                                        *pair.contact.side_2.surface, state[j].pose);
    if (closest.gap >= 0) return;
    pair.selected = true;
    pair.needed = true;
    selected_.push_back(index);
  });
  if (selected_.size() == before) return false;
  sort_selected();
  return true;
}

template <int Dim>
double ContactCandidates<Dim>::fastest(State state, double h) const {
  double most = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Body<Dim>& body = scene_.bodies[i];
    if (body.fixed || !std::isfinite(balls_[i].radius)) continue;
    const double arm = balls_[i].center.norm() + balls_[i].radius;
    const double speed = state[i].velocity.template head<Dim>().norm() +
                         arm * state[i].velocity.template tail<Dimension<Dim>::angular>().norm();
    most = std::max(most, speed + h * (scene_.gravity.norm() + body.force.norm() / body.mass));
  }
  return most;
}

template <int Dim>
bool ContactCandidates<Dim>::leave_out_far(State state, double h) {
  const double range = kNearSteps * h * fastest(state, h);
  const std::size_t before = selected_.size();
  for (const int index : selected_) {
    Pair& pair = pairs_[static_cast<std::size_t>(index)];
    if (pair.needed) continue;
    const auto i = static_cast<std::size_t>(pair.contact.body_1);
    const auto j = static_cast<std::size_t>(pair.contact.body_2);
    const auto closest = closest_points(*pair.contact.side_1.surface, state[i].pose,
                                        *pair.contact.side_2.surface, state[j].pose);
    pair.selected = !(closest.gap > range + kTouching * balls_[i].radius);
    if (!pair.selected) left_out_.push_back(index);
  }
  std::erase_if(selected_, [this](int index) { return !pairs_[static_cast<std::size_t>(index)].selected; });
  return selected_.size() < before;
}

template <int Dim>
bool ContactCandidates<Dim>::take_back() {
  const std::size_t before = selected_.size();
  for (const int index : left_out_) {
    Pair& pair = pairs_[static_cast<std::size_t>(index)];
    if (!pair.selected) selected_.push_back(index);
    pair.selected = true;
  }
  left_out_.clear();
  sort_selected();
  return selected_.size() > before;
}

template class ContactCandidates<2>;
template class ContactCandidates<3>;

}  // namespace touchstone
