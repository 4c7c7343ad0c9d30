// Cases of methods from the registry: what is wrong with them is found when they are made.

#include "experiments/harness/method_case.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/scenarios/disc_rolling.h"

namespace touchstone::harness {
namespace {

MethodCase<2> spec(const std::string& method) {
  MethodCase<2> spec;
  spec.scenario = "disc_rolling";
  spec.scene = std::make_shared<Scene<2>>(disc_rolling_scene());
  spec.method = parse_method(method);
  spec.run = {.h = 0.01, .until = 0.1, .report = {}};
  spec.tabulate = [](const CaseRun<2>& run) {
    return std::vector<std::vector<Row>>{{{number_cell(run.final.kinetic)}}};
  };
  return spec;
}

TEST(MethodCase, KnowsEveryOptionInForceAndRuns) {
  const Case one = make_case(spec("stewart_trinkle:edges=20"));
  EXPECT_EQ(one.id.method, "stewart_trinkle");
  EXPECT_NE(one.id.options.find("edges=20"), std::string::npos) << one.id.options;
  EXPECT_NE(one.id.options.find("candidates=reachable"), std::string::npos) << "a default";
  const CaseResult result = one.run();
  EXPECT_EQ(result.status, CaseStatus::ok) << result.reason;
  double kinetic = 0;
  ASSERT_TRUE(parse_number(result.tables.at(0).at(0).at(0), kinetic));
  EXPECT_GT(kinetic, 4.0);
  EXPECT_LT(kinetic, 6.75);
}

TEST(MethodCase, WhatIsWrongIsFoundBeforeAnythingRuns) {
  EXPECT_THROW(make_case(spec("no_such_method")), InputError);
  EXPECT_THROW(make_case(spec("stewart_trinkle:edges=2")), InputError);
  EXPECT_THROW(make_case(spec("stewart_trinkle:no_such_option=1")), InputError);
  MethodCase<2> uneven = spec("implicit_ncp");
  uneven.run.until = 0.105;
  EXPECT_THROW(make_case(uneven), InputError);
}

TEST(MethodCase, ASceneThatTheMethodCannotRepresentIsUnsupportedAndNoError) {
  MethodCase<2> bouncing = spec("stewart_trinkle");
  Scene<2> scene = *bouncing.scene;
  scene.contact_law.restitution = 0.5;
  bouncing.scene = std::make_shared<Scene<2>>(scene);
  const Case one = make_case(bouncing);
  EXPECT_THROW(one.run(), Unsupported);
}

TEST(MethodKeys, AreThoseOfTheRegistryInItsOrder) {
  const std::vector<std::string> keys = method_keys<3>();
  ASSERT_EQ(keys.size(), methods<3>().size());
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  EXPECT_NE(std::find(keys.begin(), keys.end(), "implicit_ncp"), keys.end());
}

TEST(RunBeside, IsTheRunOfTheMethodWithItsOptions) {
  const Scene<2> scene = disc_rolling_scene();
  const MethodSpec coarse = parse_method("stewart_trinkle:edges=10");
  const CaseRun<2> run = run_beside(scene, coarse, 0.01, 0.1);
  EXPECT_EQ(run.kept.size(), 11u);
  EXPECT_GT(run.largest_drift_J, 1e-3) << "a polygon";
  EXPECT_LT(run_beside(scene, parse_method("implicit_ncp"), 0.01, 0.1).largest_drift_J, 1e-12);
}

TEST(MethodCase, CostGrowsWithTheSteps) {
  MethodCase<2> fine = spec("implicit_ncp");
  fine.run.h = 0.001;
  EXPECT_EQ(make_case(fine).cost, 10 * make_case(spec("implicit_ncp")).cost);
}

}  // namespace
}  // namespace touchstone::harness
