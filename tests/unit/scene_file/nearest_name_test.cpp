#include "experiments/scene_file/nearest_name.h"

#include <gtest/gtest.h>

#include <array>

namespace touchstone::scene_file {
namespace {

constexpr std::array<std::string_view, 5> kKnown = {"friction", "half_extents", "half_height", "mass",
                                                    "radius"};

TEST(NearestName, FindsWhatWasMeant) {
  const std::pair<const char*, const char*> typed[] = {
      {"mass", "mass"},
      {"mas", "mass"},
      {"masss", "mass"},
      {"Mass", "mass"},
      {"amss", "mass"},
      {"raduis", "radius"},
      {"radii", "radius"},
      {"fricton", "friction"},
      {"height", "half_height"},
      {"halfheight", "half_height"},
      {"half-extents", "half_extents"},
  };
  for (const auto& [word, meant] : typed) EXPECT_EQ(nearest_name(word, kKnown), meant) << word;
}

TEST(NearestName, FindsNothingWhereHalfOfItWouldHaveToChange) {
  for (const char* word : {"", "x", "colour", "weight"}) EXPECT_EQ(nearest_name(word, kKnown), "") << word;
  EXPECT_EQ(nearest_name("mass", {}), "");
}

}  // namespace
}  // namespace touchstone::scene_file
