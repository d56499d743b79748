// What the crowd wears where items are combined (renderer/crowd_clothes.h), through populateCrowd.
#include "renderer/crowd_clothes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/input_error.h"
#include "renderer/crowd.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;

Wardrobe makeWardrobe(const std::vector<std::pair<std::string, Slot>>& items) {
  Wardrobe wardrobe;
  for (const auto& [name, slot] : items) {
    Item& item = wardrobe.items.raw().emplace_back();
    item.name = name;
    item.slot = slot;
  }
  return wardrobe;
}

const std::string kOne = "wardrobe: w\n";
const std::string kTwo = "wardrobe: {women: w, men: m}\n";

std::vector<Wardrobe> one() {
  return {makeWardrobe({{"bob", Slot::kHair},
                        {"hat", Slot::kHead},
                        {"tshirt", Slot::kUpper},
                        {"jumper", Slot::kUpper},
                        {"jeans", Slot::kLower},
                        {"shorts", Slot::kLower},
                        {"skirt", Slot::kLower},
                        {"dress", Slot::kFull},
                        {"shoes", Slot::kFeet},
                        {"boots", Slot::kFeet},
                        {"jacket", Slot::kOver}})};
}
std::vector<Wardrobe> two() {
  return {one()[0], makeWardrobe({{"tshirt", Slot::kUpper}, {"jeans", Slot::kLower}, {"suit", Slot::kFull}})};
}

Scene parse(const std::string& text) { return parseScene("version: 1\n" + text, "a.yaml"); }
Crowd crowdOf(const std::string& text, const std::vector<Wardrobe>& wardrobes) {
  return populateCrowd(parse(text), wardrobes);
}
std::string errorOf(const std::string& text, const std::vector<Wardrobe>& wardrobes) {
  try {
    crowdOf(text, wardrobes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// How many people wear each item; "" counts the people.
std::map<std::string, int> wearersOf(const Crowd& crowd, const std::vector<Wardrobe>& wardrobes,
                                     std::uint32_t wardrobe = 0) {
  std::map<std::string, int> wearers;
  for (const Character& person : crowd.characters) {
    if (person.wardrobe != wardrobe) continue;
    ++wearers[""];
    for (const ItemId item : crowd.combinations[person.combination].items) {
      ++wearers[wardrobes[wardrobe].items[item].name];
    }
  }
  return wearers;
}

/// Within five standard deviations of a binomial distribution.
void expectBinomial(int observed, int trials, double probability) {
  const double deviation = std::sqrt(trials * probability * (1.0 - probability));
  EXPECT_NEAR(observed, trials * probability, 5.0 * deviation);
}

void expectValid(const Crowd& crowd, const std::vector<Wardrobe>& wardrobes) {
  for (const WornCombination& worn : crowd.combinations) {
    const PerItem<Item>& items = wardrobes[worn.wardrobe].items;
    PerSlot<int> worn_of;
    for (const ItemId item : worn.items) ++worn_of[items[item].slot];
    for (const Slot slot : kAllSlots) EXPECT_LE(worn_of[slot], 1) << toString(slot);
    EXPECT_EQ(worn_of[Slot::kUpper] + worn_of[Slot::kFull], 1);
    EXPECT_EQ(worn_of[Slot::kLower] + worn_of[Slot::kFull], 1);
    EXPECT_TRUE(std::is_sorted(worn.items.begin(), worn.items.end()));
  }
}

TEST(CrowdClothes, WithoutWeightsAllItemsOfASlotAreAlike) {
  constexpr int kCount = 20'000;
  const Crowd crowd = crowdOf(kOne + "crowd: {count: 20000, seed: 5}\n", one());
  expectValid(crowd, one());
  std::map<std::string, int> wearers = wearersOf(crowd, one());
  EXPECT_EQ(wearers["bob"], kCount) << "who has hair wears it";
  EXPECT_EQ(wearers["shoes"] + wearers["boots"], kCount);
  expectBinomial(wearers["shoes"], kCount, 0.5);
  expectBinomial(wearers["hat"], kCount, 0.25);
  expectBinomial(wearers["jacket"], kCount, 0.4);
  for (const char* name : {"tshirt", "jumper", "dress"}) expectBinomial(wearers[name], kCount, 1.0 / 3);
  for (const char* name : {"jeans", "shorts", "skirt"}) expectBinomial(wearers[name], kCount, 2.0 / 9);
}

TEST(CrowdClothes, CombinesEverythingWithEverything) {
  const Crowd crowd = crowdOf(kOne + "crowd: {count: 20000}\n", one());
  // (2 x 3 + 1) to dress in, bob, with and without a hat and a jacket, 2 pairs of shoes.
  EXPECT_EQ(crowd.combinations.size(), 7u * 2 * 2 * 2);
}

TEST(CrowdClothes, FollowsTheWeights) {
  constexpr int kCount = 20'000;
  const Crowd crowd = crowdOf(kOne + R"(crowd:
  count: 20000
  wear:
    full: {dress: 1, none: 4}
    upper: {tshirt: 3, jumper: 1}
    lower: {jeans: 1, skirt: 0}
    over: {jacket: 1, none: 3}
    head: {none: 1}
    feet: {boots: 2}
)",
                              one());
  expectValid(crowd, one());
  std::map<std::string, int> wearers = wearersOf(crowd, one());
  expectBinomial(wearers["dress"], kCount, 0.2);
  const int halves = kCount - wearers["dress"];
  expectBinomial(wearers["tshirt"], halves, 0.75);
  EXPECT_EQ(wearers["jeans"], halves);
  EXPECT_EQ(wearers.count("shorts") + wearers.count("skirt") + wearers.count("hat"), 0u);
  expectBinomial(wearers["jacket"], kCount, 0.25);
  EXPECT_EQ(wearers["boots"], kCount);
  EXPECT_EQ(wearers["bob"], kCount) << "a slot that is left out";
}

TEST(CrowdClothes, DrawsEachSlotOnItsOwn) {
  constexpr int kCount = 20'000;
  const Crowd crowd = crowdOf(kOne + "crowd: {count: 20000, wear: {full: {none: 1}}}\n", one());
  std::map<Combination, int> wearers;
  for (const Character& person : crowd.characters) {
    const Combination& items = crowd.combinations[person.combination].items;
    Combination halves;
    for (const ItemId item : items) {
      if (item.value >= 2 && item.value <= 6) halves.push_back(item);
    }
    ++wearers[halves];
  }
  ASSERT_EQ(wearers.size(), 6u);
  for (const auto& [halves, count] : wearers) expectBinomial(count, kCount, 1.0 / 6);
}

TEST(CrowdClothes, AChangeOfOneSlotChangesNoOther) {
  const Crowd plain = crowdOf(kOne + "crowd: {count: 300, wear: {full: {none: 1}}}\n", one());
  const Crowd changed =
      crowdOf(kOne + "crowd: {count: 300, wear: {full: {none: 1}, upper: {jumper: 1}}}\n", one());
  const Crowd again = crowdOf(kOne + "crowd: {count: 300, wear: {full: {none: 1}}}\n", one());
  int moved = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    Combination before = plain.combinations[plain.characters[i].combination].items;
    Combination after = changed.combinations[changed.characters[i].combination].items;
    EXPECT_EQ(before, again.combinations[again.characters[i].combination].items);
    moved += before != after ? 1 : 0;
    for (Combination* items : {&before, &after}) {
      std::erase_if(*items, [](ItemId item) { return item == ItemId(2) || item == ItemId(3); });
    }
    EXPECT_EQ(before, after) << i;
  }
  EXPECT_GT(moved, 100);
}

TEST(CrowdClothes, ABareNameIsTheItemOfEveryWardrobe) {
  const Crowd crowd = crowdOf(kTwo + R"(crowd:
  count: 4000
  wear: {full: {men/suit: 1, none: 1}, upper: {tshirt: 1}, lower: {women/skirt: 1, men/jeans: 1}}
)",
                              two());
  expectValid(crowd, two());
  std::map<std::string, int> women = wearersOf(crowd, two(), 0), men = wearersOf(crowd, two(), 1);
  EXPECT_EQ(women["tshirt"], women[""]) << "no dress is listed";
  EXPECT_EQ(women["skirt"], women[""]);
  expectBinomial(men["suit"], men[""], 0.5);
  EXPECT_EQ(men["tshirt"] + men["suit"], men[""]);
  EXPECT_EQ(men.count("shoes"), 0u) << "men have none";
}

TEST(CrowdClothes, OldWardrobesOfCompleteOutfitsAreWornAsBefore) {
  const std::vector<Wardrobe> full = {
      makeWardrobe({{"a", Slot::kFull}, {"b", Slot::kFull}, {"c", Slot::kFull}})};
  const Crowd drawn = crowdOf(kOne + "crowd: {count: 200, seed: 9}\n", full);
  const Crowd listed = crowdOf(kOne + "crowd: {count: 200, seed: 9, outfits: {a: 1, b: 1, c: 1}}\n", full);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(drawn.characters[i].combination, listed.characters[i].combination);
  }
}

TEST(CrowdClothes, OutfitsMayBeCombinations) {
  const Crowd crowd =
      crowdOf(kOne + "crowd: {count: 500, outfits: {shoes+tshirt+jeans: 1, hat: 1}}\n", one());
  EXPECT_THAT(crowd.combinations, ElementsAre(WornCombination{0, {ItemId(1)}},
                                              WornCombination{0, {ItemId(2), ItemId(4), ItemId(8)}}));
  EXPECT_EQ(outfitName(one()[0], crowd.combinations[1].items), "tshirt+jeans+shoes");
  const Crowd both =
      crowdOf(kTwo + "crowd: {count: 500, outfits: {men/tshirt+jeans: 1, bob+dress: 1}}\n", two());
  EXPECT_THAT(both.combinations, ElementsAre(WornCombination{0, {ItemId(0), ItemId(7)}},
                                             WornCombination{1, {ItemId(0), ItemId(1)}}));
}

TEST(CrowdClothes, PeopleWearWhatTheirItemsSay) {
  const Crowd crowd = crowdOf(kTwo + R"(people:
  - {wardrobe: women, wears: [shoes, women/tshirt, jeans]}
  - {wardrobe: women, outfit: tshirt+jeans+shoes}
  - {wardrobe: men, wears: [jeans]}
)",
                              two());
  EXPECT_THAT(crowd.combinations, ElementsAre(WornCombination{0, {ItemId(2), ItemId(4), ItemId(8)}},
                                              WornCombination{1, {ItemId(1)}}));
  EXPECT_EQ(crowd.characters[0].combination, crowd.characters[1].combination);
}

TEST(CrowdClothesErrors, ItemsThatExcludeEachOther) {
  EXPECT_EQ(errorOf(kOne + "people: [{wears: [tshirt, jumper]}]\n", one()),
            "a.yaml: 3:27: 'tshirt' and 'jumper' are both of the slot 'upper'; write one of them");
  EXPECT_EQ(
      errorOf(kOne + "people: [{wears: [dress, shoes, jumper]}]\n", one()),
      "a.yaml: 3:33: 'dress' is of the slot 'full' and 'jumper' of 'upper', which exclude each other; write "
      "one of them");
  EXPECT_EQ(
      errorOf(kOne + "crowd: {count: 1, outfits: {jeans+dress: 1}}\n", one()),
      "a.yaml: 3:42: 'jeans' is of the slot 'lower' and 'dress' of 'full', which exclude each other; write "
      "one of them");
}

TEST(CrowdClothesErrors, NamesThatDoNotExist) {
  EXPECT_EQ(errorOf(kOne + "people: [{wears: [tshirt, jens]}]\n", one()),
            "a.yaml: 3:27: the wardrobe 'w' has no outfit 'jens'; write 'jeans'");
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 1, wear: {lower: {jens: 1}}}\n", one()),
            "a.yaml: 3:40: the wardrobe 'w' has no item 'jens' of the slot 'lower'; write 'jeans'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, wear: {lower: {jens: 1}}}\n", two()),
            "a.yaml: 3:40: no wardrobe has an item 'jens' of the slot 'lower'; write 'jeans'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, wear: {lower: {men/skirt: 1}}}\n", two()),
            "a.yaml: 3:45: the wardrobe 'men' has no item 'skirt' of the slot 'lower'; write 'jeans'");
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 1, wear: {lower: {tshirt: 1}}}\n", one()),
            "a.yaml: 3:42: 'tshirt' is of the slot 'upper'; move it to crowd.wear.upper");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, wear: {upper: {tshirt: 1, men/tshirt: 1}}}\n", two()),
            "a.yaml: 3:57: the item 'men/tshirt' is here a second time; remove one of them");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {tshirt+jeans: 1}}\n", two()),
            "a.yaml: 3:43: 2 wardrobes have an outfit 'tshirt+jeans'; write 'women/tshirt+jeans' or "
            "'men/tshirt+jeans'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {suit+bob: 1}}\n", two()),
            "a.yaml: 3:39: no wardrobe has all of 'suit+bob'; write items of one wardrobe");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {tshirt+jens: 1}}\n", two()),
            "a.yaml: 3:42: no wardrobe has an outfit 'jens'; write 'women/jeans' or 'men/jeans'");
}

TEST(CrowdClothesErrors, WardrobesThatCantDressAPerson) {
  const std::vector<Wardrobe> no_lower = {makeWardrobe({{"tshirt", Slot::kUpper}, {"hat", Slot::kHead}})};
  EXPECT_EQ(
      errorOf(kOne + "crowd: {count: 1}\n", no_lower),
      "a.yaml: crowd: the wardrobe 'w' has no item of the slot 'lower' and none of 'full'; add one, or name "
      "what people wear in crowd.outfits");
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 1, outfits: {hat: 1}}\n", no_lower), "no error");
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 0}\npeople: [{outfit: hat}]\n", no_lower), "no error");
  const std::vector<Wardrobe> dresses = {makeWardrobe({{"tshirt", Slot::kUpper}, {"dress", Slot::kFull}})};
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 1}\n", dresses), "no error");
  EXPECT_EQ(
      errorOf(kOne + "crowd: {count: 1, wear: {full: {dress: 1, none: 1}}}\n", dresses),
      "a.yaml: 3:32: the wardrobe 'w' has no item of the slot 'lower'; add one, or name what people wear in "
      "crowd.outfits");
  EXPECT_EQ(
      errorOf(kTwo + "crowd: {count: 1, wear: {full: {none: 1}, upper: {jumper: 1}}}\n", two()),
      "a.yaml: 3:50: crowd.wear.upper has nothing for the wardrobe 'men'; list an item of it with a weight "
      "above 0, or give the wardrobe the weight 0 in crowd.wardrobes");
  EXPECT_EQ(
      errorOf(
          kTwo + "crowd: {count: 1, wardrobes: {women: 1}, wear: {full: {none: 1}, upper: {jumper: 1}}}\n",
          two()),
      "no error");
}

}  // namespace
}  // namespace ensemble
