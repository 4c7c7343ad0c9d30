#include "baselines/isolation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "baselines/registry.h"
#include "core/model/errors.h"
#include "tests/conformance/scenes.h"
#include "tests/support/bad_method.h"

/// A crash, a hang and a NaN inside a method cost one row each, and not the run.
namespace touchstone {
namespace {

using namespace std::chrono_literals;
using conformance::ball;
using conformance::on_ground;
using conformance::up;
using test::BadMethod;
using test::behave;
using test::crash;
using test::give_up;
using test::hang;
using test::leave;
using test::spoil;

constexpr auto kLong = 60s;
constexpr auto kShort = 200ms;

/// One row: the status of the first step that was not solved, or of the last.
std::string row(void (*misdeed)(BodyState<2>&)) {
  BadMethod method(on_ground(ball<2>("ball", up<2>()), 0.5), misdeed);
  StepReport report;
  for (int k = 0; k < 5 && report.status == StepStatus::solved; ++k) report = method.step(0.01);
  return std::string(to_string(report.status));
}

IsolatedResult run(void (*misdeed)(BodyState<2>&), std::chrono::duration<double> limit = kLong) {
  return run_isolated([&] { return row(misdeed); }, limit);
}

TEST(Isolation, ReturnsWhatTheWorkReturns) {
  const auto result = run(behave);
  EXPECT_EQ(result.outcome, Outcome::finished);
  EXPECT_EQ(result.text, "solved");
}

TEST(Isolation, CrashIsAnOutcome) {
  for (const auto misdeed : {crash, give_up, leave}) {
    const auto result = run(misdeed);
    EXPECT_EQ(result.outcome, Outcome::crashed);
    EXPECT_FALSE(result.text.empty());
  }
  EXPECT_EQ(run(leave).text, "its process ended with exit code 7");
  EXPECT_NE(run(give_up).text.find("signal 6"), std::string::npos) << run(give_up).text;
}

TEST(Isolation, HangIsCutOff) {
  const auto start = std::chrono::steady_clock::now();
  const auto result = run(hang, kShort);
  EXPECT_EQ(result.outcome, Outcome::timed_out);
  EXPECT_EQ(result.text, "no answer within 0.2 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 20s);
}

TEST(Isolation, NonFiniteStateIsARowOfItsOwn) {
  const auto result = run(spoil);
  EXPECT_EQ(result.outcome, Outcome::finished);
  EXPECT_EQ(result.text, "non_finite");
}

TEST(Isolation, ASweepGoesOnAfterEachOfThem) {
  std::string rows;
  for (const auto misdeed : {behave, crash, hang, spoil, behave}) {
    const auto result = run(misdeed, 1s);
    rows += result.outcome == Outcome::finished ? result.text : std::string(to_string(result.outcome));
    rows += ' ';
  }
  EXPECT_EQ(rows, "solved crashed timed_out non_finite solved ");
}

TEST(Isolation, ExceptionsKeepTheirMeaning) {
  const auto refused = run_isolated([]() -> std::string { throw Unsupported("no cones"); }, kLong);
  EXPECT_EQ(refused.outcome, Outcome::unsupported);
  EXPECT_EQ(refused.text, "no cones");
  const auto failed = run_isolated([]() -> std::string { throw InputError("mass", -1.0, "> 0"); }, kLong);
  EXPECT_EQ(failed.outcome, Outcome::failed);
  EXPECT_EQ(failed.text, "mass: got -1, allowed: > 0");
}

TEST(Isolation, AnswersLargerThanAPipeArriveWhole) {
  const std::string large(5'000'000, 'x');
  const auto result = run_isolated([&] { return large + "end"; }, kLong);
  EXPECT_EQ(result.outcome, Outcome::finished);
  EXPECT_TRUE(result.text == large + "end");
}

TEST(Isolation, NothingComesBackButTheAnswer) {
  int value = 1;
  const auto result = run_isolated([&] { return std::to_string(++value); }, kLong);
  EXPECT_EQ(result.text, "2");
  EXPECT_EQ(value, 1);
}

/// Children of one thread inherit the pipes of another's, which must not keep anyone waiting.
TEST(Isolation, SeveralThreadsAtOnce) {
  constexpr int kThreads = 8;
  std::vector<IsolatedResult> results(kThreads);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&results, i] {
      auto& result = results[static_cast<std::size_t>(i)];
      if (i % 4 == 3) {
        result = run(hang, kShort);
      } else if (i % 4 == 2) {
        result = run(crash);
      } else {
        result = run_isolated([i] { return std::to_string(i); }, kLong);
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (int i = 0; i < kThreads; ++i) {
    const auto& result = results[static_cast<std::size_t>(i)];
    const Outcome expected = i % 4 == 3   ? Outcome::timed_out
                             : i % 4 == 2 ? Outcome::crashed
                                          : Outcome::finished;
    EXPECT_EQ(result.outcome, expected) << i;
    if (expected == Outcome::finished) {
      EXPECT_EQ(result.text, std::to_string(i));
    }
  }
}

}  // namespace
}  // namespace touchstone
