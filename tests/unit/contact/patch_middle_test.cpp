// The start in the middle of a patch: for a box on a plane well inside its base, for a ball where it touches.
#include "core/contact/patch_middle.h"

#include <gtest/gtest.h>

#include "tests/unit/surfaces/gallery.h"

namespace touchstone::testing {
namespace {

template <int Dim>
std::shared_ptr<const ConvexSurface<Dim>> surface_of(typename Geometry<Dim>::Variant geometry) {
  Shape<Dim> shape;
  shape.geometry = std::move(geometry);
  return make_surface(shape);
}

TEST(PatchMiddle, OfABoxOnAPlaneIsTheMiddleOfItsBase) {
  const auto box = surface_of<3>(Box<3>{{0.5, 0.3, 0.2}});
  const auto plane = surface_of<3>(HalfSpace<3>{});
  for (const double turn : {0.0, 0.4, 1.1}) {
    Pose<3> pose;
    pose.position = {1, 2, 0.2};
    // Tilted by less than a step can see, as on a slope by rounding: the lowest point is a corner.
    pose.rotation = SpatialRotation(exp_rotation(Vector<3>(0, 0, turn))).turned(Vector<3>(1e-12, 2e-12, 0));
    const auto corner = closest_points<3>(*box, pose, *plane, {});
    const auto middle = patch_middle<3>(*box, pose, *plane, {});
    EXPECT_EQ(middle.normal, corner.normal);
    EXPECT_EQ(middle.gap, corner.gap);
    EXPECT_GT((corner.a_1 - pose.position).head<2>().norm(), 0.3) << "the control: a corner";
    EXPECT_LE((middle.a_1 - pose.position).head<2>().norm(), 1e-3) << "turned by " << turn;
    EXPECT_NEAR(middle.a_1.z(), 0, 1e-11);
  }
}

TEST(PatchMiddle, OfASquareOnALineIsTheMiddleOfItsEdge) {
  const auto square = surface_of<2>(Box<2>{{0.5, 0.2}});
  const auto line = surface_of<2>(HalfSpace<2>{});
  Pose<2> pose;
  pose.position = {3, 0.2};
  EXPECT_LE((patch_middle<2>(*square, pose, *line, {}).a_1 - Vector<2>(3, 0)).norm(), 1e-3);
}

TEST(PatchMiddle, OfABoxOnABoxIsWithinBoth) {
  const auto box = surface_of<3>(Box<3>{{0.5, 0.5, 0.2}});
  Pose<3> upper;
  upper.position = {0.4, 0.3, 0.4};
  const auto middle = patch_middle<3>(*box, upper, *box, {});
  EXPECT_NEAR(middle.normal.z(), 1, 1e-9);
  EXPECT_LT(middle.a_1.x(), 0.5 - 0.05);
  EXPECT_GT(middle.a_1.x(), -0.1 + 0.05);
  EXPECT_LT(middle.a_1.y(), 0.5 - 0.05);
  EXPECT_GT(middle.a_1.y(), -0.2 + 0.05);
}

TEST(PatchMiddle, WhereBodiesTouchInAPointIsThatPoint) {
  const auto ball = surface_of<3>(Sphere<3>{0.7});
  const auto plane = surface_of<3>(HalfSpace<3>{});
  Pose<3> pose;
  pose.position = {1, -1, 0.7};
  EXPECT_LE((patch_middle<3>(*ball, pose, *plane, {}).a_1 - Vector<3>(1, -1, 0)).norm(), 1e-4 * 0.7);
}

}  // namespace
}  // namespace touchstone::testing
