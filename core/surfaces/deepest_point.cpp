#include "core/surfaces/deepest_point.h"

#include <cmath>

/// The ellipsoid method (Yudin and Nemirovski 1976; Shor 1977): slow, but it needs no more than a subgradient
/// and cannot fail, and it runs once when a scene is loaded.
namespace touchstone {

template <int Dim>
DeepestPoint<Dim> deepest_point(const ConvexSurface<Dim>& surface,
                                const typename ConvexSurface<Dim>::BoundingBall& start) {
  constexpr int kMaximumCuts = 2000;
  constexpr double kTolerance = 1e-10;  // of the start's radius
  constexpr double n = Dim;
  Vector<Dim> x = start.center;
  Matrix<Dim> p = start.radius * start.radius * Matrix<Dim>::Identity();  // (y - x)^T p^-1 (y - x) <= 1
  DeepestPoint<Dim> best{x, -surface.value(largest_inequality(surface, x), x)};
  for (int k = 0; k < kMaximumCuts; ++k) {
    const SurfaceJet<Dim> jet = surface.jet(largest_inequality(surface, x), x);
    if (-jet.value > best.depth) best = {x, -jet.value};
    const double possible = std::sqrt(jet.gradient.dot(p * jet.gradient));  // by which the jet can still fall
    if (!(possible > kTolerance * start.radius)) break;
    const Vector<Dim> step = p * jet.gradient / possible;
    x -= step / (n + 1);
    p = n * n / (n * n - 1) * (p - 2 / (n + 1) * step * step.transpose());
  }
  return best;
}

template DeepestPoint<2> deepest_point(const ConvexSurface<2>&, const ConvexSurface<2>::BoundingBall&);
template DeepestPoint<3> deepest_point(const ConvexSurface<3>&, const ConvexSurface<3>::BoundingBall&);

}  // namespace touchstone
