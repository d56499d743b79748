// crowd.wear and people.wears, as a scene tells them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene.h"
#include "tests/core/scene_fixture.h"

namespace ensemble {
namespace {

using testing::errorAfterHead;
using testing::errorOf;
using testing::kHead;
using testing::parse;

TEST(SceneWear, ReadsWeightsBySlot) {
  const Scene scene = parse(kHead + R"(crowd:
  count: 1
  wear:
    over: {jacket: 1, none: 3}
    upper: {tshirt: 2, women/blouse: 0.5}
people:
  - {wears: [tshirt, women/jeans]}
  - {wears: []}
)");
  ASSERT_EQ(scene.crowd.wear.size(), 2u) << "slots in their own order";
  const SceneWear& upper = scene.crowd.wear[0];
  EXPECT_EQ(upper.slot, Slot::kUpper);
  EXPECT_EQ(upper.mark.toString(), "7:12");
  ASSERT_EQ(upper.items.size(), 2u);
  EXPECT_EQ(upper.items[1].name, "women/blouse");
  EXPECT_EQ(upper.items[1].weight, 0.5f);
  EXPECT_EQ(upper.items[1].mark.key_path, "crowd.wear.upper.women/blouse");
  EXPECT_EQ(scene.crowd.wear[1].slot, Slot::kOver);
  EXPECT_EQ(scene.crowd.wear[1].items[1].name, "none");
  ASSERT_EQ(scene.people[0].wears.size(), 2u);
  EXPECT_EQ(scene.people[0].wears[1].value, "women/jeans");
  EXPECT_EQ(scene.people[0].wears[1].mark.toString(), "9:22");
  EXPECT_TRUE(scene.people[1].wears.empty());
  EXPECT_TRUE(parse(kHead + "crowd: {count: 1}\n").crowd.wear.empty());
}

TEST(SceneWear, CanBeSetFromTheCommandLine) {
  const Scene scene = parse(kHead + "crowd: {count: 1}\n", {{"crowd.wear.lower.jeans", "2"}});
  ASSERT_EQ(scene.crowd.wear.size(), 1u);
  EXPECT_EQ(scene.crowd.wear[0].items[0].weight, 2.0f);
}

TEST(SceneWear, RefusesWhatDressesNobody) {
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {upper: {tshirt: 1, none: 1}}}\n"),
            "3:51: crowd.wear.upper.none: who wears nothing full needs an item of 'upper'; remove it");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {lower: {none: 1}}}\n"),
            "3:40: crowd.wear.lower.none: who wears nothing full needs an item of 'lower'; remove it");
  EXPECT_EQ(
      errorAfterHead("crowd: {count: 1, wear: {uper: {tshirt: 1}}}\n"),
      "3:26: unknown key 'uper' in crowd.wear; write 'upper' (known: hair, head, upper, lower, full, feet, "
      "over)");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {feet: {shoes: 0}}}\n"),
            "3:32: every weight in crowd.wear.feet is 0; give at least one above 0");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {feet: {}}}\n"),
            "3:32: crowd.wear.feet is an empty map; give at least one 'NAME: WEIGHT', or remove the key");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, outfits: {a: 1}, wear: {feet: {b: 1}}}\n"),
            "3:42: crowd.outfits and crowd.wear both tell what people wear; remove one of them");
  const std::string never =
      "crowd.wear.upper is never worn: crowd.wear.full leaves nobody without an item of it; add 'none: "
      "WEIGHT' to crowd.wear.full, or remove the key";
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {full: {dress: 1}, upper: {tshirt: 1}}}\n"),
            "3:51: " + never);
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, wear: {full: {dress: 1, none: 0}, upper: {tshirt: 1}}}\n"),
            "3:60: " + never);
}

// In the reference scene they are comments, since there people wear fixed outfits.
TEST(SceneWear, IsInTheReferenceScene) {
  const std::string text = referenceScene();
  const auto rest = [&](const std::string& key) {
    const std::size_t begin = text.find("# " + key + ": ");
    EXPECT_NE(begin, std::string::npos) << key;
    return text.substr(begin + 2, text.find('\n', begin) - begin - 2);
  };
  const Scene scene =
      parse(kHead + "crowd:\n  count: 1\n  " + rest("wear") + "\npeople:\n  - " + rest("wears") + "\n");
  EXPECT_EQ(scene.crowd.wear.size(), 3u);
  EXPECT_EQ(scene.people[0].wears.size(), 3u);
}

TEST(SceneWear, RefusesTwoWaysToDressAPerson) {
  EXPECT_EQ(errorAfterHead("people: [{outfit: casual01, wears: [tshirt]}]\n"),
            "3:36: the person has an outfit and wears something else; remove 'outfit' or 'wears'");
  EXPECT_EQ(errorAfterHead("people: [{wears: tshirt}]\n"),
            "3:18: people.0.wears is 'tshirt'; give a list of items");
}

}  // namespace
}  // namespace ensemble
