#include "core/nearest_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ensemble {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("abc", ""), 3u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(editDistance("sitting", "kitten"), 3u);
  EXPECT_EQ(editDistance("widht", "width"), 1u);
  EXPECT_EQ(editDistance("Walk", "walk"), 0u);
  EXPECT_EQ(editDistance(std::string(1000, 'a'), std::string(64, 'a')), 0u);
}

TEST(NearestName, ListsTheNearestFirstAndFarOnesOnlyWhenThereIsNoOther) {
  const std::vector<std::string> known{"walk", "idle", "walk_fast", "walks"};
  EXPECT_THAT(nearestNames("walkk", known, 3), ElementsAre("walk", "walks"));
  EXPECT_THAT(nearestNames("walkk", known), ElementsAre("walk"));
  EXPECT_THAT(nearestNames("zzzzzzzz", known, 3), ElementsAre("walk"));
  EXPECT_THAT(nearestNames("a", {}, 3), IsEmpty());
}

TEST(NearestName, QuotesNames) {
  EXPECT_EQ(quotedName("a"), "'a'");
  EXPECT_EQ(quotedName(std::string(65, 'a')), "'" + std::string(64, 'a') + "...'");
  const std::vector<std::string> names{"a", "b", "c"};
  EXPECT_EQ(quotedList({}), "");
  EXPECT_EQ(quotedList(std::span(names).first(1)), "'a'");
  EXPECT_EQ(quotedList(std::span(names).first(2)), "'a' or 'b'");
  EXPECT_EQ(quotedList(names, "and"), "'a', 'b' and 'c'");
}

}  // namespace
}  // namespace ensemble
