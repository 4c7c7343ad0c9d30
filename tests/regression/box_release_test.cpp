// A box that is let go on an incline: every first step is solved, from no start but the scene, and on the
// right side of the thresholds.
#include <gtest/gtest.h>

#include <random>

#include "core/stepper/implicit_stepper.h"
#include "experiments/scenarios/box_on_incline.h"
#include "tests/regression/sanitized.h"

namespace touchstone {
namespace {

using Start = truth::BlockOnIncline::Start;

template <int Dim>
void expect_right_release(const InclineCell& cell) {
  constexpr int kSteps = 5;
  constexpr double kStep = 0.001;
  ImplicitStepper<Dim> stepper(box_on_incline_scene<Dim>(cell), {});
  for (int k = 0; k < kSteps; ++k) {
    ASSERT_EQ(stepper.step(kStep).status, StepStatus::solved)
        << "step " << k << " of b/h " << cell.aspect << " tan " << cell.tangent << " mu " << cell.mu;
  }
  const double t = kSteps * kStep;
  const truth::BlockRelease truth = truth::release(cell.block());
  const InclineMotion motion = incline_motion<Dim>(cell, stepper.state()[0]);
  EXPECT_EQ(to_string(incline_mode(cell, motion, t)), to_string(truth.mode))
      << "b/h " << cell.aspect << " tan " << cell.tangent << " mu " << cell.mu;
  // Flat, the scheme has the closed form exactly; tipping, up to the turn of g t^2 / L.
  const bool flat = truth.mode == Start::rests || truth.mode == Start::slides;
  EXPECT_NEAR(motion.slip / t, truth.edge_along, flat ? 1e-8 : 1e-2);
  EXPECT_NEAR(motion.tip / t, truth.angular, flat ? 1e-8 : 1e-2);
}

/// Random cells, none nearer to a threshold than what five steps of turning can move it.
std::vector<InclineCell> random_cells(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<InclineCell> cells;
  while (static_cast<int>(cells.size()) < count) {
    InclineCell cell;
    cell.aspect = 0.3 + 1.2 * uniform(random);
    cell.tangent = 0.05 + 2 * uniform(random);
    cell.mu = 0.05 + 2 * uniform(random);
    const auto near = [](double a, double b) { return std::abs(a / b - 1) < 1e-3; };
    if (near(cell.mu, cell.tangent) || near(cell.mu, cell.aspect) || near(cell.tangent, cell.aspect))
      continue;
    if (near(cell.mu, cell.block().friction_to_tip_in_place())) continue;
    cells.push_back(cell);
  }
  return cells;
}

TEST(BoxRelease, IsRightInRandomCells) {
  for (const InclineCell& cell : random_cells(testing::kSanitized ? 100 : 3000)) {
    expect_right_release<3>(cell);
    expect_right_release<2>(cell);
  }
}

TEST(BoxRelease, IsRightHalfAPerMilleBesideEveryThreshold) {
  for (const InclineCell& cell : incline_cells({{0.4, 0.8, 1.2}, {}, {}, {5e-4}})) {
    expect_right_release<3>(cell);
    expect_right_release<2>(cell);
  }
}

TEST(BoxRelease, TipsWithMuchFrictionFromTheCornerThatTheClosestPointsAre) {
  // Newton's method from a corner of the base does not get to the middle of its lower edge here.
  expect_right_release<3>({.aspect = 0.8, .tangent = 0.9, .mu = 1.6});
  expect_right_release<3>({.aspect = 0.4, .tangent = 0.9, .mu = 1.6});
}

TEST(InclineCells, EveryModeIsFarFromTheDecisionsThatTellIt) {
  // What the truth moves it moves by twice what counts as moving at least.
  const InclineGrid grid = {
      {0.4, 0.8, 1.2}, {0.1, 0.3, 0.5, 0.9, 1.3, 1.7}, {0.15, 0.35, 0.55, 0.85, 1.25, 1.6}, {5e-4}};
  const auto cells = incline_cells(grid);
  EXPECT_EQ(cells.size(), 180u);
  for (const InclineCell& cell : cells) {
    const truth::BlockOnIncline block = cell.block();
    const truth::BlockRelease truth = truth::release(block);
    EXPECT_EQ(truth.consistent_modes, 1);
    const double slip = truth.edge_along / block.gravity;
    const double tip = truth.angular * std::hypot(block.base, block.height) / 2 / block.gravity;
    EXPECT_TRUE(slip == 0 || slip > 2 * kStill) << slip;
    EXPECT_TRUE(tip == 0 || tip > 2 * kStill) << tip;
    const InclineMotion motion = {truth.edge_along * 0.1, truth.angular * 0.1};
    EXPECT_EQ(incline_mode(cell, motion, 0.1), truth.mode);
  }
}

}  // namespace
}  // namespace touchstone
