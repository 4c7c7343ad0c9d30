// The programs sphere_spin, sphere_on_spheres and ellipsoid_rolling: their rows, usage errors and bytes.

#include <gtest/gtest.h>

#include <algorithm>

#include "baselines/registry.h"
#include "experiments/harness/csv.h"
#include "tests/unit/harness/process.h"

namespace touchstone::harness {
namespace {

using test::Finished;
using test::Scratch;
using test::slurp;

using Words = std::vector<std::string>;

Words program(const char* path, const std::filesystem::path& out, Words words) {
  words.insert(words.begin(), {path, "--out", out.string()});
  return words;
}

Table summary_of(const char* path, const Words& words) {
  const Scratch scratch;
  const Finished run = test::run(program(path, scratch / "out", words));
  EXPECT_EQ(run.code, 0) << run.err;
  return read_csv(scratch / "out/summary.csv");
}

std::string cell(const Table& table, const Row& row, const std::string& column) {
  return row.at(table.column(column, "summary.csv"));
}

/// The rows whose cells are as in `where`.
std::vector<Row> rows(const Table& table, const std::vector<std::pair<std::string, std::string>>& where) {
  std::vector<Row> found;
  std::copy_if(table.rows.begin(), table.rows.end(), std::back_inserter(found), [&](const Row& row) {
    return std::all_of(where.begin(), where.end(),
                       [&](const auto& one) { return cell(table, row, one.first) == one.second; });
  });
  return found;
}

double number(const Table& table, const std::vector<std::pair<std::string, std::string>>& where,
              const std::string& column) {
  const std::vector<Row> found = rows(table, where);
  double value = std::nan("");
  EXPECT_EQ(found.size(), 1u);
  if (found.size() == 1) {
    EXPECT_TRUE(parse_number(cell(table, found[0], column), value)) << column;
  }
  return value;
}

struct Program {
  const char* path;
  const char* scenario;
  Words tables;
  const char* truth;
};

void PrintTo(const Program& program, std::ostream* out) { *out << program.scenario; }

class SpatialExample : public testing::TestWithParam<Program> {};

TEST_P(SpatialExample, GivesTheSameBytesFromOneAndTwoThreads) {
  const Scratch scratch;
  const Words methods = {"--methods", "implicit_ncp,stewart_trinkle," + std::string(GetParam().truth)};
  for (const char* jobs : {"1", "2"}) {
    Words words = {"--quick", "--jobs", jobs};
    words.insert(words.end(), methods.begin(), methods.end());
    const Finished run = test::run(program(GetParam().path, scratch / jobs, words));
    ASSERT_EQ(run.code, 0) << run.err;
  }
  for (const std::string& table : GetParam().tables) {
    EXPECT_FALSE(slurp(scratch / "1" / (table + ".csv")).empty());
    EXPECT_EQ(slurp(scratch / "1" / (table + ".csv")), slurp(scratch / "2" / (table + ".csv"))) << table;
  }
}

TEST_P(SpatialExample, RefusesWhatMakesNoSense) {
  const Scratch scratch;
  const std::string truth = GetParam().truth;
  const std::vector<std::pair<Words, std::string>> cases = {
      {{"--methods", truth + ":magic=1"}, "--methods: got '" + truth + ":magic=1', allowed: no options"},
      {{"--methods", "magic"}, "method: got 'magic', allowed: one of "},
      {{"--methods", "implicit_ncp:magic=1"}, "'magic'"},
      {{"--step-sizes", "0.03"}, "a multiple of the step size 0.03 s"},
      {{"--step-sizes", "0"}, "--step-sizes: got '0'"}};
  for (const auto& [words, message] : cases) {
    const Finished run = test::run(program(GetParam().path, scratch / "out", words));
    EXPECT_EQ(run.code, 2) << message;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

TEST_P(SpatialExample, KeepsWhatCameBeforeAnEarlyHorizon) {
  const Table table = summary_of(GetParam().path, {"--methods", "implicit_ncp", "--step-sizes", "0.02",
                                                   "--until", "0.2", "--jobs", "1"});
  ASSERT_FALSE(table.rows.empty());
  for (const Row& row : table.rows) EXPECT_EQ(cell(table, row, "status"), "ok");
}

INSTANTIATE_TEST_SUITE_P(
    Programs, SpatialExample,
    testing::Values(Program{SPHERE_SPIN, "sphere_spin", {"summary", "trajectory"}, "closed_form"},
                    Program{
                        SPHERE_ON_SPHERES, "sphere_on_spheres", {"summary", "trajectory"}, "event_driven"},
                    Program{ELLIPSOID_ROLLING, "ellipsoid_rolling", {"summary", "path"}, "rolling_ode"}));

TEST(SphereSpinProgram, HasARowForEveryMethodOfTheBuild) {
  const Table table = summary_of(SPHERE_SPIN, {"--step-sizes", "0.1", "--until", "0.2"});
  for (const MethodEntry<3>& entry : methods<3>()) {
    const auto found = rows(table, {{"method", std::string(entry.key)}});
    ASSERT_EQ(found.size(), 1u) << entry.key;
    const bool unsupported = cell(table, found[0], "status") == "unsupported";
    EXPECT_EQ(unsupported, !cell(table, found[0], "reason").empty()) << entry.key;
  }
}

TEST(SphereOnSpheresProgram, RunsASphereWhereEllipsoidsAreRefused) {
  const Table table = summary_of(SPHERE_ON_SPHERES, {"--methods", "implicit_ncp,ode_step,simbody_pgs",
                                                     "--step-sizes", "0.1", "--until", "0.5"});
  const auto statuses = [&](const std::string& method) {
    std::vector<std::string> found;
    for (const Row& row : rows(table, {{"method", method}})) {
      found.push_back(cell(table, row, "shape") + " " + cell(table, row, "status"));
    }
    return found;
  };
  EXPECT_EQ(statuses("implicit_ncp"), Words({"ellipsoid ok"}));
  EXPECT_EQ(statuses("ode_step"), Words({"ellipsoid unsupported", "sphere ok"}));
  EXPECT_EQ(statuses("simbody_pgs"), Words({"ellipsoid unsupported", "sphere unsupported"}));
}

TEST(SphereOnSpheresProgram, OrdersAreThoseOfTheErrorsInTheTable) {
  const Table table =
      summary_of(SPHERE_ON_SPHERES, {"--methods", "implicit_ncp", "--step-sizes", "0.02,0.05"});
  const auto at = [&](const char* h, const char* column) { return number(table, {{"h_s", h}}, column); };
  EXPECT_NEAR(at("0.02", "order_2s"),
              std::log(at("0.05", "velocity_error_2s") / at("0.02", "velocity_error_2s")) / std::log(2.5),
              1e-12);
  EXPECT_EQ(cell(table, rows(table, {{"h_s", "0.05"}}).at(0), "order_2s"), "") << "the largest step has none";
}

TEST(EllipsoidRollingProgram, FactorsAreThoseOfTheErrorsInTheTable) {
  const Table table =
      summary_of(ELLIPSOID_ROLLING, {"--methods", "implicit_ncp,stewart_trinkle", "--step-sizes", "0.02",
                                     "--scenarios", "ellipsoid_spinning"});
  const auto of = [&](const char* method, const char* column) {
    return number(table, {{"method", method}}, column);
  };
  EXPECT_NEAR(of("stewart_trinkle", "error_over_ncp"),
              of("stewart_trinkle", "largest_velocity_error") / of("implicit_ncp", "largest_velocity_error"),
              1e-12);
  EXPECT_NEAR(of("stewart_trinkle", "drift_over_ncp"),
              of("stewart_trinkle", "relative_energy_drift") / of("implicit_ncp", "relative_energy_drift"),
              1e-12);
  EXPECT_EQ(cell(table, rows(table, {{"method", "implicit_ncp"}}).at(0), "error_over_ncp"), "");
}

}  // namespace
}  // namespace touchstone::harness
