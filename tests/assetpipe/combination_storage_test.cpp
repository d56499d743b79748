#include "assetpipe/combination_storage.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "assetpipe/report.h"
#include "tests/renderer/test_wardrobe.h"

namespace ensemble {
namespace {

/// Twelve items of all slots on the tube person; what they hide overlaps.
Wardrobe manySlots() {
  Wardrobe wardrobe;
  wardrobe.body = testing::tubeBody();
  const auto add = [&](const std::string& name, Slot slot, float radius, const auto& keep) {
    Item item = testing::tubeItem(name, wardrobe.body, keep);
    item.slot = slot;
    testing::addBand(item, "garment." + name, testing::clothMaterial("cloth." + name), radius, 0.3f, 1.2f);
    wardrobe.items.push(std::move(item));
  };
  const auto all = [](int, int) { return true; };
  add("bob", Slot::kHair, 0.21f, [](int region, int face) { return region != 2 || face < 50; });
  add("long", Slot::kHair, 0.22f, [](int region, int face) { return region != 2 || face < 40; });
  add("hat", Slot::kHead, 0.23f, [](int region, int face) { return region != 2 || face < 45; });
  add("tshirt", Slot::kUpper, 0.24f, [](int region, int face) { return region != 1 || face >= 40; });
  add("jumper", Slot::kUpper, 0.25f, [](int region, int) { return region != 1; });
  add("jeans", Slot::kLower, 0.26f, [](int region, int) { return region != 0; });
  add("shorts", Slot::kLower, 0.27f, [](int region, int face) { return region != 0 || face < 20; });
  add("dress", Slot::kFull, 0.28f,
      [](int region, int face) { return region == 2 || (region == 0 && face < 9); });
  add("shoes", Slot::kFeet, 0.29f, [](int region, int face) { return region != 0 || face >= 8; });
  add("boots", Slot::kFeet, 0.30f, [](int region, int face) { return region != 0 || face >= 16; });
  add("scarf", Slot::kOver, 0.31f, all);
  add("jacket", Slot::kOver, 0.32f, [](int region, int face) { return region != 1 || face % 3 == 0; });
  return wardrobe;
}

/// Every combination that dresses a person, by trying all sets of items.
std::vector<Combination> allCombinations(const Wardrobe& wardrobe) {
  std::vector<Combination> valid;
  for (std::uint32_t bits = 0; bits < 1u << wardrobe.items.size(); ++bits) {
    Combination items;
    PerSlot<int> worn;
    bool is_valid = true;
    for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
      if ((bits >> i & 1u) == 0) continue;
      for (const ItemId other : items) {
        is_valid = is_valid && !exclude(wardrobe.items[other].slot, wardrobe.items[ItemId(i)].slot);
      }
      items.push_back(ItemId(i));
      ++worn[wardrobe.items[ItemId(i)].slot];
    }
    const bool is_dressed = worn[Slot::kFull] > 0 || (worn[Slot::kUpper] > 0 && worn[Slot::kLower] > 0);
    if (is_valid && is_dressed) valid.push_back(items);
  }
  return valid;
}

void expectEqual(const CombinationStorage& a, const CombinationStorage& b) {
  EXPECT_EQ(a.visible_bodies, b.visible_bodies);
  EXPECT_EQ(a.dedicated_sub_meshes, b.dedicated_sub_meshes);
  EXPECT_EQ(a.lower_bound_bytes, b.lower_bound_bytes);
  EXPECT_EQ(a.tagged_bytes, b.tagged_bytes);
  EXPECT_EQ(a.prefitted_bytes, b.prefitted_bytes);
}

// What is added up without lists is what the lists hold.
TEST(CombinationStorage, CountsAsTheListsThatAreDrawn) {
  const Wardrobe wardrobe = manySlots();
  const std::vector<Combination> combinations = allCombinations(wardrobe);
  const SubMeshLists tagged = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  const SubMeshLists prefitted = buildSubMeshLists(wardrobe, combinations, Technique::kPrefitted);
  const CombinationStorage stored = storeCombinations(wardrobe, combinations);
  EXPECT_EQ(stored.tagged_bytes, tagged.meshBytes());
  EXPECT_EQ(stored.prefitted_bytes, prefitted.meshBytes());
  EXPECT_EQ(stored.lower_bound_bytes, lowerBoundBytes(wardrobe, combinations));
  EXPECT_EQ(stored.visible_bodies, tagged.hidden_sets.size());
  EXPECT_GT(stored.visible_bodies, 20u);
  EXPECT_LT(stored.visible_bodies, combinations.size()) << "a scarf hides nothing";
  const auto is_body = [](const IndexList& list) { return list.is_template; };
  EXPECT_EQ(stored.dedicated_sub_meshes + 3,
            static_cast<std::uint64_t>(
                std::count_if(tagged.index_lists.begin(), tagged.index_lists.end(), is_body)))
      << "and the three whole regions";
}

TEST(CombinationStorage, AWardrobesAreThoseOfAllItsCombinations) {
  const Wardrobe wardrobe = manySlots();
  const std::vector<Combination> combinations = allCombinations(wardrobe);
  const WardrobeCombinations counted = countWardrobe(wardrobe);
  EXPECT_EQ(counted.count, combinations.size());
  EXPECT_EQ(counted.items[Slot::kFeet], 2u);
  ASSERT_TRUE(counted.stored.has_value());
  expectEqual(*counted.stored, storeCombinations(wardrobe, combinations));
}

TEST(CombinationStorage, StopsWhereThereAreTooManyBodies) {
  const Wardrobe wardrobe = manySlots();
  const std::uint64_t bodies = countWardrobe(wardrobe).stored.value().visible_bodies;
  EXPECT_TRUE(countWardrobe(wardrobe, bodies).stored.has_value());
  const WardrobeCombinations stopped = countWardrobe(wardrobe, bodies - 1);
  EXPECT_FALSE(stopped.stored.has_value());
  EXPECT_EQ(stopped.count, allCombinations(wardrobe).size());
}

TEST(CombinationStorage, ThatOfNobodyIsEmpty) {
  const Wardrobe wardrobe = manySlots();
  const CombinationStorage nobody = storeCombinations(wardrobe, {});
  EXPECT_EQ(nobody.visible_bodies, 0u);
  EXPECT_EQ(nobody.tagged_bytes, nobody.lower_bound_bytes) << "the template";
  EXPECT_EQ(nobody.prefitted_bytes, 0u);
}

// 190 bodies that each lack two faces of the legs: what all of them show is listed once, and drawn in one
// order by all techniques.
TEST(CombinationStorage, WhatAllBodiesShowIsListedOnce) {
  Wardrobe wardrobe;
  wardrobe.body = testing::tubeBody();
  for (int hidden = 0; hidden < 20; ++hidden) {
    wardrobe.items.push(testing::tubeItem(std::to_string(hidden), wardrobe.body, [&](int region, int face) {
      return region != 0 || face != hidden;
    }));
  }
  std::vector<Combination> pairs;
  for (std::size_t a = 0; a < 20; ++a) {
    for (std::size_t b = a + 1; b < 20; ++b) pairs.push_back({ItemId(a), ItemId(b)});
  }
  const SubMeshLists tagged = buildSubMeshLists(wardrobe, pairs, Technique::kTagged);
  const SubMeshLists prefitted = buildSubMeshLists(wardrobe, pairs, Technique::kPrefitted);
  const CombinationStorage stored = storeCombinations(wardrobe, pairs);
  EXPECT_EQ(stored.dedicated_sub_meshes, 190u);
  EXPECT_EQ(stored.tagged_bytes, stored.lower_bound_bytes + 190u * 18 * 6) << "of 20 faces, not of 64";
  EXPECT_EQ(stored.tagged_bytes, tagged.meshBytes());
  EXPECT_EQ(stored.prefitted_bytes, prefitted.meshBytes());
  const auto drawn = [](const SubMeshLists& lists, std::size_t combination) {
    std::vector<std::uint32_t> faces;
    for (const SubMeshId id : lists.shown[combination]) {
      const auto& source = lists.index_lists[lists.sub_meshes[id].list].source_faces;
      faces.insert(faces.end(), source.begin(), source.end());
    }
    return faces;
  };
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    EXPECT_EQ(drawn(tagged, c).size(), 190u);
    EXPECT_EQ(drawn(tagged, c), drawn(prefitted, c)) << c;
  }
}

TEST(CombinationStorage, IsToldByTheReport) {
  const Report report = makeReport(manySlots());
  EXPECT_EQ(report.combinations.count, 270u);
  const std::string table = toTable(report);
  EXPECT_NE(table.find("\n270 combinations of 2 hair, 1 head, 2 upper, 2 lower, 1 full, 2 feet, 2 over\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find(" different visible bodies, "), std::string::npos) << table;
  Wardrobe outfits = manySlots();
  for (Item& item : outfits.items) item.slot = Slot::kFull;
  EXPECT_EQ(toTable(makeReport(outfits)).find("combinations"), std::string::npos);
}

}  // namespace
}  // namespace ensemble
