// The disc_rolling program: its scene, its usage errors, its rows, its bytes.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "experiments/harness/csv.h"
#include "experiments/scenarios/disc_rolling.h"
#include "tests/unit/harness/cells.h"
#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using test::Finished;
using test::listing;
using test::number;
using test::Process;
using test::Scratch;
using test::slurp;
using test::spit;

std::vector<std::string> program(const std::filesystem::path& out, std::vector<std::string> words) {
  words.insert(words.begin(), {DISC_ROLLING, "--out", out.string()});
  return words;
}

TEST(DiscRollingScene, RollsWithoutSlipOnTheGround) {
  const DiscRolling parameters;
  const Scene<2> scene = disc_rolling_scene(parameters);
  const Body<2>& disc = scene.bodies[static_cast<std::size_t>(scene.body("disc"))];
  EXPECT_TRUE(scene.bodies[static_cast<std::size_t>(scene.body("ground"))].fixed);
  EXPECT_EQ(disc.velocity, Twist<2>(-3, 0, 3));
  EXPECT_EQ(disc.pose.position, Vector<2>(0, 1));
  EXPECT_EQ(point_velocity<2>(disc.velocity, {0, -1}), Vector<2>(0, 0));
  EXPECT_EQ(parameters.kinetic_energy(), 6.75);
  DiscRolling other{.mass = 2, .inertia = 3, .radius = 0.5, .angular_velocity = -4};
  const Scene<2> changed = disc_rolling_scene(other);
  EXPECT_EQ(point_velocity<2>(changed.bodies[0].velocity, {0, -0.5}), Vector<2>(0, 0));
  EXPECT_EQ(other.kinetic_energy(), 0.5 * 2 * 4 + 0.5 * 3 * 16);
}

TEST(DiscRolling, BadInputIsExitCodeTwoWithOneMessage) {
  const Scratch scratch;
  spit(scratch / "out/summary.csv", "earlier");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--step-sizes", "0"}, "--step-sizes: got '0', allowed: a finite number > 0"},
      {{"--step-sizes", "nan"}, "--step-sizes: got 'nan'"},
      {{"--step-sizes", "-0.01"}, "--step-sizes: got '-0.01'"},
      {{"--step-sizes", "0.03"}, "--until: got 10, allowed: a multiple of the step size 0.03 s"},
      {{"--edges", "2"}, "--edges: got '2', allowed: an integer >= 3"},
      {{"--methods", "magic"}, "method: got 'magic', allowed: one of "},
      {{"--methods", "stewart_trinkle:magic=1"}, "method stewart_trinkle option 'magic': got '1'"},
      {{"--methods", "edge_limited:magic=1"}, "--methods: got 'edge_limited:magic=1', allowed: no options"},
      {{"--candidates", "magic"}, "option 'candidates': got 'magic'"},
      {{"--sweeps", "magic"}, "--sweeps: got 'magic', allowed: edges, step_size, check, engines"},
      {{"--until", "0"}, "--until: got '0'"}};
  for (const auto& [words, message] : cases) {
    const Finished run = test::run(program(scratch / "out", words));
    EXPECT_EQ(run.code, 2) << message;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  EXPECT_EQ(listing(scratch / "out"), "summary.csv");
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), "earlier");
}

TEST(DiscRolling, AnOutThatCannotBeWrittenIsExitCodeThree) {
  const Scratch scratch;
  spit(scratch / "file", "x");
  EXPECT_EQ(test::run(program(scratch / "file/out", {"--quick"})).code, 3);
  EXPECT_EQ(test::run(program("/proc/none", {"--quick"})).code, 3);
}

TEST(DiscRolling, QuickGivesTheSameBytesFromOneAndTwoThreads) {
  const Scratch scratch;
  for (const char* jobs : {"1", "2"}) {
    const Finished run = test::run(program(scratch / jobs, {"--quick", "--jobs", jobs}));
    ASSERT_EQ(run.code, 0) << run.err;
  }
  for (const char* name :
       {"summary.csv", "kinetic_energy.csv", "summary.meta.json", "kinetic_energy.meta.json"}) {
    EXPECT_FALSE(slurp(scratch / "1" / name).empty());
    EXPECT_EQ(slurp(scratch / "1" / name), slurp(scratch / "2" / name)) << name;
  }
}

TEST(DiscRolling, RowsAgreeWithTheClosedFormsThatStandBesideThem) {
  const Scratch scratch;
  const Finished run = test::run(program(scratch / "out", {"--quick", "--until", "2"}));
  ASSERT_EQ(run.code, 0) << run.err;
  const Table summary = read_csv(scratch / "out/summary.csv");

  const std::vector<std::pair<std::string, std::string>> coarse = {
      {"method", "stewart_trinkle"}, {"sweep", "step_size"}, {"candidates", "reachable"}, {"h_s", "0.01"}};
  // KE0 exp(-(4/3) g h t / R) at t = 2 s, within the relative error that a finite omega h = 0.03 leaves.
  const double floor = 6.75 * std::exp(-4.0 / 3.0 * 9.81 * 0.01 * 2.0);
  EXPECT_NEAR(number(summary, coarse, "step_limited_2s_J"), floor, 1e-12);
  EXPECT_NEAR(number(summary, coarse, "kinetic_2s_J"), floor, 0.005 * floor);

  const std::vector<std::pair<std::string, std::string>> fine = {{"method", "stewart_trinkle"},
                                                                 {"sweep", "check"}};
  const double edges = 6.75 / std::pow(1 + 2 * M_PI * 3 * 2 / (3 * 1000), 2);
  EXPECT_NEAR(number(summary, fine, "edge_limited_2s_J"), edges, 1e-12);
  EXPECT_NEAR(number(summary, fine, "kinetic_2s_J"), edges, 0.005 * edges);
  EXPECT_NEAR(number(summary, fine, "exact_polygon_2s_J"), edges, 0.001 * edges);

  const double loss = number(summary, fine, "loss_J");
  EXPECT_NEAR(number(summary, fine, "polygon_loss_J") + number(summary, fine, "linearisation_loss_J") +
                  number(summary, fine, "rest_loss_J"),
              loss, 1e-12);
  EXPECT_GT(number(summary, fine, "polygon_loss_J"), 0.9 * loss);
  EXPECT_GT(number(summary, coarse, "linearisation_loss_J"), 0.5 * number(summary, coarse, "loss_J"));
}

TEST(DiscRolling, InterruptedItLeavesNoHalfFileAndResumesToTheSameBytes) {
  const Scratch scratch;
  const std::vector<std::string> words = {"--methods",   "stewart_trinkle", "--sweeps", "edges",  "--edges",
                                          "10,500,1000", "--candidates",    "all",      "--jobs", "1"};
  ASSERT_EQ(test::run(program(scratch / "whole", words)).code, 0);

  spit(scratch / "out/summary.csv", "earlier");
  Process process(program(scratch / "out", words));
  const auto journal = scratch / "out/disc_rolling.journal";
  while (!std::filesystem::exists(journal) || slurp(journal).empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  process.signal(SIGINT);
  const Finished stopped = process.wait();
  ASSERT_EQ(stopped.code, 130) << stopped.out << stopped.err;
  EXPECT_EQ(listing(scratch / "out"), "disc_rolling.journal summary.csv");
  EXPECT_EQ(slurp(scratch / "out/summary.csv"), "earlier");

  ASSERT_EQ(test::run(program(scratch / "out", words)).code, 0);
  for (const char* name : {"summary.csv", "kinetic_energy.csv", "summary.meta.json"}) {
    EXPECT_EQ(slurp(scratch / "out" / name), slurp(scratch / "whole" / name)) << name;
  }
}

TEST(DiscRolling, AnOptionGivenByHandReachesTheMethodAndTheTable) {
  const Scratch scratch;
  const Finished run =
      test::run(program(scratch / "out", {"--methods", "implicit_ncp:gap=distance;tolerance=1e-10",
                                          "--sweeps", "edges", "--until", "0.1"}));
  ASSERT_EQ(run.code, 0) << run.err;
  const Table summary = read_csv(scratch / "out/summary.csv");
  ASSERT_EQ(summary.rows.size(), 1u);
  const std::string& options = summary.rows[0][summary.column("options", "t")];
  EXPECT_NE(options.find("gap=distance"), std::string::npos) << options;
  EXPECT_NE(options.find("tolerance=1e-10"), std::string::npos) << options;
}

}  // namespace
}  // namespace touchstone::harness
