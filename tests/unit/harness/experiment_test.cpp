// The toy experiment as a program: files, exit codes, interrupts, parts.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using test::Finished;
using test::listing;
using test::Process;
using test::Scratch;
using test::slurp;
using test::spit;

std::vector<std::string> toy(const std::filesystem::path& out, std::vector<std::string> words = {}) {
  words.insert(words.begin(), {TOY_EXPERIMENT, "--out", out.string()});
  return words;
}

const char* const kSummary =
    "experiment,scenario,method,options,number,h_s,until_s,status,reason,square\n"
    "toy,toy,fine,,7,0.5,10,ok,,49\n"
    "toy,toy,fine,,8,0.5,10,ok,,64\n"
    "toy,toy,fine,,9,0.5,10,ok,,81\n"
    "toy,toy,fine,,10,0.5,10,ok,,100\n";

const char* const kFiles =
    "curve.csv curve.meta.json environment.json summary.csv summary.meta.json timing.csv";

TEST(Experiment, WritesItsTablesAndWhereTheyComeFrom) {
  const Scratch scratch;
  const Finished run = test::run(toy(scratch / "out"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(listing(scratch / "out"), kFiles);
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), kSummary);
  EXPECT_NE(slurp(scratch / "out/curve.csv").find("toy,toy,fine,,7,0.5,10,ok,,0.5,2\n"), std::string::npos);
  EXPECT_NE(run.out.find("4 cases: 4 ok"), std::string::npos) << run.out;

  const auto meta = nlohmann::json::parse(slurp(scratch / "out/summary.meta.json"));
  EXPECT_EQ(meta["command"], "toy --methods fine --numbers 10,9,8,7 --milliseconds 1 --until 10");
  EXPECT_EQ(meta["seed"], 42);
  EXPECT_EQ(meta["table"], "summary");
  EXPECT_EQ(meta["engines"]["fine"], "1.2.3");
  EXPECT_TRUE(meta["sources"].contains("core") && meta["sources"].contains("baselines"));
  const auto environment = nlohmann::json::parse(slurp(scratch / "out/environment.json"));
  for (const char* key : {"host", "compiler", "build_type", "flags", "dirty", "started", "wall_s", "jobs"}) {
    EXPECT_TRUE(environment.contains(key)) << key;
  }
}

TEST(Experiment, GivesTheSameBytesAgainAndFromAnyNumberOfThreads) {
  const Scratch scratch;
  EXPECT_EQ(test::run(toy(scratch / "one", {"--jobs", "1"})).code, 0);
  EXPECT_EQ(test::run(toy(scratch / "two", {"--jobs", "2"})).code, 0);
  for (const char* name : {"summary.csv", "curve.csv", "summary.meta.json", "curve.meta.json"}) {
    EXPECT_EQ(slurp(scratch / "one" / name), slurp(scratch / "two" / name)) << name;
  }
}

TEST(Experiment, ACaseThatFailsIsARowAndExitCodeOne) {
  const Scratch scratch;
  const Finished run = test::run(toy(scratch / "out", {"--methods", "fine,throws", "--numbers", "3"}));
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("failed: toy,throws"), std::string::npos) << run.err;
  const std::string summary = slurp(scratch / "out/summary.csv");
  EXPECT_NE(summary.find("toy,toy,fine,,3,0.5,10,ok,,9\n"), std::string::npos);
  EXPECT_NE(summary.find("toy,toy,throws,,3,0.5,10,failed,\"a reason, with a comma\",\n"), std::string::npos);
}

TEST(Experiment, WhatIsUnsupportedIsARowAndNoFailure) {
  const Scratch scratch;
  EXPECT_EQ(test::run(toy(scratch / "out", {"--methods", "unsupported", "--numbers", "3"})).code, 0);
  EXPECT_NE(slurp(scratch / "out/summary.csv").find("3,0.5,10,unsupported,no such shape,\n"),
            std::string::npos);
}

TEST(Experiment, BadInputIsExitCodeTwoAndTouchesNothing) {
  const Scratch scratch;
  ASSERT_EQ(test::run(toy(scratch / "out")).code, 0);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"--numbers", "0"}, {"--until", "nan"}, {"--nothing"}, {"--shard", "3/2"}, {"stray"}}) {
    const Finished run = test::run(toy(scratch / "out", words));
    EXPECT_EQ(run.code, 2) << words[0];
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find(words[0]), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << "one message: " << run.err;
  }
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), kSummary);
  EXPECT_EQ(listing(scratch / "out"), kFiles);
}

TEST(Experiment, AnOutThatCannotBeWrittenIsFoundBeforeTheSweep) {
  const Scratch scratch;
  spit(scratch / "file", "x");
  const auto start = std::chrono::steady_clock::now();
  const Finished run = test::run(toy(scratch / "file/out", {"--milliseconds", "60000"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find((scratch / "file").string()), std::string::npos) << run.err;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(Experiment, AFailureToWriteLeavesEarlierResults) {
  const Scratch scratch;
  ASSERT_EQ(test::run(toy(scratch / "out")).code, 0);
  std::filesystem::remove(scratch / "out/curve.csv");
  std::filesystem::create_directories(scratch / "out/curve.csv/in_the_way");
  const Finished run = test::run(toy(scratch / "out", {"--numbers", "3"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("curve.csv"), std::string::npos) << run.err;
  EXPECT_EQ(listing(scratch / "out").find(".tmp"), std::string::npos);
}

/// Starts a slow sweep and interrupts it when at least one case is finished.
Finished interrupted_run(const std::filesystem::path& out, int signal) {
  Process process(toy(out, {"--milliseconds", "300", "--jobs", "1"}));
  const auto journal = out / "toy.journal";
  for (int i = 0; i < 2000; ++i) {
    const std::string text = std::filesystem::exists(journal) ? slurp(journal) : "";
    if (std::count(text.begin(), text.end(), '\n') >= 2) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process.signal(signal);
  return process.wait();
}

TEST(Experiment, AnInterruptedSweepLeavesNoHalfFileAndResumesToTheSameBytes) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Scratch scratch;
    spit(scratch / "out/summary.csv", "earlier");
    const Finished stopped = interrupted_run(scratch / "out", signal);
    EXPECT_EQ(stopped.code, 130) << stopped.err;
    EXPECT_EQ(listing(scratch / "out"), "summary.csv toy.journal");
    EXPECT_EQ(slurp(scratch / "out/summary.csv"), "earlier");

    const Finished resumed = test::run(toy(scratch / "out", {"--milliseconds", "300", "--jobs", "2"}));
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_NE(resumed.err.find("finished cases found"), std::string::npos) << resumed.err;
    EXPECT_EQ(slurp(scratch / "out/summary.csv"), kSummary);
    EXPECT_EQ(listing(scratch / "out"), kFiles);
  }
}

TEST(Experiment, ASweepThatIsKilledOutrightResumesToo) {
  const Scratch scratch;
  EXPECT_EQ(interrupted_run(scratch / "out", SIGKILL).code, -SIGKILL);
  const Finished resumed = test::run(toy(scratch / "out"));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("finished cases found"), std::string::npos) << resumed.err;
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), kSummary);
}

TEST(Experiment, PartsTogetherGiveTheBytesOfTheWhole) {
  const Scratch scratch;
  for (const char* part : {"2/3", "1/3", "3/3"}) {
    const Finished run = test::run(toy(scratch / "out", {"--shard", part}));
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(listing(scratch / "out").find("summary.csv"), std::string::npos);
  }
  const Finished merge = test::run(toy(scratch / "out"));
  EXPECT_EQ(merge.code, 0) << merge.err;
  EXPECT_NE(merge.err.find("4 finished cases found"), std::string::npos) << merge.err;
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), kSummary);
  EXPECT_EQ(listing(scratch / "out"), kFiles);
}

TEST(Experiment, TwoRunsDoNotShareAFolder) {
  const Scratch scratch;
  Process first(toy(scratch / "out", {"--milliseconds", "60000"}));
  while (!std::filesystem::exists(scratch / "out/toy.journal") ||
         slurp(scratch / "out/toy.journal").empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const Finished second = test::run(toy(scratch / "out"));
  EXPECT_EQ(second.code, 3);
  EXPECT_NE(second.err.find("another run"), std::string::npos) << second.err;
  first.signal(SIGINT);
  EXPECT_EQ(first.wait().code, 130);
}

TEST(Experiment, ListsItsCasesAndRunsNone) {
  const Scratch scratch;
  const Finished run =
      test::run(toy(scratch / "out", {"--list", "--milliseconds", "60000", "--shard", "1/2"}));
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out,
            "experiment,scenario,method,options,number,h_s,until_s\n"
            "toy,toy,fine,,10,0.5,10\n"
            "toy,toy,fine,,8,0.5,10\n");
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

}  // namespace
}  // namespace touchstone::harness
