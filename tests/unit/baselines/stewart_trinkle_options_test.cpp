#include <functional>
#include <utility>
#include <vector>

#include "core/model/errors.h"
#include "tests/unit/baselines/scenes.h"

namespace touchstone::testing {
namespace {

/// What an InputError says; empty if there is none.
std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string planar_complaint(const Options& options) {
  return complaint([&] { make_stewart_trinkle<2>(rolling_disc(), options); });
}

std::string spatial_complaint(const Options& options) {
  return complaint([&] {
    make_stewart_trinkle<3>(scene<3>(0.5, {ball("ball", {0, 0, 1}), ground<3>()}), options);
  });
}

TEST(StewartTrinkleOptions, AreListedWithTheirDefaults) {
  EXPECT_EQ(make_stewart_trinkle<2>(rolling_disc(), {})->effective_options(),
            (Options{{"candidates", "reachable"}, {"edges", "0"}}));
  EXPECT_EQ(
      make_stewart_trinkle<3>(scene<3>(0.5, {ball("ball", {0, 0, 1}), ground<3>()}), {})->effective_options(),
      (Options{{"candidates", "reachable"}, {"pyramid", "8"}, {"pyramid_fit", "inscribed"}}));
}

TEST(StewartTrinkleOptions, TakesEveryPolicy) {
  for (const char* policy : {"reachable", "all", "nearest:1", "nearest:12", "epsilon:0", "epsilon:1e-3"}) {
    EXPECT_EQ(planar_complaint({{"candidates", policy}}), "") << policy;
  }
}

TEST(StewartTrinkleOptions, NamesBadValuesAndWhatIsAllowed) {
  for (const char* policy :
       {"", "al", "nearest", "nearest:", "nearest:0", "nearest:-1", "nearest:1.5", "nearest:2x",
        "epsilon:-1e-9", "epsilon:nan", "epsilon:inf", "epsilon:1 ", "Reachable"}) {
    const std::string message = planar_complaint({{"candidates", policy}});
    EXPECT_NE(message.find("option 'candidates': got '" + std::string(policy) + "'"), std::string::npos)
        << message;
    EXPECT_NE(message.find("nearest:k"), std::string::npos) << message;
  }
  for (const char* edges : {"1", "2", "-3", "4.5", "many"}) {
    EXPECT_NE(planar_complaint({{"edges", edges}}).find("option 'edges'"), std::string::npos) << edges;
  }
  for (const char* sides : {"2", "3", "5", "0", "eight"}) {
    EXPECT_NE(spatial_complaint({{"pyramid", sides}}).find("option 'pyramid'"), std::string::npos) << sides;
  }
  EXPECT_NE(spatial_complaint({{"pyramid_fit", "outside"}}).find("option 'pyramid_fit'"), std::string::npos);
}

TEST(StewartTrinkleOptions, RefusesUnknownOnes) {
  EXPECT_NE(planar_complaint({{"pyramid", "8"}}).find("option 'pyramid'"), std::string::npos);
  EXPECT_NE(spatial_complaint({{"edges", "8"}}).find("option 'edges'"), std::string::npos);
  EXPECT_NE(planar_complaint({{"magic", "1"}}).find("option 'magic'"), std::string::npos);
}

TEST(StewartTrinkleOptions, EdgesReplaceMovingDiscs) {
  const auto method = make_stewart_trinkle<2>(rolling_disc(), {{"edges", "12"}});
  const auto* polygon = std::get_if<RegularPolygon>(&method->scene().bodies[0].shape.geometry);
  ASSERT_NE(polygon, nullptr);
  EXPECT_EQ(polygon->edges, 12);
}

TEST(StewartTrinkleOptions, StepSizeMustBePositive) {
  const auto method = make_stewart_trinkle<2>(rolling_disc(), {});
  for (const double h : {0.0, -0.01, std::nan(""), HUGE_VAL}) {
    EXPECT_NE(complaint([&] { (void)method->step(h); }).find("step size h"), std::string::npos) << h;
  }
}

TEST(StewartTrinkleOptions, RefusesWhatItCannotRepresent) {
  Scene<2> bouncing = rolling_disc();
  bouncing.contact_law.restitution = 0.5;
  EXPECT_THROW(make_stewart_trinkle<2>(bouncing, {}), Unsupported);
  const Scene<2> two =
      scene<2>(0.4, {disc("a", {0, 1}, {0, 0, 0}), disc("b", {3, 1}, {0, 0, 0}), ground<2>()});
  EXPECT_NO_THROW(make_stewart_trinkle<2>(two, {}));
  EXPECT_THROW(make_stewart_trinkle<2>(two, {{"edges", "10"}}), Unsupported);
}

}  // namespace
}  // namespace touchstone::testing
