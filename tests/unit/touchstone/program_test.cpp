// touchstone as a program: files, exit codes, bad input, interrupts.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <regex>
#include <thread>

#include "experiments/harness/csv.h"
#include "tests/unit/harness/process.h"

namespace touchstone::program {
namespace {

using harness::Table;
using test::Finished;
using test::listing;
using test::Process;
using test::Scratch;
using test::slurp;
using test::spit;
using Words = std::vector<std::string>;

constexpr const char* kFiles = "contacts.csv energy.csv trajectory.csv";

std::string scene(const std::string& name) { return std::string(EXAMPLE_SCENES) + "/" + name + ".toml"; }

/// A run of sphere_spin as in the paper, with other words in the place of some of these.
Words spin(const std::filesystem::path& out, const Words& more = {}) {
  Words words = {TOUCHSTONE_PROGRAM,
                 "run",
                 scene("sphere_spin"),
                 "--method",
                 "implicit_ncp",
                 "--step",
                 "0.07",
                 "--until",
                 "1.4",
                 "--out",
                 out.string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words replaced(Words words, const std::string& old, const std::string& now) {
  std::replace(words.begin(), words.end(), old, now);
  return words;
}

double cell(const Table& table, std::size_t row, const std::string& column) {
  double value = 0;
  EXPECT_TRUE(harness::parse_number(table.rows.at(row).at(table.column(column, "table")), value)) << column;
  return value;
}

/// Bad usage and bad input: one line on stderr, nothing else anywhere.
void expect_refused(const Finished& run, int code, const std::string& message,
                    const std::filesystem::path& folder, const std::string& held = "") {
  EXPECT_EQ(run.code, code) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << "one message: " << run.err;
  EXPECT_EQ(listing(folder), held);
}

TEST(Program, RunsASceneAndWritesThreeTables) {
  const Scratch scratch;
  const Finished run = test::run(spin(scratch / "new/out"));
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "") << "a short run says nothing there";
  EXPECT_EQ(listing(scratch / "new/out"), kFiles);
  EXPECT_NE(run.out.find("implicit_ncp [gap="), std::string::npos) << run.out;

  const Table trajectory = harness::read_csv(scratch / "new/out/trajectory.csv");
  ASSERT_EQ(trajectory.rows.size(), 21u);
  EXPECT_EQ(trajectory.rows[0],
            (harness::Row{"0", "ball", "0", "0", "1", "1", "0", "0", "0", "0", "0", "0", "0", "0", "1.962"}));
  for (std::size_t k = 0; k < 21; ++k) {
    EXPECT_EQ(trajectory.rows[k][0], harness::number_cell(static_cast<double>(7 * k) / 100))
        << "a decimal time is written as that decimal";
    EXPECT_NEAR(cell(trajectory, k, "wz_rad_s"), std::max(0.0, 1.962 - 1.962 * 0.07 * static_cast<double>(k)),
                1e-12);
  }
  const Table contacts = harness::read_csv(scratch / "new/out/contacts.csv");
  ASSERT_EQ(contacts.rows.size(), 20u) << "none at t = 0";
  EXPECT_NEAR(cell(contacts, 0, "normal_N"), 9.81, 1e-12);
  EXPECT_NEAR(cell(contacts, 0, "torsion_Nm"), -0.2 * 0.4 * 9.81, 1e-12);
  EXPECT_NEAR(cell(contacts, 0, "spin_rad_s"), 1.962 * 0.93, 1e-12);
  const Table energy = harness::read_csv(scratch / "new/out/energy.csv");
  ASSERT_EQ(energy.rows.size(), 21u);
  EXPECT_NEAR(cell(energy, 20, "friction_loss_J"), 0.5 * 0.4 * 1.962 * 1.962, 1e-12);
  EXPECT_NEAR(cell(energy, 20, "total_J"), 9.81, 1e-12);
}

TEST(Program, RunsEveryExampleSceneAndWritesTablesWithTheSameHeaders) {
  const std::pair<const char*, const char*> headers[] = {
      {"trajectory.csv",
       "t_s,body,px_m,py_m,pz_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s"},
      {"contacts.csv",
       "t_s,body_a,body_b,gap_m,normal_N,tangent_t_N,tangent_o_N,torsion_Nm,slip_m_s,spin_rad_s"},
      {"energy.csv", "t_s,kinetic_J,potential_J,total_J,friction_loss_J,impact_loss_J,drift_J"}};
  int scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(EXAMPLE_SCENES)) {
    const std::string name = file.path().stem().string();
    const Scratch scratch;
    const Finished run = test::run({TOUCHSTONE_PROGRAM, "run", scene(name), "--method", "implicit_ncp",
                                    "--step", "0.001", "--until", "0.05", "--out", scratch / "out"});
    EXPECT_EQ(run.code, 0) << name << ": " << run.err;
    ASSERT_EQ(listing(scratch / "out"), kFiles) << name;
    for (const auto& [table, header] : headers) {
      const std::string text = slurp(scratch / "out" / table);
      EXPECT_EQ(text.substr(0, text.find('\n')), header) << name << " " << table;
    }
    const Table energy = harness::read_csv(scratch / "out/energy.csv");
    ASSERT_EQ(energy.rows.size(), 51u) << name;
    EXPECT_EQ(cell(energy, 50, "t_s"), 0.05) << name;
    ++scenes;
  }
  EXPECT_GE(scenes, 12);
}

TEST(Program, RunsAPlanarSceneUnderAnotherMethodWithItsOptions) {
  const Scratch scratch;
  const Finished run = test::run({TOUCHSTONE_PROGRAM, "run", scene("disc_rolling"), "--method",
                                  "stewart_trinkle", "--option", "edges=20", "--option", "candidates=all",
                                  "--step", "0.01", "--until", "1", "--out", scratch / "out"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("[candidates=all;edges=20]"), std::string::npos) << run.out;
  const Table trajectory = harness::read_csv(scratch / "out/trajectory.csv");
  EXPECT_EQ(trajectory.rows.size(), 101u);
  EXPECT_EQ(cell(trajectory, 100, "pz_m"), 0);
  const Table energy = harness::read_csv(scratch / "out/energy.csv");
  EXPECT_GT(cell(energy, 100, "impact_loss_J"), 0.5) << "corners knock";
}

TEST(Program, WritesEveryNthStepAndTheEnd) {
  const Scratch scratch;
  EXPECT_EQ(test::run(spin(scratch / "all")).code, 0);
  EXPECT_EQ(test::run(spin(scratch / "some", {"--every", "6"})).code, 0);
  const Table all = harness::read_csv(scratch / "all/energy.csv");
  const Table some = harness::read_csv(scratch / "some/energy.csv");
  ASSERT_EQ(some.rows.size(), 5u);
  const std::size_t kept[] = {0, 6, 12, 18, 20};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(some.rows[i], all.rows[kept[i]]) << "losses are of all steps";
}

TEST(Program, GivesTheSameBytesAgain) {
  const Scratch scratch;
  for (const char* out : {"one", "two"}) EXPECT_EQ(test::run(spin(scratch / out)).code, 0);
  for (const char* name : {"trajectory.csv", "contacts.csv", "energy.csv"}) {
    EXPECT_EQ(slurp(scratch / "one" / name), slurp(scratch / "two" / name)) << name;
  }
}

TEST(Program, AStepThatFailsLeavesWhatWasComputedAndSaysWhy) {
  const Scratch scratch;
  const Finished run =
      test::run({TOUCHSTONE_PROGRAM, "run", HARD_STEPS "/step_6019.toml", "--method", "implicit_ncp",
                 "--step", "0.04", "--until", "0.4", "--out", scratch / "out"});
  EXPECT_EQ(run.code, 1);
  EXPECT_NE(run.err.find("step 1 from t = 0 s: not_converged"), std::string::npos) << run.err;
  EXPECT_EQ(listing(scratch / "out"), kFiles);
  EXPECT_EQ(harness::read_csv(scratch / "out/trajectory.csv").rows.size(), 2u);  // both bodies at t = 0
}

TEST(Program, BadUsageIsExitCodeTwoAndWritesNothing) {
  const Scratch scratch;
  const std::string out = scratch / "out";
  const std::pair<Words, std::string> cases[] = {
      {{TOUCHSTONE_PROGRAM}, "command: got nothing, allowed: run, validate, methods, scenarios"},
      {{TOUCHSTONE_PROGRAM, "walk"}, "command: got 'walk', allowed: run"},
      {{TOUCHSTONE_PROGRAM, "run"}, "required"},
      {{TOUCHSTONE_PROGRAM, "methods", "stray"}, "stray"},
      {spin(out, {"--nothing"}), "--nothing"},
      {replaced(spin(out), "0.07", "0"), "--step: got '0'"},
      {replaced(spin(out), "0.07", "-1"), "--step: got '-1'"},
      {replaced(spin(out), "0.07", "nan"), "--step: got 'nan'"},
      {replaced(spin(out), "0.07", "fast"), "--step: got 'fast'"},
      {replaced(spin(out), "1.4", "inf"), "--until: got 'inf'"},
      {replaced(spin(out), "1.4", "1.5"), "--until: got 1.5, allowed: a multiple of the step size 0.07 s"},
      {spin(out, {"--every", "0"}), "--every: got '0'"},
      {spin(out, {"--every", "1.5"}), "--every: got '1.5'"},
      {replaced(spin(out), out, ""), "--out: got ''"},
      {replaced(spin(out), "implicit_ncp", "explicit_ncp"), "method: got 'explicit_ncp', allowed: one of"},
      {replaced(spin(out), "implicit_ncp", "chipmunk"), "method: got 'chipmunk', allowed: one of"},
      {spin(out, {"--option", "edges"}), "--option: got 'edges', allowed: name=value"},
      {spin(out, {"--option", "gap=distance", "--option", "gap=distance"}), "--option: got 'gap' twice"},
      {spin(out, {"--option", "colour=red"}), "option 'colour'"},
      {spin(out, {"--option", "tolerance=big"}), "option 'tolerance'"},
  };
  for (const auto& [words, message] : cases) {
    expect_refused(test::run(words), 2, message, scratch.path());
  }
}

TEST(Program, ABadSceneIsExitCodeTwoAndTouchesNothing) {
  const Scratch scratch;
  const std::string good = slurp(scene("sphere_spin"));
  const std::tuple<const char*, const char*, const char*> faults[] = {
      {"mass = 1.0", "mass = -1.0", ":26:8: body 'ball' mass: got -1, allowed: a finite number > 0 [kg]"},
      {"mass = 1.0", "mas = 1.0", ":26:1: body 1 mas: got an unknown key (did you mean 'mass'?)"},
      {"mu = 0.2", "mu = nan", ":16:6: friction.mu: got nan"},
      {"position = [0, 0, 1]", "position = [0, 0, 0.5]",
       ":29:12: body 'ball' position: got an overlap of 0.5 m with 'ground'"},
      {"[friction]", "[friction", ":15:"},
      {"mass = 1.0\n", "", ":24:1: body 'ball' mass: got nothing, but it is required"},
      {"normal = [0, 0, 1]", "normal = [0, 0, 2]", "body 'ground' shape.normal: got [0, 0, 2] of length 2"},
      {"inertia = [0.4, 0.4, 0.4]", "inertia = [0.4, 0.4, 0.9]",
       "body 'ball' inertia (largest principal moment): got 0.9"},
      {"position = [0, 0, 1]", "position = [0, 0, nan]", "body 'ball' position[2]: got nan"},
      {"name = \"ground\"", "name = \"ball\"", "body 2 name: got 'ball' twice"},
      {"type = \"sphere\", radius = 1.0",
       "type = \"intersection\", parts = [{ type = \"sphere\", radius = 1 }, { type = \"sphere\", radius = "
       "1, "
       "center = [3, 0, 0] }]",
       "body 'ball' shape: got parts whose common depth is -"},
  };
  spit(scratch / "out/trajectory.csv", "earlier");
  for (const auto& [old, now, message] : faults) {
    std::string text = good;
    ASSERT_NE(text.find(old), std::string::npos) << old;
    spit(scratch / "bad.toml", text.replace(text.find(old), std::string(old).size(), now));
    const std::string file = scratch / "bad.toml";
    const Finished run = test::run(replaced(spin(scratch / "out"), scene("sphere_spin"), file));
    expect_refused(run, 2, message, scratch / "out", "trajectory.csv");
    // file:line:column: key
    EXPECT_TRUE(std::regex_search(run.err, std::regex("bad[.]toml:[0-9]+:[0-9]+: "))) << run.err;
    expect_refused(test::run({TOUCHSTONE_PROGRAM, "validate", file}), 2, message, scratch / "out",
                   "trajectory.csv");
  }
  EXPECT_EQ(slurp(scratch / "out/trajectory.csv"), "earlier");
}

TEST(Program, ASceneThatAMethodCannotRepresentIsExitCodeTwo) {
  const Scratch scratch;
  std::string text = slurp(scene("sphere_spin"));
  const std::string old = "restitution = 0.0";
  spit(scratch / "bouncy.toml", text.replace(text.find(old), old.size(), "restitution = 0.5"));
  const Finished run =
      test::run(replaced(spin(scratch / "out"), scene("sphere_spin"), scratch / "bouncy.toml"));
  expect_refused(run, 2, "method implicit_ncp: got ", scratch.path(), "bouncy.toml");
  EXPECT_NE(run.err.find("restitution 0.5"), std::string::npos) << run.err;
  const Finished jointed =
      test::run({TOUCHSTONE_PROGRAM, "run", scene("pendulum"), "--method", "stewart_trinkle", "--step",
                 "0.01", "--until", "1", "--out", scratch / "out"});
  expect_refused(jointed, 2, "joints", scratch.path(), "bouncy.toml");
}

TEST(Program, WhatCannotBeReadOrWrittenIsExitCodeThree) {
  const Scratch scratch;
  spit(scratch / "file", "x");
  const std::string missing = scratch / "none.toml";
  expect_refused(test::run(replaced(spin(scratch / "out"), scene("sphere_spin"), missing)), 3, missing,
                 scratch.path(), "file");
  expect_refused(test::run({TOUCHSTONE_PROGRAM, "validate", missing}), 3, missing, scratch.path(), "file");
  expect_refused(test::run({TOUCHSTONE_PROGRAM, "validate", scratch.path()}), 3, scratch.path(),
                 scratch.path(), "file");
  for (const std::string& out :
       {(scratch / "file").string(), (scratch / "file/out").string(), std::string("/proc/none")}) {
    const auto start = std::chrono::steady_clock::now();
    Words words = replaced(replaced(spin(out), "0.07", "1e-6"), "1.4", "1000");
    expect_refused(test::run(words), 3, out.substr(0, 5), scratch.path(), "file");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10))
        << "found before hours of work";
  }
}

TEST(Program, AFailureToWriteLeavesAllThreeAsTheyWere) {
  const Scratch scratch;
  spit(scratch / "out/trajectory.csv", "earlier");
  std::filesystem::create_directories(scratch / "out/energy.csv/in_the_way");
  const Finished run = test::run(spin(scratch / "out"));
  EXPECT_EQ(run.code, 3);
  EXPECT_NE(run.err.find("energy.csv"), std::string::npos) << run.err;
  EXPECT_EQ(listing(scratch / "out").find(".tmp"), std::string::npos);
}

TEST(Program, RunsInAnEmptyFolderWithPathsOfItsOwn) {
  const Scratch scratch;
  spit(scratch / "empty/../scene.toml", slurp(scene("sphere_spin")));
  const std::string command = "cd '" + (scratch / "empty").string() +
                              "' && '" TOUCHSTONE_PROGRAM
                              "' run ../scene.toml --method implicit_ncp --step 0.07 --until 0.7 --out .";
  const Finished run = test::run({"sh", "-c", command});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(listing(scratch / "empty"), kFiles);
}

/// A run of hours, interrupted once it has begun, and has gone on for `more` seconds.
Finished interrupted(const std::filesystem::path& out, int signal, double more) {
  Process process({TOUCHSTONE_PROGRAM, "run", scene("disc_rolling"), "--method", "implicit_ncp", "--step",
                   "1e-4", "--until", "100000", "--every", "1000", "--out", out.string()});
  for (int i = 0; i < 2000 && !std::filesystem::exists(out); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(more));
  process.signal(signal);
  return process.wait();
}

TEST(Program, AnInterruptedRunWritesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Scratch scratch;
    const Finished run = interrupted(scratch / "out", signal, 0.1);
    EXPECT_EQ(run.code, 130);
    EXPECT_NE(run.err.find("interrupted, nothing written"), std::string::npos) << run.err;
    EXPECT_EQ(listing(scratch / "out"), "");
  }
}

TEST(Program, ShowsHowFarALongRunIs) {
  const Scratch scratch;
  const Finished run = interrupted(scratch / "out", SIGINT, 1.5);
  EXPECT_NE(run.err.find(" gone, about "), std::string::npos) << run.err;
}

TEST(Program, HelpTeachesWithExamplesThatWork) {
  for (const Words& words :
       {Words{TOUCHSTONE_PROGRAM, "--help"}, Words{TOUCHSTONE_PROGRAM, "run", "--help"}}) {
    const Finished help = test::run(words);
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(help.out.find("touchstone run experiments/scenes/sphere_spin.toml --method implicit_ncp"),
              std::string::npos)
        << help.out;
  }
}

TEST(Program, ListsMethodsAndScenarios) {
  const Finished methods = test::run({TOUCHSTONE_PROGRAM, "methods"});
  EXPECT_EQ(methods.code, 0) << methods.err;
  EXPECT_TRUE(methods.out.starts_with("key ")) << methods.out;
  EXPECT_NE(methods.out.find("\nimplicit_ncp "), std::string::npos) << methods.out;
  const Finished scenarios = test::run({TOUCHSTONE_PROGRAM, "scenarios"});
  EXPECT_EQ(scenarios.code, 0) << scenarios.err;
  EXPECT_NE(scenarios.out.find("\ndisc_rolling "), std::string::npos) << scenarios.out;
}

}  // namespace
}  // namespace touchstone::program
