#include "experiments/solver_comparison/solving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "experiments/solver_comparison/timing.h"

namespace touchstone::solver_comparison {
namespace {

/// A solver that leaves a hundredth of its tolerance by the judge's measure, and notes what it was asked for.
Solving hundredth(std::vector<double>& asked) {
  return [&asked](double tolerance) {
    asked.push_back(tolerance);
    Answer answer;
    answer.claims_solved = true;
    answer.residual = 1e-2 * tolerance;
    answer.iterations = 7;
    answer.solve_s = 1.0 / static_cast<double>(asked.size());
    return answer;
  };
}

TEST(Measure, TakesTheLoosestToleranceThatTheJudgeLetsPass) {
  std::vector<double> asked;
  const Answer answer = measure(hundredth(asked), 1e-12, 1e-5, 10.0);
  EXPECT_TRUE(answer.is_solved());
  EXPECT_NEAR(answer.residual / 1e-10, 1.0, 1e-9);  // at 1e-8, beyond which it is not
  EXPECT_NEAR(asked.back() / 1e-8, 1.0, 1e-9) << "and is timed there";
  EXPECT_LE(*std::ranges::max_element(asked), 1.1e-7);
  EXPECT_EQ(answer.solved_problems, 1);
  EXPECT_LT(answer.solve_s, 0.2) << "the least of the repetitions";
  EXPECT_EQ(answer.total_s, answer.solve_s);
}

TEST(Measure, AsksForNoMoreThanItIsTold) {
  std::vector<double> asked;
  const Answer answer = measure(hundredth(asked), 1e-12, 1e-12, 10.0);
  EXPECT_EQ(answer.residual, 1e-14);
  EXPECT_EQ(*std::ranges::max_element(asked), 1e-12);
}

TEST(Measure, KeepsTheFirstAnswerWhereThatIsNoSolution) {
  std::vector<double> asked;
  const Answer answer = measure(hundredth(asked), 1e-3, 1e-1, 10.0);
  EXPECT_FALSE(answer.is_solved());
  EXPECT_EQ(answer.residual, 1e-5);
  EXPECT_EQ(answer.solved_problems, 0);
}

TEST(Measure, ALongSolveIsNotRepeated) {
  std::vector<double> asked;
  const Answer answer = measure(hundredth(asked), 1e-3, 1e-1, 0.5);
  EXPECT_EQ(asked.size(), 1u);
  EXPECT_EQ(answer.solve_s, 1.0);
}

/// Ratios of times divide by them, so that none may be zero, however short and whatever the machine's pace.
TEST(Timing, NothingTakesLongerThanNoTime) {
  for (int i = 0; i < 1000; ++i) EXPECT_GE(time_of([] {}), kClockResolution);
}

TEST(Combine, AddsTheStepsOfATrajectory) {
  const auto step = [](double residual, long iterations, double seconds, const char* claim) {
    Answer answer;
    answer.claims_solved = true;
    answer.claim = claim;
    answer.residual = residual;
    answer.iterations = iterations;
    answer.evaluations = iterations + 1;
    answer.solve_s = answer.total_s = seconds;
    return answer;
  };
  const Answer all =
      combine({step(1e-12, 1, 1.0, "solved"), step(1e-3, 2, 5.0, "wrong"), step(0, 3, 2.0, "solved")});
  EXPECT_EQ(all.problems, 3);
  EXPECT_EQ(all.solved_problems, 2);
  EXPECT_EQ(all.iterations, 6);
  EXPECT_EQ(all.evaluations, 9);
  EXPECT_EQ(all.residual, 1e-3);
  EXPECT_FALSE(all.is_solved());
  EXPECT_EQ(all.claim, "wrong");
  EXPECT_EQ(all.solve_s, 2.0);
  EXPECT_EQ(all.total_s, 8.0);
}

}  // namespace
}  // namespace touchstone::solver_comparison
