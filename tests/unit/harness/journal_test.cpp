#include "experiments/harness/journal.h"

#include <gtest/gtest.h>

#include "core/model/errors.h"
#include "tests/unit/harness/scratch.h"

namespace touchstone::harness {
namespace {

using test::Scratch;
using test::slurp;
using test::spit;

const FinishedCase kOne = {{CaseStatus::ok, "", {{{"1", ""}, {"0.1", "x,\"y\"\n"}}, {}}}, 1.5};
const FinishedCase kTwo = {{CaseStatus::failed, "step 3: stalled", {}}, 0.25};

void write_two(const std::filesystem::path& file) {
  Journal journal(file, "stamp");
  journal.append("one", kOne);
  journal.append("two", kTwo);
}

void expect_equal(const FinishedCase& a, const FinishedCase& b) {
  EXPECT_EQ(a.result.status, b.result.status);
  EXPECT_EQ(a.result.reason, b.result.reason);
  EXPECT_EQ(a.result.tables, b.result.tables);
  EXPECT_EQ(a.wall_s, b.wall_s);
}

TEST(Journal, GivesBackWhatItWasTold) {
  const Scratch scratch;
  write_two(scratch / "j");
  const Journal again(scratch / "j", "stamp");
  ASSERT_EQ(again.finished().size(), 2u);
  expect_equal(again.finished().at("one"), kOne);
  expect_equal(again.finished().at("two"), kTwo);
  EXPECT_FALSE(again.was_stale());
}

TEST(Journal, OfAnotherStampIsStale) {
  const Scratch scratch;
  write_two(scratch / "j");
  EXPECT_TRUE(read_journal(scratch / "j", "other").empty());
  const Journal other(scratch / "j", "other");
  EXPECT_TRUE(other.finished().empty());
  EXPECT_TRUE(other.was_stale());
}

TEST(Journal, ALineCutShortAtAnyByteIsDroppedAndTheRestKept) {
  const Scratch scratch;
  write_two(scratch / "j");
  const std::string whole = slurp(scratch / "j");
  const std::size_t second = whole.rfind('\n', whole.size() - 2) + 1;
  for (std::size_t length = second; length < whole.size(); length += 7) {
    spit(scratch / "cut", whole.substr(0, length));
    Journal journal(scratch / "cut", "stamp");
    ASSERT_EQ(journal.finished().size(), 1u) << length;
    journal.append("two", kTwo);
    EXPECT_EQ(slurp(scratch / "cut"), whole) << length;
  }
}

TEST(Journal, NothingAfterADamagedLineIsUsed) {
  const Scratch scratch;
  write_two(scratch / "j");
  std::string text = slurp(scratch / "j");
  text[text.find("\"ok\"") + 1] = 'X';
  spit(scratch / "j", text);
  EXPECT_TRUE(Journal(scratch / "j", "stamp").finished().empty());
}

TEST(Journal, IsHeldByOneRunAtATime) {
  const Scratch scratch;
  const Journal journal(scratch / "j", "stamp");
  try {
    const Journal other(scratch / "j", "stamp");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("another run is writing it"), std::string::npos);
  }
  EXPECT_THROW(read_journal(scratch / "j", "stamp"), IoError);
}

TEST(Journal, TextThatIsNotUtf8DoesNotEndASweep) {
  const Scratch scratch;
  Journal journal(scratch / "j", "stamp");
  journal.append("odd", {{CaseStatus::failed, "\xff engine", {}}, 0.0});
  EXPECT_NE(slurp(scratch / "j").find(" engine"), std::string::npos);
}

TEST(Journal, IsGoneWhenItsCasesAreInTheTables) {
  const Scratch scratch;
  Journal journal(scratch / "j", "stamp");
  journal.remove();
  EXPECT_FALSE(std::filesystem::exists(scratch / "j"));
}

TEST(Journal, AKeyTellsEveryCellOfACase) {
  CaseId id{"s", "m", "a=1;b=2", {"10", "nearest:2"}, 0.01, 10};
  EXPECT_EQ(case_key(id), "s,m,a=1;b=2,10,nearest:2,0.01,10");
  id.options = "a=1,2";
  EXPECT_EQ(case_key(id), "s,m,\"a=1,2\",10,nearest:2,0.01,10");
}

}  // namespace
}  // namespace touchstone::harness
