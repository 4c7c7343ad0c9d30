#include "experiments/harness/sweep.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/model/errors.h"
#include "experiments/harness/interrupt.h"
#include "experiments/harness/progress.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::harness {
namespace {

using test::Scratch;

Case numbered_case(int number, std::function<CaseResult()> run) {
  Case one;
  one.id = {"scenario", "method", "", {std::to_string(number)}, 0.01, 1};
  one.cost = number;
  one.run = std::move(run);
  return one;
}

std::vector<Case> counting_cases(int count, std::atomic<int>& runs) {
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    cases.push_back(numbered_case(i, [i, &runs] {
      ++runs;
      std::this_thread::sleep_for(std::chrono::microseconds((i * 37) % 11 * 100));
      return CaseResult{CaseStatus::ok, "", {{{std::to_string(i)}}}};
    }));
  }
  return cases;
}

TEST(Sweep, ResultsComeInCaseOrderFromAnyNumberOfThreads) {
  const Scratch scratch;
  for (const int jobs : {1, 2, 7, 100}) {
    std::atomic<int> runs = 0;
    const auto cases = counting_cases(50, runs);
    Journal journal(scratch / std::to_string(jobs), "stamp");
    const auto results = run_sweep(cases, {}, jobs, "test", journal);
    ASSERT_EQ(results.size(), cases.size());
    EXPECT_EQ(runs, 50);
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_TRUE(results[i]);
      EXPECT_EQ(results[i]->result.tables[0][0][0], std::to_string(i));
    }
  }
}

TEST(Sweep, WhatACaseThrowsBecomesItsStatusAndReason) {
  const auto result = [](std::function<CaseResult()> run) { return run_one(numbered_case(0, run)).result; };
  const CaseResult unsupported = result([]() -> CaseResult { throw Unsupported("no ellipsoids"); });
  EXPECT_EQ(unsupported.status, CaseStatus::unsupported);
  EXPECT_EQ(unsupported.reason, "no ellipsoids");
  const CaseResult failed = result([]() -> CaseResult { throw std::runtime_error("diverged"); });
  EXPECT_EQ(failed.status, CaseStatus::failed);
  EXPECT_EQ(failed.reason, "diverged");
  EXPECT_THROW(result([]() -> CaseResult { throw Interrupted{}; }), Interrupted);
}

TEST(Sweep, RunsOnlyWhatIsNotFinishedAndJournalsTheRest) {
  const Scratch scratch;
  std::atomic<int> runs = 0;
  const auto cases = counting_cases(10, runs);
  {
    Journal journal(scratch / "j", "stamp");
    const std::vector<Case> some(cases.begin(), cases.begin() + 4);
    run_sweep(some, {}, 2, "test", journal);
  }
  runs = 0;
  Journal journal(scratch / "j", "stamp");
  const auto results = run_sweep(cases, journal.finished(), 2, "test", journal);
  EXPECT_EQ(runs, 6);
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(results[i].value().result.tables[0][0][0], std::to_string(i));
  }
}

TEST(Sweep, StopsAtAnInterruptAndKeepsWhatIsFinished) {
  const Scratch scratch;
  const InterruptScope scope;
  std::vector<Case> cases;
  for (int i = 0; i < 10; ++i) {
    cases.push_back(numbered_case(i, [i]() -> CaseResult {
      if (i == 7) ::kill(::getpid(), SIGINT);
      while (i == 7) throw_if_interrupted();
      return {CaseStatus::ok, "", {}};
    }));
  }
  Journal journal(scratch / "j", "stamp");
  // Costly first: 9 and 8 finish, 7 is interrupted, the rest never starts.
  const auto results = run_sweep(cases, {}, 1, "test", journal);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i].has_value(), i >= 8) << i;
}

TEST(Sweep, ACaseThatIsNoExceptionOfOursIsStillARow) {
  const Scratch scratch;
  Journal journal(scratch / "j", "stamp");
  const std::vector<Case> cases = {numbered_case(0, []() -> CaseResult { throw std::bad_alloc(); })};
  const auto results = run_sweep(cases, {}, 1, "test", journal);
  EXPECT_EQ(results[0].value().result.status, CaseStatus::failed);
}

TEST(Progress, DurationsAreForPeople) {
  EXPECT_EQ(format_duration(0.04), "0.0 s");
  EXPECT_EQ(format_duration(12.34), "12.3 s");
  EXPECT_EQ(format_duration(59.97), "1 min 00 s");
  EXPECT_EQ(format_duration(245), "4 min 05 s");
  EXPECT_EQ(format_duration(7620), "2 h 07 min");
}

TEST(Progress, SaysNothingInTheFirstSecondAndPlainLinesToAFile) {
  const Scratch scratch;
  std::FILE* file = std::fopen((scratch / "err").c_str(), "w");
  {
    Progress progress("roll", 10, 40.0, file);
    progress.show(1, 10.0);
    EXPECT_EQ(test::slurp(scratch / "err"), "");
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    progress.show(2, 20.0);
    progress.show(3, 30.0);  // too soon after the last
  }
  std::fclose(file);
  const std::string text = test::slurp(scratch / "err");
  EXPECT_EQ(text.rfind("roll: 2/10 cases, 1.", 0), 0u) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

}  // namespace
}  // namespace touchstone::harness
