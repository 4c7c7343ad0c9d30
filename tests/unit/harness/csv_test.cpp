#include "experiments/harness/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/model/errors.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::harness {
namespace {

std::string message_of(const std::string& text) {
  try {
    parse_csv(text, "t.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Csv, NumbersAreTheShortestThatReadBack) {
  EXPECT_EQ(number_cell(0.1), "0.1");
  EXPECT_EQ(number_cell(6.75), "6.75");
  EXPECT_EQ(number_cell(1e-12), "1e-12");
  EXPECT_EQ(number_cell(1.0), "1");
  EXPECT_EQ(number_cell(-0.0), "0");
  EXPECT_EQ(number_cell(100000L), "100000");
  std::mt19937_64 random(7);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 600) - 300);
    double back = 0;
    ASSERT_TRUE(parse_number(number_cell(value), back));
    EXPECT_EQ(back, value);
  }
}

TEST(Csv, WhatIsNotFiniteIsMissing) {
  EXPECT_EQ(number_cell(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_EQ(number_cell(std::numeric_limits<double>::infinity()), "");
}

TEST(Csv, ANumberIsAllOfTheText) {
  double value = 0;
  EXPECT_FALSE(parse_number("", value));
  EXPECT_FALSE(parse_number("1x", value));
  EXPECT_FALSE(parse_number(" 1", value));
  EXPECT_FALSE(parse_number("1,5", value));
}

TEST(Csv, QuotesOnlyWhatMustBe) {
  EXPECT_EQ(format_csv({{"a", "b"}, {{"plain; text", "with, comma"}, {"say \"no\"", "two\nlines"}}}),
            "a,b\nplain; text,\"with, comma\"\n\"say \"\"no\"\"\",\"two\nlines\"\n");
}

TEST(Csv, ReadsBackWhatItWrote) {
  const Table table{{"a", "b"}, {{"", "x,\"y\"\n"}, {"\r", "1e-12"}, {"\"", ""}}};
  const Table back = parse_csv(format_csv(table), "t.csv");
  EXPECT_EQ(back.header, table.header);
  EXPECT_EQ(back.rows, table.rows);
}

TEST(Csv, AcceptsOtherLineEndsAndNoLastOne) {
  const Table table = parse_csv("a,b\r\n1,2\r\n3,4", "t.csv");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[1], (Row{"3", "4"}));
}

TEST(Csv, ErrorsNameFileAndLine) {
  EXPECT_EQ(message_of(""), "t.csv:1: got an empty file, allowed: a header line");
  EXPECT_EQ(message_of("a,b\n1,2\n3\n"), "t.csv:3: got 1 cells, allowed: 2 cells, as in the header");
  EXPECT_EQ(message_of("a,b\n\"1\n2\",3\n4,5,6\n"),
            "t.csv:4: got 3 cells, allowed: 2 cells, as in the header");
  EXPECT_NE(message_of("a\n1\n\"2\n").find("t.csv:3: got a quote that is never closed"), std::string::npos);
  EXPECT_NE(message_of("a\n1\"2\n").find("t.csv:2: got a quote inside a cell"), std::string::npos);
  EXPECT_NE(message_of("a\n\"1\"2\n").find("t.csv:2: got text after a closing quote"), std::string::npos);
}

TEST(Csv, AMissingColumnIsNamedWithThoseThereAre) {
  const Table table{{"a", "b"}, {}};
  EXPECT_EQ(table.column("b", "t.csv"), 1u);
  try {
    static_cast<void>(table.column("c", "t.csv"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "t.csv column: got 'c', allowed: one of a, b");
  }
}

TEST(Csv, SortsNumbersByValueAndDigitsInTextByValue) {
  Table table{{"k"}, {{"edges=100"}, {"1e-3"}, {"edges=20"}, {""}, {"0.5"}, {"edges=020"}, {"-1"}, {"10"}}};
  sort_rows(table);
  std::vector<std::string> order;
  for (const Row& row : table.rows) order.push_back(row[0]);
  EXPECT_EQ(order,
            (std::vector<std::string>{"", "-1", "1e-3", "0.5", "10", "edges=020", "edges=20", "edges=100"}));
}

TEST(Csv, TheOrderDoesNotDependOnTheOrderBefore) {
  std::vector<Row> rows;
  for (const char* a : {"", "2", "10", "x2", "x10", "x"}) {
    for (const char* b : {"0.1", "1e-2", "z"}) rows.push_back({a, b});
  }
  Table first{{"a", "b"}, rows};
  sort_rows(first);
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    std::shuffle(rows.begin(), rows.end(), random);
    Table other{{"a", "b"}, rows};
    sort_rows(other);
    EXPECT_EQ(other.rows, first.rows);
  }
}

TEST(Csv, AFileThatIsNotThereIsAnIoErrorWithItsPath) {
  const test::Scratch scratch;
  try {
    read_csv(scratch / "none.csv");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("none.csv: No such file"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace touchstone::harness
