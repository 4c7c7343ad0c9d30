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

/// g(x) = d x + (1 - d), entry by entry, whose fixed point is x = 1; a follower is the sum of the blocks.
struct Iteration {
  std::array<Block, kBlocks> x{};
  Block sum = Block::Zero();

  Iteration(Kind kind, int iterations, bool accelerates = true) {
    x.fill(Block::Zero());
    SweepAcceleration all;
    std::array<SweepAcceleration::Leader<4>, kBlocks> leaders;
    SweepAcceleration::Follower<4> follower;
    all.begin(kind);
    for (int k = 0; k < iterations; ++k) {
      Block change_of_sum = Block::Zero();
      for (int b = 0; b < kBlocks; ++b) {
        Block change;
        for (int e = 0; e < 4; ++e) change[e] = (1 - contraction(b, e)) * (1 - at(b)[e]);
        at(b) += change;
        change_of_sum += change;
        leaders[static_cast<std::size_t>(b)].record(all, change.cast<float>());
      }
      sum += change_of_sum;
      follower.record(all, change_of_sum.cast<float>());
      all.decide();
      if (!accelerates) continue;
      for (int b = 0; b < kBlocks; ++b)
        at(b) += leaders[static_cast<std::size_t>(b)].step(all).cast<double>();
      sum += follower.step(all).cast<double>();
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

TEST(SweepAcceleration, FollowersMoveAsTheLeadersDo) {
  for (const Kind kind : {Kind::anderson, Kind::conjugate_gradients}) {
    const Iteration run(kind, 30);
    Block sum = Block::Zero();
    for (const Block& block : run.x) sum += block;
    // Single precision of eight differences of what adds up to 3, with weights of up to 1 / (1 - 0.97).
    EXPECT_LT((run.sum - sum).cwiseAbs().maxCoeff(), 8 * 3 * 1.2e-7 / (1 - 0.97));
  }
}

/// Where changes stay the same, as where an impulse has to grow until a contact slides, steps get longer.
TEST(SweepAcceleration, ConjugateGradientsGainSpeedWhereChangesStayTheSame) {
  SweepAcceleration all;
  SweepAcceleration::Leader<4> leader;
  all.begin(Kind::conjugate_gradients);
  Block x = Block::Zero();
  constexpr int kIterations = 100;
  for (int k = 0; k < kIterations; ++k) {
    const Block change = Block::Constant(1e-8);
    x += change;
    leader.record(all, change.cast<float>());
    all.decide();
    x += leader.step(all).cast<double>();
  }
  EXPECT_GT(x[0], 10 * kIterations * 1e-8);
}

}  // namespace
}  // namespace touchstone
