#include "tools/gate/check.h"

#include <gtest/gtest.h>

#include "core/model/errors.h"

namespace touchstone::gate {
namespace {

using harness::Table;

const Table kTable = {{"method", "edges", "loss", "truth", "status"},
                      {{"lcp", "100", "0.5", "0.4", "ok"},
                       {"lcp", "10", "0.9", "1", "ok"},
                       {"lcp", "20", "0.6", "0.6", "ok"},
                       {"ncp", "", "0", "0", "failed"},
                       {"odd", "1", "", "1", "ok"},
                       {"odd", "2", "nan", "1", "ok"},
                       {"odd", "3", "inf", "1", "ok"}}};

Claim claim(const std::string& method, Aggregate aggregate, Bound bound) {
  Claim one;
  one.name = "c";
  one.filter = {{"method", {method}}};
  one.column = "loss";
  one.aggregate = aggregate;
  one.bound = bound;
  return one;
}

Bound at_most(double most) {
  Bound bound;
  bound.at_most = most;
  return bound;
}
Bound at_least(double least) {
  Bound bound;
  bound.at_least = least;
  return bound;
}

/// Whether the claim holds with the bound at `value` and fails with one that is just beyond it.
void expect_aggregate(Claim one, double value) {
  one.bound = at_most(value);
  EXPECT_TRUE(check(one, kTable, "t").holds);
  one.bound = at_most(value - 1e-9);
  EXPECT_FALSE(check(one, kTable, "t").holds);
  one.bound = at_least(value);
  EXPECT_TRUE(check(one, kTable, "t").holds);
  one.bound = at_least(value + 1e-9);
  EXPECT_FALSE(check(one, kTable, "t").holds);
}

TEST(Check, AggregatesAreWhatTheirNamesSay) {
  expect_aggregate(claim("lcp", Aggregate::max, {}), 0.9);
  expect_aggregate(claim("lcp", Aggregate::min, {}), 0.5);
  expect_aggregate(claim("lcp", Aggregate::count, {}), 3);
  expect_aggregate(claim("lcp", Aggregate::spread, {}), 0.9 - 0.5);
}

TEST(Check, EachTestsEveryRowAndShowsTheWorst) {
  const Verdict low = check(claim("lcp", Aggregate::each, at_most(0.8)), kTable, "t");
  EXPECT_FALSE(low.holds);
  EXPECT_EQ(low.value, "0.9");
  const Verdict high = check(claim("lcp", Aggregate::each, at_least(0.55)), kTable, "t");
  EXPECT_FALSE(high.holds);
  EXPECT_EQ(high.value, "0.5");
  EXPECT_EQ(high.margin, "-0.05");
  Bound between;
  between.at_least = 0.5;
  between.at_most = 0.9;
  EXPECT_TRUE(check(claim("lcp", Aggregate::each, between), kTable, "t").holds);
}

TEST(Check, RisesAndFallsFollowTheOrderOfAColumnAndNotOfTheRows) {
  Claim one = claim("lcp", Aggregate::largest_rise, at_most(0));
  one.along = "edges";
  const Verdict falls = check(one, kTable, "t");
  EXPECT_TRUE(falls.holds) << falls.problem;  // 0.9, 0.6, 0.5
  EXPECT_EQ(falls.value, "-0.1");
  one.aggregate = Aggregate::largest_fall;
  const Verdict rises = check(one, kTable, "t");
  EXPECT_FALSE(rises.holds);
  EXPECT_EQ(rises.value, "0.3");
}

TEST(Check, RisesNeedAtLeastTwoRowsAtDifferentPlaces) {
  Claim one = claim("lcp", Aggregate::largest_rise, at_most(0));
  one.along = "edges";
  one.filter.push_back({"edges", {10.0}});
  EXPECT_NE(check(one, kTable, "t").problem.find("one row only"), std::string::npos);
  one.filter.pop_back();
  Table twice = kTable;
  twice.rows.push_back({"lcp", "10.0", "0.2", "0", "ok"});
  EXPECT_NE(check(one, twice, "t").problem.find("two rows with edges = 10"), std::string::npos);
}

TEST(Check, RelativeDifferencesAreToAnotherColumnOfTheSameRow) {
  Claim one = claim("lcp", Aggregate::max, at_most(0.3));
  one.relative_to = "truth";
  const Verdict verdict = check(one, kTable, "t");
  EXPECT_TRUE(verdict.holds);
  EXPECT_EQ(verdict.value, "0.25");
  one.filter = {{"method", {std::string("ncp")}}};
  EXPECT_NE(check(one, kTable, "t").problem.find("'truth' is 0"), std::string::npos);
}

TEST(Check, FiltersCompareNumbersByValueAndTextsByLetter) {
  Claim one = claim("lcp", Aggregate::count, at_least(1));
  one.filter.push_back({"edges", {10.0, std::string("20")}});
  EXPECT_EQ(check(one, kTable, "t").value, "2");
  one.filter.back() = {"edges", {std::string("10.0")}};
  EXPECT_EQ(check(one, kTable, "t").problem, "no row passes the filter");
  one.filter = {{"edges", {std::string()}}};
  EXPECT_EQ(check(one, kTable, "t").value, "1") << "an empty text means an empty cell";
}

TEST(Check, AClaimAboutNoRowFailsWhateverItSays) {
  for (const Aggregate aggregate : {Aggregate::each, Aggregate::max, Aggregate::count, Aggregate::spread}) {
    const Verdict verdict = check(claim("none", aggregate, at_most(1)), kTable, "t");
    EXPECT_FALSE(verdict.holds);
    EXPECT_EQ(verdict.problem, "no row passes the filter");
  }
}

TEST(Check, ACellWithoutAFiniteNumberFails) {
  for (const double row : {1.0, 2.0, 3.0}) {
    Claim one = claim("odd", Aggregate::min, at_most(1e300));
    one.filter.push_back({"edges", {row}});
    const Verdict verdict = check(one, kTable, "t");
    EXPECT_FALSE(verdict.holds);
    EXPECT_NE(verdict.problem.find("not a finite number"), std::string::npos) << verdict.problem;
  }
}

TEST(Check, TextsMustBeEqualInEveryRow) {
  Claim one = claim("lcp", Aggregate::each, {});
  one.column = "status";
  one.bound.equals = "ok";
  EXPECT_TRUE(check(one, kTable, "t").holds);
  one.filter = {};
  const Verdict verdict = check(one, kTable, "t");
  EXPECT_FALSE(verdict.holds);
  EXPECT_EQ(verdict.value, "failed");
}

TEST(Check, AColumnThatIsNotThereIsABadFile) {
  for (const int which : {0, 1, 2, 3}) {
    Claim one = claim("lcp", Aggregate::largest_rise, at_most(0));
    one.along = "edges";
    (which == 0   ? one.column
     : which == 1 ? one.along
     : which == 2 ? one.relative_to
                  : one.filter[0].column) = "typo";
    EXPECT_THROW(check(one, kTable, "t"), InputError) << which;
  }
}

}  // namespace
}  // namespace touchstone::gate
