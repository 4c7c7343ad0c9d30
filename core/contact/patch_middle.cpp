#include "core/contact/patch_middle.h"

#include <array>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kTurn = 1e-4;  // [rad]: the bodies' overlap or distance changes by as much of their size

/// Turns to all sides that lower another part of a body on a plane with this normal.
std::array<Angular<2>, 2> turns(const Vector<2>&) { return {Angular<2>(kTurn), Angular<2>(-kTurn)}; }
std::array<Angular<3>, 4> turns(const Vector<3>& normal) {
  // Not along the edges of a box that lies as it was built: an edge's two ends would tie.
  constexpr double kOffAxes = 0.6;  // [rad]
  const Vector<3> t = normal.unitOrthogonal();
  const Vector<3> o = normal.cross(t);
  const Vector<3> first = kTurn * (std::cos(kOffAxes) * t + std::sin(kOffAxes) * o);
  const Vector<3> second = kTurn * (std::cos(kOffAxes) * o - std::sin(kOffAxes) * t);
  return {first, second, Vector<3>(-first), Vector<3>(-second)};
}

}  // namespace

template <int Dim>
ClosestPoints<Dim> patch_middle(const ConvexSurface<Dim>& surface_1, const Pose<Dim>& pose_1,
                                const ConvexSurface<Dim>& surface_2, const Pose<Dim>& pose_2) {
  ClosestPoints<Dim> middle = closest_points(surface_1, pose_1, surface_2, pose_2);
  const auto sides = turns(middle.normal);
  Vector<Dim> a_1 = Vector<Dim>::Zero();
  Vector<Dim> a_2 = Vector<Dim>::Zero();
  for (const Angular<Dim>& turn : sides) {
    const Pose<Dim> turned = {pose_1.position, pose_1.rotation.turned(turn)};
    const ClosestPoints<Dim> closest = closest_points(surface_1, turned, surface_2, pose_2);
    a_1 += pose_1.to_world(turned.to_body(closest.a_1));
    a_2 += closest.a_2;
  }
  const double count = static_cast<double>(sides.size());
  middle.a_1 = a_1 / count;
  middle.a_2 = a_2 / count;
  return middle;
}

template ClosestPoints<2> patch_middle(const ConvexSurface<2>&, const Pose<2>&, const ConvexSurface<2>&,
                                       const Pose<2>&);
template ClosestPoints<3> patch_middle(const ConvexSurface<3>&, const Pose<3>&, const ConvexSurface<3>&,
                                       const Pose<3>&);

}  // namespace touchstone
