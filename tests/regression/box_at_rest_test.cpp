// A box at rest stays at rest, to the last digits and for as long as one likes.
#include <gtest/gtest.h>

#include "core/model/mass_properties.h"
#include "core/stepper/implicit_stepper.h"
#include "experiments/scenarios/box_on_incline.h"
#include "tests/regression/sanitized.h"

namespace touchstone {
namespace {

constexpr int kSteps = testing::kSanitized ? 5000 : 100000;

constexpr double kStep = 0.01;  // [s]

/// @param fastest_allowed  [m/s], [rad/s]
template <int Dim>
void expect_rest(const Scene<Dim>& scene, double fastest_allowed) {
  ImplicitStepper<Dim> stepper(scene, {});
  const BodyState<Dim> start = stepper.state()[0];
  double fastest = 0;
  for (int k = 0; k < kSteps; ++k) {
    ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved) << "step " << k;
    fastest = std::max(fastest, stepper.state()[0].velocity.cwiseAbs().maxCoeff());
  }
  EXPECT_LE(fastest, fastest_allowed);
  const Pose<Dim>& end = stepper.state()[0].pose;
  // A velocity of rounding size must not add up either: 1e5 steps of 1e-12 m/s would be 1e-9 m.
  EXPECT_LE((end.position - start.pose.position).norm(), 1e-12);
  EXPECT_LE((end.rotation.matrix() - start.pose.rotation.matrix()).norm(), 1e-12);
}

TEST(BoxAtRest, DoesNotDriftOnAPlaneInSpace) {
  Scene<3> scene = box_on_incline_scene<3>({.aspect = 1.4, .tangent = 1e-300, .mu = 0.5});
  scene.bodies[0].pose.rotation = SpatialRotation(exp_rotation(Vector<3>(0, 0, 0.3)));
  expect_rest(scene, 1e-12);
}

/// On a slope no coordinate stays 0 by itself. A step may leave a gap of the solver's tolerance, 1e-13 of the
/// body's size, on either side, and another then closes it within h.
constexpr double kCorrection = 2 * 1e-13 / kStep;

TEST(BoxAtRest, DoesNotCreepDownASlopeInSpace) {
  expect_rest(box_on_incline_scene<3>({.aspect = 1.2, .tangent = 0.75, .mu = 0.8}), kCorrection);
}

TEST(BoxAtRest, DoesNotCreepDownASlopeInThePlane) {
  expect_rest(box_on_incline_scene<2>({.aspect = 1.2, .tangent = 0.75, .mu = 0.8}), kCorrection);
}

TEST(BoxAtRest, MovesIfItMust) {
  // The control: with a little less friction than the slope's tangent the same run is no rest.
  ImplicitStepper<3> stepper(box_on_incline_scene<3>({.aspect = 1.2, .tangent = 0.75, .mu = 0.7499}), {});
  for (int k = 0; k < 100; ++k) ASSERT_EQ(stepper.step(0.01).status, StepStatus::solved);
  EXPECT_GT(stepper.state()[0].velocity.norm(), 1e-4);
}

}  // namespace
}  // namespace touchstone
