#include "core/surfaces/intersection.h"

#include <algorithm>

#include "core/model/errors.h"
#include "core/surfaces/deepest_point.h"
#include "core/surfaces/farthest_point.h"

namespace touchstone {

template <int Dim>
IntersectionSurface<Dim>::IntersectionSurface(std::vector<Part> parts, const std::string& field)
    : parts_(std::move(parts)) {
  constexpr double kFlat = 1e-9;  // depth over size
  for (const Part& part : parts_) {
    for (int i = 0; i < part->count(); ++i) inequalities_.push_back({part.get(), i});
  }
  ball_ = smallest_ball();
  const DeepestPoint<Dim> deepest = deepest_point(*this, ball_);
  if (!(deepest.depth > kFlat * ball_.radius)) {
    throw InputError(field, fmt::format("parts whose common depth is {} m", deepest.depth),
                     "parts that share a solid");
  }
  inside_ = deepest.point;
  const BoundingBall around = ball_around_extents();
  if (around.radius < ball_.radius) ball_ = around;
}

template <int Dim>
Vector<Dim> IntersectionSurface<Dim>::support(const Vector<Dim>& direction) const {
  constexpr double kRounding = 1e-15;
  for (const Part& part : parts_) {
    const Vector<Dim> farthest = part->support(direction);
    const auto holds = [&](const Inequality& f) {
      return f.surface == part.get() || f.surface->value(f.index, farthest) <= kRounding * ball_.radius;
    };
    if (farthest.allFinite() && std::all_of(inequalities_.begin(), inequalities_.end(), holds))
      return farthest;
  }
  return farthest_point(*this, inside_, ball_.radius, direction);
}

template <int Dim>
auto IntersectionSurface<Dim>::smallest_ball() const -> BoundingBall {
  BoundingBall smallest = parts_.front()->bounding_ball();
  for (const Part& part : parts_) {
    const BoundingBall ball = part->bounding_ball();
    if (ball.radius < smallest.radius) smallest = ball;
  }
  return smallest;
}

/// The ball through the corners of the body's box of extents.
template <int Dim>
auto IntersectionSurface<Dim>::ball_around_extents() const -> BoundingBall {
  Vector<Dim> low;
  Vector<Dim> high;
  for (int k = 0; k < Dim; ++k) {
    high[k] = support(Vector<Dim>::Unit(k))[k];
    low[k] = support(-Vector<Dim>::Unit(k))[k];
  }
  return {0.5 * (low + high), 0.5 * (high - low).norm()};
}

template class IntersectionSurface<2>;
template class IntersectionSurface<3>;

}  // namespace touchstone
