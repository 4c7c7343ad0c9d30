#pragma once

#include "core/surfaces/convex_surface.h"

namespace touchstone {

/// f_i(x) = normal_i . x - offset_i, the distances to the faces' planes.
template <int Dim>
class PolytopeSurface final : public ConvexSurface<Dim> {
 public:
  using typename ConvexSurface<Dim>::BoundingBall;

  explicit PolytopeSurface(Polytope<Dim> polytope)
      : polytope_(std::move(polytope)), ball_(enclosing_ball(polytope_.vertices)) {}
  /// @param ball  contains all vertices; for a shape whose least ball is known
  PolytopeSurface(Polytope<Dim> polytope, const BoundingBall& ball)
      : polytope_(std::move(polytope)), ball_(ball) {}

  int count() const override { return static_cast<int>(polytope_.normals.size()); }
  SurfaceJet<Dim> jet(int i, const Vector<Dim>& x) const override {
    return {value(i, x), polytope_.normals[static_cast<std::size_t>(i)], Matrix<Dim>::Zero()};
  }
  double value(int i, const Vector<Dim>& x) const override {
    const auto face = static_cast<std::size_t>(i);
    return polytope_.normals[face].dot(x) - polytope_.offsets[face];
  }
  /// The farthest vertex, by looking at each: rigid convex parts have tens of them.
  Vector<Dim> support(const Vector<Dim>& direction) const override {
    const Vector<Dim>* farthest = &polytope_.vertices.front();
    double reach = direction.dot(*farthest);
    for (const Vector<Dim>& vertex : polytope_.vertices) {
      const double tried = direction.dot(vertex);
      if (tried > reach) {
        reach = tried;
        farthest = &vertex;
      }
    }
    return *farthest;
  }
  BoundingBall bounding_ball() const override { return ball_; }

 private:
  /// A ball within a percent of the least one: walk towards the farthest vertex by 1/(k+1) of the way (Badoiu
  /// and Clarkson, Smaller core-sets for balls, SODA 2003).
  static BoundingBall enclosing_ball(const std::vector<Vector<Dim>>& vertices) {
    constexpr int kSteps = 200;
    const auto farthest_from = [&](const Vector<Dim>& c) {
      const Vector<Dim>* farthest = &vertices.front();
      for (const Vector<Dim>& vertex : vertices) {
        if ((vertex - c).squaredNorm() > (*farthest - c).squaredNorm()) farthest = &vertex;
      }
      return *farthest;
    };
    BoundingBall ball{vertices.front(), 0.0};
    for (int k = 1; k <= kSteps; ++k) ball.center += (farthest_from(ball.center) - ball.center) / (k + 1);
    ball.radius = (farthest_from(ball.center) - ball.center).norm();
    return ball;
  }

  Polytope<Dim> polytope_;
  BoundingBall ball_;
};

}  // namespace touchstone
