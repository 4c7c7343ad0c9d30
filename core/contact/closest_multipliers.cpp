#include "core/contact/closest_multipliers.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/surfaces/normal_combination.h"

namespace touchstone {

template <int Dim>
double closest_multipliers(const ConvexSurface<Dim>& surface, const Vector<Dim>& point_body,
                           const Vector<Dim>& normal_body, std::span<double> out) {
  constexpr double kExact = 1e-12;
  constexpr double kFirstSlack = 1e-12;  // over the body's radius
  constexpr double kLastSlack = 1e-3;
  assert(out.size() == static_cast<std::size_t>(surface.count()));
  const double radius = surface.bounding_ball().radius;
  const double unit = std::isfinite(radius) ? radius : 1.0;
  NormalCombination<Dim> best = normal_combination(surface, point_body, normal_body, kFirstSlack * unit);
  for (double slack = 10 * kFirstSlack; slack <= kLastSlack && best.residual.norm() > kExact; slack *= 10) {
    const NormalCombination<Dim> tried = normal_combination(surface, point_body, normal_body, slack * unit);
    if (tried.residual.norm() < best.residual.norm()) best = tried;
  }
  std::fill(out.begin(), out.end(), 0.0);
  for (int k = 0; k < best.size; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out[static_cast<std::size_t>(best.index[at])] = best.multiplier[at];
  }
  return best.residual.norm();
}

template double closest_multipliers(const ConvexSurface<2>&, const Vector<2>&, const Vector<2>&,
                                    std::span<double>);
template double closest_multipliers(const ConvexSurface<3>&, const Vector<3>&, const Vector<3>&,
                                    std::span<double>);

}  // namespace touchstone
