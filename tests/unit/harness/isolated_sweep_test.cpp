// Methods that crash, hang or spoil their state cost a row each, and not the sweep.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "experiments/harness/interrupt.h"
#include "experiments/harness/sweep.h"
#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using namespace std::chrono_literals;
using test::Finished;
using test::listing;
using test::Process;
using test::Scratch;
using test::slurp;

std::vector<std::string> bad(const std::filesystem::path& out, std::vector<std::string> words) {
  words.insert(words.begin(), {BAD_EXPERIMENT, "--out", out.string()});
  return words;
}

const char* const kEachCostsItsRow =
    "experiment,scenario,method,options,number,h_s,until_s,status,reason,steps\n"
    "bad,bad,crashes,a=1,1,0.5,5,failed,its process was ended by signal 11 (Segmentation fault),\n"
    "bad,bad,crashes_on_loading,,1,0.5,5,failed,its process was ended by signal 6 (Aborted),\n"
    "bad,bad,fine,a=1,1,0.5,5,ok,,10\n"
    "bad,bad,hangs,a=1,1,0.5,5,failed,no answer within 1 s,\n"
    "bad,bad,leaves,a=1,1,0.5,5,failed,its process ended with exit code 7,\n"
    "bad,bad,ours,a=1,1,0.5,5,ok,,10\n"
    "bad,bad,spoils,a=1,1,0.5,5,failed,step 3 from t = 1 s: non_finite,2\n";

TEST(IsolatedSweep, EachBadMethodCostsItsRowFromAnyNumberOfThreads) {
  const Scratch scratch;
  for (const char* jobs : {"1", "2", "7"}) {
    const Finished run = test::run(
        bad(scratch / jobs, {"--methods", "hangs,ours,crashes,spoils,leaves,crashes_on_loading,fine",
                             "--time-limit", "1", "--jobs", jobs}));
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(slurp(scratch / jobs / "summary.csv"), kEachCostsItsRow);
    EXPECT_EQ(listing(scratch / jobs), "environment.json summary.csv summary.meta.json timing.csv");
  }
}

TEST(IsolatedSweep, BadOptionsAreBadInputFromAnEngineToo) {
  const Scratch scratch;
  const Finished run = test::run(bad(scratch / "out", {"--methods", "refuses"}));
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("option 'a': got 1, allowed: none"), std::string::npos) << run.err;
}

TEST(IsolatedSweep, WhichMethodsAreIsolatedIsAChoice) {
  const Scratch scratch;
  const auto code = [&](const char* which, const char* method) {
    return test::run(bad(scratch / "out", {"--methods", method, "--isolate", which})).code;
  };
  EXPECT_EQ(code("never", "crashes"), -SIGSEGV);
  EXPECT_EQ(code("auto", "ours_crashes"), -SIGSEGV);
  EXPECT_EQ(code("always", "ours_crashes"), 1);
  EXPECT_EQ(code("sometimes", "fine"), 2);
}

/// The process that hangs, once it has told which it is.
pid_t hanging_process(const std::filesystem::path& file) {
  for (int i = 0; i < 4000; ++i) {
    const std::string text = std::filesystem::exists(file) ? slurp(file) : "";
    if (text.ends_with('\n')) return std::stoi(text);
    std::this_thread::sleep_for(5ms);
  }
  ADD_FAILURE() << "it never hung";
  return 0;
}

/// Whether the process has ended, or does within some seconds. One that nobody has waited for yet has.
bool ends(pid_t pid) {
  for (int i = 0; i < 1000; ++i) {
    const std::filesystem::path status = "/proc/" + std::to_string(pid) + "/status";
    if (!std::filesystem::exists(status)) return true;
    try {
      if (slurp(status).find("State:\tZ") != std::string::npos) return true;
    } catch (const std::exception&) {
      return true;  // it ended in between
    }
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

TEST(IsolatedSweep, AnInterruptEndsTheChildrenTooAndKeepsWhatIsFinished) {
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const Scratch scratch;
    const auto file = scratch / "pid";
    setenv("TOUCHSTONE_TEST_PID", file.c_str(), 1);
    Process process(bad(scratch / "out", {"--methods", "fine,hangs", "--jobs", "2"}));
    const pid_t child = hanging_process(file);
    const auto start = std::chrono::steady_clock::now();
    process.signal(signal);
    EXPECT_EQ(process.wait().code, signal == SIGKILL ? -SIGKILL : 130);
    EXPECT_TRUE(ends(child)) << "process " << child << " outlives signal " << signal;
    EXPECT_LT(std::chrono::steady_clock::now() - start, 20s);
    EXPECT_EQ(listing(scratch / "out"), "bad.journal");

    const Finished resumed =
        test::run(bad(scratch / "out", {"--methods", "fine,hangs", "--time-limit", "1", "--jobs", "2"}));
    EXPECT_EQ(resumed.code, 1) << resumed.err;
    EXPECT_NE(slurp(scratch / "out/summary.csv").find("hangs,a=1,1,0.5,5,failed,no answer within 1 s,"),
              std::string::npos);
    unsetenv("TOUCHSTONE_TEST_PID");
  }
}

Case engine_case(const std::string& method, std::function<CaseResult()> run) {
  Case one;
  one.id = {"scenario", method, "", {}, 0.01, 1};
  one.engine_version = "1.0";
  one.run = std::move(run);
  return one;
}

TEST(IsolatedSweep, ACaseThatHadTooLittleTimeIsNotJournalled) {
  const Scratch scratch;
  const std::vector<Case> cases = {
      engine_case("slow",
                  []() -> CaseResult {
                    std::this_thread::sleep_for(60s);
                    return {};
                  }),
      engine_case("throws", []() -> CaseResult { throw std::runtime_error("a reason"); })};
  {
    Journal journal(scratch / "j", "stamp");
    const auto results =
        run_sweep(cases, {}, 2, "test", journal, {.isolate = Isolate::automatic, .time_limit = 300ms});
    EXPECT_TRUE(results[0].value().timed_out);
    EXPECT_EQ(results[1].value().result.reason, "a reason");
  }
  const FinishedCases kept = read_journal(scratch / "j", "stamp");
  EXPECT_EQ(kept.size(), 1u);
  EXPECT_TRUE(kept.contains(case_key(cases[1].id)));
}

TEST(IsolatedSweep, NothingOfAChildComesBackButItsResult) {
  const Scratch scratch;
  int touched = 0;
  const std::vector<Case> cases = {engine_case("method", [&]() -> CaseResult {
    ++touched;
    return {CaseStatus::ok, "", {{{"a,b\n\"c\""}, {""}}, {}}};
  })};
  Journal journal(scratch / "j", "stamp");
  const auto results = run_sweep(cases, {}, 1, "test", journal);
  EXPECT_EQ(touched, 0);
  const std::vector<std::vector<Row>> expected = {{{"a,b\n\"c\""}, {""}}, {}};
  EXPECT_EQ(results[0].value().result.tables, expected);
}

}  // namespace
}  // namespace touchstone::harness
