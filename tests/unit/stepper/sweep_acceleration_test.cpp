// SweepAcceleration on iterations x -> g(x) whose fixed points are known.
#include "core/stepper/sweep_acceleration.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace touchstone {
namespace {

using Kind = SweepAcceleration::Kind;
using Block = Eigen::Vector4d;

constexpr int kBlocks = 3;
/// Five different ones in 12 entries: a Krylov space of five dimensions holds the solution.
constexpr std::array<double, 5> kContractions = {0.97, 0.9, 0.8, 0.5, -0.6};

double contraction(int block, int entry) {
  return kContractions[static_cast<std::size_t>((4 * block + entry) % 5)];
}

/// g(x) = d x + (1 - d), entry by entry, whose fixed point is x = 1.
struct Iteration {
  std::array<Block, kBlocks> x{};

  Iteration(Kind kind, int iterations, bool accelerates = true) {
    x.fill(Block::Zero());
    SweepAcceleration all;
    std::array<SweepAcceleration::Block<4>, kBlocks> memories;
    all.begin(kind);
    for (int k = 0; k < iterations; ++k) {
      for (int b = 0; b < kBlocks; ++b) {
        Block change;
        for (int e = 0; e < 4; ++e) change[e] = (1 - contraction(b, e)) * (1 - at(b)[e]);
        at(b) += change;
        memories[static_cast<std::size_t>(b)].record(all, change.cast<float>());
      }
      all.decide();
      if (!accelerates) continue;
      for (int b = 0; b < kBlocks; ++b)
        at(b) += memories[static_cast<std::size_t>(b)].step(all).cast<double>();
    }
  }

  Block& at(int b) { return x[static_cast<std::size_t>(b)]; }
  [[nodiscard]] double error() const {
    double worst = 0;
    for (const Block& block : x) worst = std::max(worst, (block.array() - 1).abs().maxCoeff());
    return worst;
  }
};

TEST(SweepAcceleration, AndersonSolvesALinearIterationInAboutAsManyStepsAsItHasContractions) {
  EXPECT_LT(Iteration(Kind::anderson, 8).error(), 1e-3);
  EXPECT_GT(Iteration(Kind::anderson, 8, false).error(), 0.7);  // 0.97^8 = 0.78
}

TEST(SweepAcceleration, SinglePrecisionOfMemoriesDoesNotMoveTheFixedPoint) {
  EXPECT_LT(Iteration(Kind::anderson, 40).error(), 1e-14);
  EXPECT_LT(Iteration(Kind::conjugate_gradients, 400).error(), 1e-14);
}

TEST(SweepAcceleration, ConjugateGradientsAreFasterThanNothing) {
  EXPECT_LT(Iteration(Kind::conjugate_gradients, 60).error(),
            0.1 * Iteration(Kind::anderson, 60, false).error());
}

/// Where changes stay the same, as where an impulse has to grow until a contact slides, steps get longer.
TEST(SweepAcceleration, ConjugateGradientsGainSpeedWhereChangesStayTheSame) {
  SweepAcceleration all;
  SweepAcceleration::Block<4> memory;
  all.begin(Kind::conjugate_gradients);
  Block x = Block::Zero();
  constexpr int kIterations = 100;
  for (int k = 0; k < kIterations; ++k) {
    const Block change = Block::Constant(1e-8);
    x += change;
    memory.record(all, change.cast<float>());
    all.decide();
    x += memory.step(all).cast<double>();
  }
  EXPECT_GT(x[0], 10 * kIterations * 1e-8);
}

}  // namespace
}  // namespace touchstone
