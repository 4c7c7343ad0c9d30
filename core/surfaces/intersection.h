#pragma once

#include <string>
#include <vector>

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// What lies in every one of several surfaces: all their inequalities in one list (the paper's appendix).
template <int Dim>
class IntersectionSurface final : public ConvexSurface<Dim> {
 public:
  using typename ConvexSurface<Dim>::BoundingBall;
  using Part = std::shared_ptr<const ConvexSurface<Dim>>;

  /// @param parts  in the body frame; at least one bounded
  /// @param field  what to call the shape in a message
  /// @throws InputError if the parts have no common point or share less than a solid
  IntersectionSurface(std::vector<Part> parts, const std::string& field);

  int count() const override { return static_cast<int>(inequalities_.size()); }
  SurfaceJet<Dim> jet(int i, const Vector<Dim>& x) const override {
    const Inequality& f = inequalities_[static_cast<std::size_t>(i)];
    return f.surface->jet(f.index, x);
  }
  double value(int i, const Vector<Dim>& x) const override {
    const Inequality& f = inequalities_[static_cast<std::size_t>(i)];
    return f.surface->value(f.index, x);
  }
  /// A part's own farthest point if it lies in all others, else by farthest_point().
  Vector<Dim> support(const Vector<Dim>& direction) const override;
  BoundingBall bounding_ball() const override { return ball_; }

 private:
  struct Inequality {
    const ConvexSurface<Dim>* surface;
    int index;
  };

  [[nodiscard]] BoundingBall smallest_ball() const;
  [[nodiscard]] BoundingBall ball_around_extents() const;

  std::vector<Part> parts_;
  std::vector<Inequality> inequalities_;
  BoundingBall ball_{};
  Vector<Dim> inside_ = Vector<Dim>::Zero();  ///< deepest point: where the search for a support starts
};

}  // namespace touchstone
