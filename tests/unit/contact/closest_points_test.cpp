// Closest points from cold for every pair of shapes, from deep overlap to a thousand sizes apart, judged by
// their certificate: both points on their surfaces, and no point of either body beyond the plane through its
// point across the normal. For bodies that are apart that proves the distance; for bodies that overlap it
// proves that moving them by -gap along the normal parts them.
#include "core/contact/closest_points.h"

#include <gtest/gtest.h>

#include "tests/unit/surfaces/gallery.h"

namespace touchstone::testing {
namespace {

template <int Dim>
double outside(const ConvexSurface<Dim>& surface, const Vector<Dim>& x) {
  double largest = surface.value(0, x);
  for (int i = 1; i < surface.count(); ++i) largest = std::max(largest, surface.value(i, x));
  return largest;
}

/// n . x over the body at its farthest along n, world frame.
template <int Dim>
double reach(const ConvexSurface<Dim>& surface, const Pose<Dim>& pose, const Vector<Dim>& n) {
  const Matrix<Dim> rotation = pose.rotation.matrix();
  return n.dot(pose.position) + n.dot(rotation * surface.support(rotation.transpose() * n));
}

/// @returns what the certificate is violated by, over size + distance
template <int Dim>
double defect(const ConvexSurface<Dim>& one, const Pose<Dim>& pose_1, const ConvexSurface<Dim>& two,
              const Pose<Dim>& pose_2, const ClosestPoints<Dim>& found) {
  const Vector<Dim>& n = found.normal;
  const double size = one.bounding_ball().radius + two.bounding_ball().radius + std::abs(found.gap);
  double worst = std::abs(n.norm() - 1) * size;
  worst = std::max(worst, std::abs(outside(one, pose_1.to_body(found.a_1))));
  worst = std::max(worst, std::abs(outside(two, pose_2.to_body(found.a_2))));
  worst = std::max(worst, (found.a_1 - found.a_2 - found.gap * n).norm());
  worst = std::max(worst, reach<Dim>(two, pose_2, n) - n.dot(found.a_2));
  worst = std::max(worst, reach<Dim>(one, pose_1, -n) + n.dot(found.a_1));
  return worst / size;
}

/// Centres apart by this many times the sum of the sizes: deep in each other, touching, near, far.
constexpr double kApart[] = {0.02, 0.2, 0.6, 0.95, 1.3, 3, 30, 1000};

template <int Dim>
void expect_certified(const Exhibit<Dim>& exhibit) {
  const auto one = make_surface(exhibit.shape);
  Random random(11);
  int overlaps = 0;
  int clear = 0;
  for (const Exhibit<Dim>& partner : gallery<Dim>()) {
    const auto two = make_surface(partner.shape);
    const double size = one->bounding_ball().radius + two->bounding_ball().radius;
    for (const double apart : kApart) {
      Pose<Dim> pose_1;
      pose_1.rotation = random_rotation<Dim>(random);
      pose_1.position = random_point<Dim>(random, Vector<Dim>::Zero(), 2);
      Pose<Dim> pose_2;
      pose_2.rotation = random_rotation<Dim>(random);
      pose_2.position = pose_1.to_world(one->bounding_ball().center) +
                        apart * size * random_direction<Dim>(random) -
                        pose_2.rotation.matrix() * two->bounding_ball().center;
      const ClosestPoints<Dim> found = closest_points(*one, pose_1, *two, pose_2);
      EXPECT_TRUE(found.converged) << partner.name << " apart " << apart << " gap " << found.gap;
      // An inequality f has a gradient of order one, so that its value is a distance up to a small factor.
      EXPECT_LE(defect(*one, pose_1, *two, pose_2, found), 1e-11) << partner.name << " apart " << apart;
      (found.gap < 0 ? overlaps : clear) += 1;
      const ClosestPoints<Dim> swapped = closest_points(*two, pose_2, *one, pose_1);
      if (found.gap > 0) {
        EXPECT_NEAR(swapped.gap, found.gap, 1e-11 * (size + found.gap)) << partner.name;
      }
    }
  }
  EXPECT_GT(overlaps, 20) << "overlap is tried";
  EXPECT_GT(clear, 20) << "distance is tried";
}

template <int Dim>
void expect_certified_against_plane(const Exhibit<Dim>& exhibit) {
  const auto body = make_surface(exhibit.shape);
  Random random(12);
  for (const double apart : kApart) {
    HalfSpace<Dim> half_space;
    half_space.normal = random_direction<Dim>(random);
    half_space.offset = 0.3;
    Shape<Dim> shape;
    shape.geometry = half_space;
    const auto plane = make_surface(shape);
    Pose<Dim> pose_1;
    pose_1.rotation = random_rotation<Dim>(random);
    Pose<Dim> pose_2;
    pose_2.rotation = random_rotation<Dim>(random);
    const Vector<Dim> n = pose_2.rotation.matrix() * half_space.normal;
    pose_1.position = apart * body->bounding_ball().radius * n;
    const ClosestPoints<Dim> found = closest_points(*body, pose_1, *plane, pose_2);
    EXPECT_TRUE(found.converged);
    EXPECT_LE((found.normal - n).norm(), 1e-14);
    EXPECT_LE((found.a_1 - found.a_2 - found.gap * n).norm(), 1e-12 * (1 + apart));
    EXPECT_NEAR(n.dot(found.a_2) - n.dot(pose_2.position), half_space.offset, 1e-12 * (1 + apart));
    EXPECT_NEAR(-reach<Dim>(*body, pose_1, -n), n.dot(found.a_1), 1e-12 * (1 + apart));
    const ClosestPoints<Dim> swapped = closest_points(*plane, pose_2, *body, pose_1);
    EXPECT_LE((swapped.normal + n).norm(), 1e-14);
    EXPECT_NEAR(swapped.gap, found.gap, 1e-12 * (1 + apart));
  }
}

TEST(ClosestPointsOfBalls, AreTheClosedForm) {
  Random random(13);
  Shape<3> shape;
  shape.geometry = Sphere<3>{0.7};
  const auto ball = make_surface(shape);
  for (const double apart : {0.01, 0.5, 1.4, 1.400001, 20.0, 1e5}) {
    Pose<3> other;
    other.position = apart * random_direction<3>(random);
    const auto found = closest_points<3>(*ball, other, *ball, {});
    EXPECT_NEAR(found.gap, apart - 1.4, 1e-12 * (1 + apart));
    EXPECT_LE((found.normal - other.position / apart).norm(), 1e-10);
  }
}

class PlanarClosestPoints : public ::testing::TestWithParam<Exhibit<2>> {};
class SpatialClosestPoints : public ::testing::TestWithParam<Exhibit<3>> {};

TEST_P(PlanarClosestPoints, AreCertifiedForEveryPairAndDistance) { expect_certified(GetParam()); }
TEST_P(SpatialClosestPoints, AreCertifiedForEveryPairAndDistance) { expect_certified(GetParam()); }
TEST_P(PlanarClosestPoints, AreCertifiedAgainstAPlane) { expect_certified_against_plane(GetParam()); }
TEST_P(SpatialClosestPoints, AreCertifiedAgainstAPlane) { expect_certified_against_plane(GetParam()); }

constexpr auto kName = [](const auto& exhibit) { return exhibit.param.name; };
INSTANTIATE_TEST_SUITE_P(Gallery, PlanarClosestPoints, ::testing::ValuesIn(gallery<2>()), kName);
INSTANTIATE_TEST_SUITE_P(Gallery, SpatialClosestPoints, ::testing::ValuesIn(gallery<3>()), kName);

}  // namespace
}  // namespace touchstone::testing
