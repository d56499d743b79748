// What one item hides of another: bands of cloth around the tube person.
#include "assetpipe/find_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "assetpipe/layer_file.h"
#include "assetpipe/pipeline.h"
#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "core/layers.h"
#include "tests/renderer/test_wardrobe.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using namespace testing;

/// A band of cloth on the tube, whose own radius is 0.2 and height 1.8 metres; its rings are the tube's.
/// Shirts are single-sided: the tube has no lids, so one sees a shirt's inside through its open ends.
Item band(const std::string& name, Slot slot, float radius, float bottom, float top) {
  Item item;
  item.name = name;
  item.slot = slot;
  item.visible.assign(kTubeFaces, 1);
  item.materials.push_back(clothMaterial("cloth." + name));
  item.materials[0].double_sided = name != "shirt";
  const int rings = static_cast<int>(std::lround((top - bottom) / 0.15f));
  item.garments.push_back({"garment." + name, {tubeBand(0, radius, bottom, top, rings)}});
  return item;
}

HiddenGarmentFaces under(const Item& inner, const Item& outer, const HiddenFaceOptions& options = {}) {
  const TemplateBody body = tubeBody();
  return findHiddenUnder(inner, outer, body, findHolesOf(inner, body, options), options);
}

/// Per face of an item's only part, its lowest and highest point in the bind pose.
std::pair<float, float> heights(const Item& item, std::size_t face) {
  const ItemPart& part = item.garments[0].parts[0];
  float low = 10.0f, high = -10.0f;
  for (const std::uint32_t v : part.faces[face]) {
    low = std::min(low, part.vertices[v].position.y);
    high = std::max(high, part.vertices[v].position.y);
  }
  return {low, high};
}

std::size_t count(const HiddenGarmentFaces& hidden) {
  return static_cast<std::size_t>(std::count(hidden.begin(), hidden.end(), std::uint8_t{1}));
}

TEST(FindLayers, WhatLiesUnderALongerItemIsHidden) {
  const Item shirt = band("shirt", Slot::kUpper, 0.203f, 0.6f, 1.2f);
  const Item coat = band("coat", Slot::kOver, 0.205f, 0.0f, 1.8f);
  EXPECT_EQ(count(under(shirt, coat)), shirt.garmentFaceCount());
}

TEST(FindLayers, WhatLooksOutIsKept) {
  const Item shirt = band("shirt", Slot::kUpper, 0.203f, 0.0f, 1.8f);
  const Item jacket = band("jacket", Slot::kOver, 0.205f, 0.3f, 1.5f);
  const HiddenGarmentFaces hidden = under(shirt, jacket);
  ASSERT_EQ(hidden.size(), shirt.garmentFaceCount());
  for (std::size_t f = 0; f < hidden.size(); ++f) {
    const auto [low, high] = heights(shirt, f);
    if (high < 0.31f || low > 1.49f) {
      EXPECT_EQ(hidden[f], 0) << low << " to " << high;
    } else if (low > 0.74f && high < 1.06f) {
      EXPECT_EQ(hidden[f], 1) << low << " to " << high;
    }
  }
}

// The shirt lies 5 mm outside the coat, then 15 mm.
TEST(FindLayers, WhatPokesThroughIsHiddenWithinTheTolerance) {
  const Item coat = band("coat", Slot::kOver, 0.22f, 0.0f, 1.8f);
  const Item wide = band("shirt", Slot::kUpper, 0.225f, 0.6f, 1.2f);
  EXPECT_EQ(count(under(wide, coat)), wide.garmentFaceCount());
  EXPECT_EQ(count(under(wide, coat, {.tolerance = 0.0f})), 0u);
  EXPECT_EQ(count(under(band("shirt", Slot::kUpper, 0.235f, 0.6f, 1.2f), coat)), 0u);
}

// A collar that stands off: from above one sees its inside, though its outside is covered.
TEST(FindLayers, BothSidesOfDoubleSidedClothAreLookedAt) {
  Item collar = band("collar", Slot::kUpper, 0.32f, 1.35f, 1.65f);
  const Item scarf = band("scarf", Slot::kOver, 0.33f, 0.9f, 1.65f);
  const std::size_t both = count(under(collar, scarf));
  collar.materials[0].double_sided = false;
  const std::size_t outside = count(under(collar, scarf));
  EXPECT_LT(both, outside);
}

// Without the rule a shoe's inner faces, which no one ever sees, would make a list of its own for each pair.
TEST(FindLayers, APartOfWhichNothingIsCoveredStaysWhole) {
  Item shirt = band("shirt", Slot::kUpper, 0.203f, 0.3f, 1.5f);
  shirt.garments.push_back({"lining", {tubeBand(0, 0.2015f, 0.75f, 1.05f, 2)}});  // no one ever sees it
  const Item boots = band("boots", Slot::kFeet, 0.23f, 0.0f, 0.3f);
  EXPECT_EQ(count(under(shirt, boots)), 0u);
  const HiddenGarmentFaces hidden = under(shirt, band("coat", Slot::kOver, 0.205f, 0.0f, 1.8f));
  const std::size_t outer_faces = shirt.garments[0].parts[0].faces.size();
  EXPECT_EQ(count({hidden.begin(), hidden.begin() + static_cast<std::ptrdiff_t>(outer_faces)}), outer_faces);
}

TEST(FindLayers, PairsAreThoseWornTogetherAndNear) {
  Wardrobe wardrobe;
  wardrobe.body = tubeBody();
  wardrobe.items.push(band("shirt", Slot::kUpper, 0.21f, 0.9f, 1.5f));
  wardrobe.items.push(band("jeans", Slot::kLower, 0.22f, 0.0f, 0.9f));
  wardrobe.items.push(band("jacket", Slot::kOver, 0.23f, 0.75f, 1.5f));
  wardrobe.items.push(band("boots", Slot::kFeet, 0.23f, 0.0f, 0.3f));
  wardrobe.items[ItemId(0)].layer = 2;
  wardrobe.items[ItemId(3)].layer = 3;
  const auto pair = [](std::size_t inner, std::size_t outer) {
    return ItemPair{ItemId(inner), ItemId(outer)};
  };
  const std::vector<ItemPair> all = allLayerPairs(wardrobe);
  EXPECT_EQ(all, (std::vector<ItemPair>{pair(0, 2), pair(1, 0), pair(1, 2), pair(1, 3)}))
      << "boots are far from shirt and jacket";
  const std::vector<Combination> worn = {
      {ItemId(0), ItemId(1)}, {ItemId(0), ItemId(2)}, {ItemId(1), ItemId(3)}};
  EXPECT_EQ(layerPairs(wardrobe, worn), (std::vector<ItemPair>{pair(0, 2), pair(1, 0), pair(1, 3)}));
  wardrobe.items[ItemId(3)].layer = 0;
  EXPECT_EQ(allLayerPairs(wardrobe).size(), 3u) << "equal layers hide nothing of each other";
}

TEST(FindLayers, ACombinationHidesWhatAnyOfItsItemsHides) {
  Wardrobe wardrobe;
  for (int i = 0; i < 3; ++i) wardrobe.items.push(band("a", Slot::kUpper, 0.21f, 0.0f, 0.3f));
  const std::size_t faces = wardrobe.items[ItemId(0)].garmentFaceCount();
  HiddenGarmentFaces one(faces, 0), two(faces, 0);
  one[3] = two[5] = 1;
  wardrobe.hidden_under[{ItemId(0), ItemId(1)}] = one;
  wardrobe.hidden_under[{ItemId(0), ItemId(2)}] = two;
  const auto hidden = [&](const Combination& items) {
    return hiddenInCombination(wardrobe, items, items[0]);
  };
  EXPECT_EQ(hidden({ItemId(0), ItemId(1)}), one);
  EXPECT_EQ(count(hidden({ItemId(0), ItemId(1), ItemId(2)})), 2u);
  EXPECT_TRUE(hidden({ItemId(0)}).empty());
  EXPECT_TRUE(hidden({ItemId(1), ItemId(2)}).empty());
}

/// A wardrobe of a shirt and a coat on disk.
class KeptLayers : public ::testing::Test {
 protected:
  void SetUp() override {
    writeFileAtomically(folder_ / "template.glb", writeGlb(tubeTemplate()));
    for (const auto& [name, slot, radius] :
         {std::tuple("shirt", "upper", 0.203f), std::tuple("coat", "over", 0.205f)}) {
      RawAsset outfit = tubeOutfit([](int, int) { return true; }, radius);
      outfit.materials.back().double_sided = false;
      outfit.scene_extras_json = std::string(R"({"ensemble": {"slot": ")") + slot + "\"}}";
      writeFileAtomically(folder_ / (std::string(name) + ".glb"), writeGlb(outfit));
    }
    tagWardrobe(folder_ / "template.glb", {folder_ / "shirt.glb", folder_ / "coat.glb"}, folder_ / "w", {});
    wardrobe_ = loadWardrobe(folder_ / "w");
  }

  HiddenGarmentFaces found() {
    Wardrobe wardrobe = loadWardrobe(folder_ / "w");
    findLayers(wardrobe, allLayerPairs(wardrobe));
    return wardrobe.hidden_under.at(pair_);
  }
  fs::path file() const { return folder_ / "w" / layerFileName(wardrobe_, pair_, {}); }

  TemporaryFolder folder_;
  Wardrobe wardrobe_;
  ItemPair pair_{ItemId(0), ItemId(1)};
};

TEST_F(KeptLayers, AreFoundOnceAndReadAgain) {
  const HiddenGarmentFaces first = found();
  EXPECT_GT(count(first), 0u);
  ASSERT_TRUE(fs::exists(file()));
  EXPECT_EQ(readLayer(wardrobe_, pair_, {}), first);
  // What is read is what the file says, not what rays find.
  HiddenGarmentFaces other(first.size(), 0);
  other[1] = other[2] = other.back() = 1;
  writeLayer(wardrobe_, pair_, other, {});
  EXPECT_EQ(found(), other);
  EXPECT_FALSE(readLayer(wardrobe_, pair_, {.tolerance = 0.0f}).has_value()) << "looked at in another way";
}

TEST_F(KeptLayers, AreFoundAgainWhereTheFileIsDamaged) {
  const HiddenGarmentFaces first = found();
  std::ifstream in(file());
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from << " in " << text;
    return at == std::string::npos ? changed : changed.replace(at, from.size(), to);
  };
  const std::size_t runs = text.find("\"hidden\":") + 9;
  for (const std::string& damaged :
       {std::string(), text.substr(0, text.size() / 2), replaced("\"faces\":", "\"faces\":1"),
        replaced("ensemble.layer/1", "ensemble.layer/2"), replaced("\"name\":\"coat\"", "\"name\":\"cape\""),
        text.substr(0, runs) + "[[0,4000000000]]}", text.substr(0, runs) + "[[-1,2]]}",
        text.substr(0, runs) + "[[[[[[[[1]]]]]]]]}", text.substr(0, runs) + "[[1.5,2]]}"}) {
    std::ofstream(file()) << damaged;
    EXPECT_FALSE(readLayer(wardrobe_, pair_, {}).has_value()) << damaged;
    EXPECT_EQ(found(), first) << damaged;
    EXPECT_TRUE(readLayer(wardrobe_, pair_, {}).has_value()) << "written anew";
  }
}

TEST_F(KeptLayers, GoWithTheirItems) {
  found();
  ASSERT_TRUE(fs::exists(file()));
  std::ofstream(folder_ / "w" / "layers" / "notes.txt") << "not ours";
  removeOutfits(folder_ / "w", {"coat"});
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_TRUE(fs::exists(folder_ / "w" / "layers" / "notes.txt"));
  addOutfits(folder_ / "w", {folder_ / "coat.glb"}, {});
  found();
  EXPECT_TRUE(fs::exists(file())) << "the same item has the same name";
  addOutfits(folder_ / "w", {}, {});
  EXPECT_TRUE(fs::exists(file())) << "of items that stay";
}

}  // namespace
}  // namespace ensemble
