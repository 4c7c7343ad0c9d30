#include "tools/gate/claims.h"

#include <gtest/gtest.h>

#include "core/model/errors.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::gate {
namespace {

using test::Scratch;
using test::spit;

const char* const kGood = R"([[claim]]
name = "a"
file = "x/summary.csv"
filter = { method = "ncp", edges = [10, 20], h_s = 0.01 }
column = "drift"
aggregate = "max"
at_most = 1e-12
reason = "because"
)";

std::vector<Claim> read(const std::string& text) {
  const Scratch scratch;
  spit(scratch / "gates.toml", text);
  return read_claims(scratch / "gates.toml");
}

std::string message_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.rfind("gates.toml"));
  }
  return "no error";
}

/// The good claim with one line replaced.
std::string with(const std::string& line, const std::string& other) {
  std::string text = kGood;
  return text.replace(text.find(line), line.size(), other);
}

TEST(Claims, EveryKeyIsRead) {
  const Claim claim = read(kGood).at(0);
  EXPECT_EQ(claim.name, "a");
  EXPECT_EQ(claim.file, "x/summary.csv");
  EXPECT_EQ(claim.column, "drift");
  EXPECT_EQ(claim.aggregate, Aggregate::max);
  EXPECT_EQ(claim.bound.at_most, 1e-12);
  EXPECT_TRUE(std::isinf(claim.bound.at_least));
  EXPECT_EQ(claim.reason, "because");
  ASSERT_EQ(claim.filter.size(), 3u);
  for (const Condition& condition : claim.filter) {
    EXPECT_EQ(condition.values.size(), condition.column == "edges" ? 2u : 1u);
    EXPECT_EQ(std::holds_alternative<std::string>(condition.values[0]), condition.column == "method");
  }
  const Claim ordered =
      read(with("aggregate = \"max\"", "aggregate = \"largest_rise\"\nalong = \"h_s\"\nrelative_to = \"w\""))
          .at(0);
  EXPECT_EQ(ordered.along, "h_s");
  EXPECT_EQ(ordered.relative_to, "w");
  EXPECT_EQ(read(with("at_most = 1e-12", "at_least = 3")).at(0).bound.at_least, 3);
  const Bound between = read(with("at_most = 1e-12", "between = [-1, 2.5]")).at(0).bound;
  EXPECT_EQ(between.at_least, -1);
  EXPECT_EQ(between.at_most, 2.5);
}

TEST(Claims, WhatIsWrongIsNamedWithFileAndLineAndKey) {
  EXPECT_EQ(message_of("x = [\n"),
            "gates.toml:1: got Error while parsing array: encountered end-of-file, "
            "allowed: TOML 1.0");
  EXPECT_EQ(message_of(""), "gates.toml:1: claim: got nothing, allowed: at least one [[claim]]");
  EXPECT_EQ(message_of(std::string(kGood) + "[other]\n"),
            "gates.toml:9: other: got an unknown key, allowed: [[claim]] tables");
  EXPECT_EQ(message_of("claim = 3\n"), "gates.toml:1: claim: got nothing, allowed: at least one [[claim]]");
  EXPECT_EQ(message_of(with("name = \"a\"", "name = 3")),
            "gates.toml:2: name: got another type, allowed: a text");
  EXPECT_EQ(message_of(with("name = \"a\"\n", "")),
            "gates.toml:1: name: got nothing, allowed: a text (every claim has one)");
  EXPECT_EQ(message_of(with("reason = \"because\"\n", "")),
            "gates.toml:1: reason: got nothing, allowed: a text (every claim has one)");
  EXPECT_EQ(message_of(with("\"max\"", "\"maximum\"")),
            "gates.toml:6: aggregate: got 'maximum', allowed: count, each, largest_fall, largest_rise, max, "
            "min, spread");
  EXPECT_NE(
      message_of(with("reason", "because = 1\nreason")).find("gates.toml:8: because: got an unknown key"),
      std::string::npos);
  EXPECT_EQ(message_of(with("1e-12", "\"1\"")), "gates.toml:7: at_most: got no number, allowed: a number");
  EXPECT_EQ(message_of(with("1e-12", "nan")), "gates.toml:7: at_most: got no number, allowed: a number");
  EXPECT_EQ(message_of(with("at_most = 1e-12", "between = [2, 1]")),
            "gates.toml:7: between: got [2, 1], allowed: [least, most] with least <= most");
  EXPECT_EQ(message_of(with("at_most = 1e-12\n", "")),
            "gates.toml:1: bound: got 0 of them, allowed: exactly one of at_most, at_least, between, equals");
  EXPECT_NE(message_of(with("at_most = 1e-12", "at_most = 1\nat_least = 0")).find("got 2 of them"),
            std::string::npos);
  EXPECT_EQ(message_of(with("h_s = 0.01", "h_s = true")),
            "gates.toml:4: filter.h_s: got no number, allowed: a number");
  EXPECT_NE(message_of(with("\"max\"", "\"largest_rise\"")).find("along: got nothing"), std::string::npos);
  EXPECT_NE(message_of(with("\"max\"", "\"max\"\nalong = \"h_s\"")).find("along: got 'h_s'"),
            std::string::npos);
  EXPECT_NE(message_of(with("at_most = 1e-12", "equals = \"ok\"")).find("equals: got 'ok'"),
            std::string::npos);
}

TEST(Claims, AFileThatIsNotThereIsAnIoError) { EXPECT_THROW(read_claims("/nowhere/gates.toml"), IoError); }

}  // namespace
}  // namespace touchstone::gate
