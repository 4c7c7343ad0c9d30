#include "core/stepper/contact_candidates.h"

#include <fmt/format.h>

#include <utility>

#include "core/contact/closest_points.h"
#include "core/model/errors.h"

namespace touchstone {

namespace {

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
  const int count = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const Body<Dim>& a = scene.bodies[static_cast<std::size_t>(i)];
      const Body<Dim>& b = scene.bodies[static_cast<std::size_t>(j)];
      if ((a.fixed && b.fixed) || scene.jointed(i, j)) continue;
      Side<Dim> side_a = make_side(surface(i));
      Side<Dim> side_b = make_side(surface(j));
      if (side_a.kind == SideKind::plane && side_b.kind == SideKind::plane) {
        throw Unsupported(fmt::format("contact of two half-spaces ({} and {})", a.name, b.name));
      }
      Pair pair{{i, j, side_a, side_b, scene.law(i, j)}};
      if (frame_rank(side_a, a.fixed) > frame_rank(side_b, b.fixed)) {
        std::swap(pair.contact.body_1, pair.contact.body_2);
        std::swap(pair.contact.side_1, pair.contact.side_2);
      }
      pairs_.push_back(pair);
    }
  }
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
  constexpr double kMargin = 0.02;  // of the body's size: a pair that just touches is in
  return h * speed + kMargin * size;
}

template <int Dim>
void ContactCandidates<Dim>::select(std::span<const BodyState<Dim>> state, double h) {
  for (auto& pair : pairs_) {
    pair.selected = ball_gap(pair.contact, state) <= reach(pair.contact, state, h);
  }
}

template <int Dim>
bool ContactCandidates<Dim>::add_overlapping(std::span<const BodyState<Dim>> state) {
  bool added = false;
  for (auto& pair : pairs_) {
    if (pair.selected || ball_gap(pair.contact, state) >= 0) continue;
    const auto i = static_cast<std::size_t>(pair.contact.body_1);
    const auto j = static_cast<std::size_t>(pair.contact.body_2);
    const auto closest = closest_points(*pair.contact.side_1.surface, state[i].pose,
                                        *pair.contact.side_2.surface, state[j].pose);
    if (closest.gap >= 0) continue;
    pair.selected = true;
    added = true;
  }
  return added;
}

template class ContactCandidates<2>;
template class ContactCandidates<3>;

}  // namespace touchstone
