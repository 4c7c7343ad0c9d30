#include "experiments/harness/record.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace touchstone::harness {
namespace {

TEST(Record, IsFilledByNameAndEmptyElsewhere) {
  const std::vector<std::string> columns = {"a", "b", "c", "d"};
  Record record(columns);
  record.set("c", 0.5).set("a", "text").set("d", 3);
  EXPECT_EQ(record.row(), (Row{"text", "", "0.5", "3"}));
  record.set("c", std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(record.row()[2], "");
}

TEST(Record, AColumnThatIsNotThereIsABug) {
  const std::vector<std::string> columns = {"a"};
  EXPECT_THROW(Record(columns).set("b", 1), std::logic_error);
}

}  // namespace
}  // namespace touchstone::harness
