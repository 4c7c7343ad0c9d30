#include "tools/touchstone/listing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "baselines/registry.h"
#include "experiments/scenarios/table.h"

namespace touchstone::program {
namespace {

/// The first words of the lines after the header.
std::vector<std::string> keys(const std::string& listing) {
  std::istringstream lines(listing);
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> keys;
  while (std::getline(lines, line)) keys.push_back(line.substr(0, line.find(' ')));
  return keys;
}

std::string line_of(const std::string& listing, const std::string& key) {
  const auto at = listing.find("\n" + key + " ") + 1;
  return listing.substr(at, listing.find('\n', at) - at);
}

TEST(Listing, HasEveryMethodOnceSorted) {
  const std::vector<std::string> listed = keys(list_methods());
  EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end()));
  EXPECT_EQ(std::adjacent_find(listed.begin(), listed.end()), listed.end());
  const auto has = [&](std::string_view key) {
    return std::find(listed.begin(), listed.end(), key) != listed.end();
  };
  for (const auto& entry : methods<2>()) EXPECT_TRUE(has(entry.key)) << entry.key;
  for (const auto& entry : methods<3>()) EXPECT_TRUE(has(entry.key)) << entry.key;
}

TEST(Listing, SaysWhatAMethodCanDo) {
  const std::string line = line_of(list_methods(), "implicit_ncp");
  for (const char* word : {" 2,3 ", "impulses,torsion,anisotropy", "Geometrically implicit NCP"}) {
    EXPECT_NE(line.find(word), std::string::npos) << line;
  }
}

TEST(Listing, HasEveryScenarioSortedWithItsQuestion) {
  const std::vector<std::string> listed = keys(list_scenarios());
  EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end()));
  ASSERT_EQ(listed.size(), scenarios().size());
  for (const ScenarioEntry& entry : scenarios()) {
    const std::string line = line_of(list_scenarios(), std::string(entry.key));
    EXPECT_TRUE(line.ends_with("  " + std::string(entry.question))) << line;
    EXPECT_TRUE(entry.question.ends_with("?")) << entry.question;
  }
}

TEST(Listing, DescribesASoundScene) {
  const std::string file = std::string(EXAMPLE_SCENES) + "/pendulum.toml";
  EXPECT_EQ(describe_scene(file),
            file + ": sound: 2 dimensions, 2 bodies of which 1 moves, 0 pair laws, 1 joint\n");
}

}  // namespace
}  // namespace touchstone::program
