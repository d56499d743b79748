#include "renderer/crowd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/input_error.h"

namespace ensemble {
namespace {

Wardrobe makeWardrobe(const std::vector<std::string>& outfits, const std::vector<std::string>& clips) {
  Wardrobe wardrobe;
  for (const std::string& name : outfits) {
    Item item;
    item.name = name;
    wardrobe.items.push(std::move(item));
  }
  for (const std::string& name : clips) {
    Clip clip;
    clip.name = name;
    wardrobe.body.clips.push_back(std::move(clip));
  }
  return wardrobe;
}

Scene parse(const std::string& text) { return parseScene("version: 1\n" + text, "a.yaml"); }

const std::string kOne = "wardrobe: w\n";
const std::string kTwo = "wardrobe: {women: w, men: m}\n";

std::vector<Wardrobe> one() { return {makeWardrobe({"casual01", "casual02", "sport01"}, {"walk", "idle"})}; }
std::vector<Wardrobe> two() {
  return {makeWardrobe({"casual01", "dress01"}, {"walk", "idle", "dance"}),
          makeWardrobe({"casual01", "sport01"}, {"idle", "walk"})};
}

std::string errorOf(const std::string& text, const std::vector<Wardrobe>& wardrobes) {
  try {
    populateCrowd(parse(text), wardrobes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Within five standard deviations of a binomial distribution.
void expectBinomial(int observed, int trials, double probability) {
  const double deviation = std::sqrt(trials * probability * (1.0 - probability));
  EXPECT_NEAR(observed, trials * probability, 5.0 * deviation);
}

bool sameCharacter(const Character& a, const Character& b) {
  return a.wardrobe == b.wardrobe && a.combination == b.combination && a.clip == b.clip &&
         a.phase == b.phase && a.speed == b.speed && a.position == b.position && a.heading == b.heading &&
         a.scale == b.scale && a.tint_seed == b.tint_seed;
}

TEST(Crowd, HasThePeopleThenTheCrowd) {
  const Scene scene = parse(kTwo + R"(
people:
  - {wardrobe: men, outfit: sport01, clip: walk, phase: 0.25, speed: 0, position: [1, 2, 3], heading: 90, scale: 2, tint: 5}
  - {wardrobe: women}
  - {wardrobe: women, outfit: women/casual01}
crowd: {count: 10}
)");
  const Crowd crowd = populateCrowd(scene, two());
  ASSERT_EQ(crowd.characters.size(), 13u);
  const Character& first = crowd.characters[0];
  EXPECT_EQ(first.wardrobe, 1u);
  EXPECT_EQ(crowd.combinations[first.combination], (WornCombination{1, {ItemId(1)}}));
  EXPECT_EQ(first.clip, 1u);
  EXPECT_EQ(first.phase, 0.25f);
  EXPECT_EQ(first.speed, 0.0f);
  EXPECT_EQ(first.position, Vec3(1, 2, 3));
  EXPECT_EQ(first.heading, radians(90.0f));
  EXPECT_EQ(first.scale, 2.0f);
  EXPECT_EQ(first.tint_seed, 5u);
  EXPECT_EQ(crowd.combinations[crowd.characters[1].combination], (WornCombination{0, {}}));
  EXPECT_EQ(crowd.characters[1].clip, 0u);
  EXPECT_EQ(crowd.combinations[crowd.characters[2].combination], (WornCombination{0, {ItemId(0)}}));
  EXPECT_NE(crowd.characters[1].tint_seed, crowd.characters[2].tint_seed);
}

TEST(Crowd, PlacesAPersonByScaleHeadingAndPosition) {
  Character character;
  character.position = {1, 2, 3};
  character.heading = radians(90.0f);  // its own +Z looks along the world's +X
  character.scale = 2.0f;
  const Vec4 ahead = character.worldFromModel() * Vec4(0, 1, 1, 1);
  EXPECT_NEAR(ahead.x, 3.0f, 1e-6f);
  EXPECT_NEAR(ahead.y, 4.0f, 1e-6f);
  EXPECT_NEAR(ahead.z, 3.0f, 1e-6f);
  EXPECT_NEAR(glm::determinant(Mat3(character.worldFromModel())), 8.0f, 1e-5f);
}

TEST(Crowd, CombinationsAreDistinctSortedAndWorn) {
  const Crowd crowd = populateCrowd(
      parse(kTwo + "crowd: {count: 500, seed: 3}\npeople: [{wardrobe: men, outfit: sport01}]\n"), two());
  EXPECT_THAT(crowd.combinations,
              testing::ElementsAre(WornCombination{0, {ItemId(0)}}, WornCombination{0, {ItemId(1)}},
                                   WornCombination{1, {ItemId(0)}}, WornCombination{1, {ItemId(1)}}));
  for (const Character& character : crowd.characters) {
    EXPECT_EQ(crowd.combinations[character.combination].wardrobe, character.wardrobe);
  }
  const Crowd single = populateCrowd(parse(kOne + "crowd: {count: 1}\n"), one());
  EXPECT_EQ(single.combinations.size(), 1u);  // what nobody wears is not there
  EXPECT_TRUE(populateCrowd(parse(kOne), one()).characters.empty());
}

TEST(Crowd, FollowsTheWeights) {
  constexpr int kCount = 20'000;
  const Crowd crowd = populateCrowd(parse(kTwo + R"(
crowd:
  count: 20000
  seed: 11
  wardrobes: {women: 3, men: 1}
  outfits: {women/casual01: 1, dress01: 4, men/casual01: 2, sport01: 0}
  clips: {walk: 0.9, idle: 0.1}
  scale: [0.9, 1.1]
)"),
                                    two());
  std::map<std::string, int> outfits, clips;
  int women = 0;
  double phase = 0.0;
  float least = 10, most = 0;
  for (const Character& character : crowd.characters) {
    women += character.wardrobe == 0 ? 1 : 0;
    const Wardrobe wardrobe = two()[character.wardrobe];
    const Combination& items = crowd.combinations[character.combination].items;
    ASSERT_EQ(items.size(), 1u);
    ++outfits[std::to_string(character.wardrobe) + wardrobe.items[items[0]].name];
    ++clips[wardrobe.body.clips[character.clip].name];
    phase += character.phase / kCount;
    least = std::min(least, character.scale);
    most = std::max(most, character.scale);
    EXPECT_EQ(character.speed, 1.0f);
  }
  expectBinomial(women, kCount, 0.75);
  expectBinomial(outfits["0casual01"], women, 0.2);
  expectBinomial(outfits["0dress01"], women, 0.8);
  EXPECT_EQ(outfits["1casual01"], kCount - women);
  EXPECT_EQ(outfits.count("1sport01"), 0u);  // weight 0 is never chosen
  expectBinomial(clips["walk"], kCount, 0.9);
  EXPECT_EQ(clips["walk"] + clips["idle"], kCount);
  EXPECT_NEAR(phase, 0.5, 0.01);
  EXPECT_GE(least, 0.9f);
  EXPECT_LE(most, 1.1f);
  EXPECT_LT(least, 0.901f);
  EXPECT_GT(most, 1.099f);
}

TEST(Crowd, WithoutWeightsAllAreAlike) {
  constexpr int kCount = 6000;
  const Crowd crowd = populateCrowd(parse(kOne + "crowd: {count: 6000}\n"), one());
  std::map<std::uint32_t, int> worn;
  for (const Character& character : crowd.characters) {
    ++worn[character.combination];
    EXPECT_EQ(character.clip, 0u);
  }
  EXPECT_EQ(worn.size(), 3u);
  for (const auto& [combination, wearers] : worn) expectBinomial(wearers, kCount, 1.0 / 3.0);
}

TEST(Crowd, WearsCompleteOutfitsAndNothingWhereThereIsNone) {
  std::vector<Wardrobe> wardrobes = one();
  wardrobes[0].items[ItemId(1)].slot = Slot::kUpper;
  wardrobes[0].items[ItemId(2)].slot = Slot::kLower;
  const Scene scene = parse(kOne + "crowd: {count: 100}\n");
  EXPECT_THAT(
      populateCrowd(scene, wardrobes).combinations,
      testing::ElementsAre(WornCombination{0, {ItemId(0)}}, WornCombination{0, {ItemId(1), ItemId(2)}}));
  const std::vector<Wardrobe> bare{makeWardrobe({}, {})};
  EXPECT_THAT(populateCrowd(scene, bare).combinations, testing::ElementsAre(WornCombination{0, {}}));
  EXPECT_EQ(populateCrowd(scene, bare).characters[0].clip, 0u);
}

TEST(Crowd, IsAFunctionOfSceneAndSeed) {
  const std::string crowd_text = "crowd: {count: 300, placement: {kind: disc}, scale: [0.9, 1.1], seed: ";
  const Crowd first = populateCrowd(parse(kTwo + crowd_text + "1}\n"), two());
  const Crowd again = populateCrowd(parse(kTwo + crowd_text + "1}\n"), two());
  const Crowd other = populateCrowd(parse(kTwo + crowd_text + "2}\n"), two());
  ASSERT_EQ(first.characters.size(), 300u);
  EXPECT_EQ(first.combinations, again.combinations);
  int alike = 0;
  std::set<std::uint32_t> tints;
  for (std::size_t i = 0; i < 300; ++i) {
    EXPECT_TRUE(sameCharacter(first.characters[i], again.characters[i])) << i;
    alike += first.characters[i].phase == other.characters[i].phase ? 1 : 0;
    tints.insert(first.characters[i].tint_seed);
  }
  EXPECT_LT(alike, 3);
  EXPECT_EQ(tints.size(), 300u);
}

TEST(Crowd, NamedPeopleAndWeightsMoveNobody) {
  const Crowd plain = populateCrowd(parse(kTwo + "crowd: {count: 50, placement: {kind: disc}}\n"), two());
  const Crowd changed =
      populateCrowd(parse(kTwo + "crowd: {count: 50, placement: {kind: disc}, outfits: {dress01: 1, "
                                 "sport01: 1}, clips: {walk: 1}, scale: 1.1}\npeople: [{wardrobe: men}]\n"),
                    two());
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(plain.characters[i].position, changed.characters[i + 1].position);
    EXPECT_EQ(plain.characters[i].phase, changed.characters[i + 1].phase);
    EXPECT_EQ(plain.characters[i].wardrobe, changed.characters[i + 1].wardrobe);
    EXPECT_EQ(plain.characters[i].tint_seed, changed.characters[i + 1].tint_seed);
  }
}

TEST(CrowdErrors, NamesThatDoNotExist) {
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 1, outfits: {casual03: 1}}\n", one()),
            "a.yaml: 3:39: the wardrobe 'w' has no outfit 'casual03'; write 'casual01' or 'casual02'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {dress1: 1}}\n", two()),
            "a.yaml: 3:37: no wardrobe has an outfit 'dress1'; write 'dress01'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {casul01: 1}}\n", two()),
            "a.yaml: 3:38: no wardrobe has an outfit 'casul01'; write 'women/casual01' or 'men/casual01'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {men/dress01: 1}}\n", two()),
            "a.yaml: 3:42: the wardrobe 'men' has no outfit 'dress01'; write 'casual01' or 'sport01'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, wardrobes: {womn: 1}}\n", two()),
            "a.yaml: 3:37: there is no wardrobe 'womn'; write 'women'");
  EXPECT_EQ(
      errorOf(kOne + "crowd: {count: 1, wardrobes: {w: 1}}\n", one()),
      "a.yaml: 3:34: there is no wardrobe 'w': the scene's only one has no key; remove the name, or give "
      "'wardrobe: {KEY: FOLDER}'");
  EXPECT_EQ(errorOf(kOne + "people: [{outfit: sprot01}]\n", one()),
            "a.yaml: 3:19: the wardrobe 'w' has no outfit 'sprot01'; write 'sport01'");
  EXPECT_EQ(errorOf(kTwo + "people: [{wardrobe: men, outfit: women/dress01}]\n", two()),
            "a.yaml: 3:34: the wardrobe 'men' has no outfit 'women/dress01'; write 'casual01' or 'sport01'");
  EXPECT_EQ(errorOf(kOne + "people: [{clip: wlak}]\n", one()),
            "a.yaml: 3:17: the wardrobe 'w' has no clip 'wlak'; write 'walk'");
  EXPECT_EQ(
      errorOf(kOne + "people: [{wardrobe: w}]\n", one()),
      "a.yaml: 3:21: there is no wardrobe 'w': the scene's only one has no key; remove the name, or give "
      "'wardrobe: {KEY: FOLDER}'");
  EXPECT_EQ(errorOf(kTwo + "people: [{outfit: dress01}]\n", two()),
            "a.yaml: 3:10: people.0 names none of 2 wardrobes; add 'wardrobe:' with 'women' or 'men'");
  EXPECT_EQ(errorOf(kOne + "people: [{outfit: a}]\n", {makeWardrobe({}, {})}),
            "a.yaml: 3:19: the wardrobe 'w' has no outfit 'a'; add outfits to it");
  EXPECT_EQ(errorOf(kOne + "people: [{clip: a}]\n", {makeWardrobe({}, {})}),
            "a.yaml: 3:17: the wardrobe 'w' has no clip 'a'; tag it again with 'ensemble tag --clips'");
}

TEST(CrowdErrors, NamesThatMeanTooMuchOrTooLittle) {
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {casual01: 1}}\n", two()),
            "a.yaml: 3:39: 2 wardrobes have an outfit 'casual01'; write 'women/casual01' or 'men/casual01'");
  EXPECT_EQ(
      errorOf(kTwo + "crowd: {count: 1, outfits: {dress01: 1}}\n", two()),
      "a.yaml: 3:38: crowd.outfits has nothing to wear for the wardrobe 'men'; list an outfit of it with a "
      "weight above 0, or give the wardrobe the weight 0 in crowd.wardrobes");
  EXPECT_EQ(
      errorOf(kTwo + "crowd: {count: 1, outfits: {dress01: 1, sport01: 0}}\n", two()),
      "a.yaml: 3:38: crowd.outfits has nothing to wear for the wardrobe 'men'; list an outfit of it with a "
      "weight above 0, or give the wardrobe the weight 0 in crowd.wardrobes");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, outfits: {dress01: 1}, wardrobes: {women: 1}}\n", two()),
            "no error");
  EXPECT_EQ(
      errorOf(kTwo + "crowd: {count: 1, outfits: {dress01: 1, women/dress01: 1}, wardrobes: {women: 1}}\n",
              two()),
      "a.yaml: 3:56: the outfit 'women/dress01' is here a second time; remove one of them");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, clips: {walk: 1, dance: 1}}\n", two()),
            "a.yaml: 3:43: the wardrobe 'men' has no clip 'dance'; write 'idle' or 'walk'");
  EXPECT_EQ(errorOf(kTwo + "crowd: {count: 1, clips: {dance: 1}, wardrobes: {women: 1, men: 0}}\n", two()),
            "no error");
}

TEST(CrowdErrors, AreToldByKeyPathWhereTheNameCameFromSet) {
  const std::vector<SceneOverride> overrides{{"crowd.outfits.dres01", "1"}};
  const Scene scene = parseScene("version: 1\nwardrobe: w\ncrowd: {count: 1}\n", "a.yaml", overrides);
  try {
    populateCrowd(scene, one());
    FAIL() << "did not throw";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a.yaml: crowd.outfits.dres01: the wardrobe 'w' has no outfit 'dres01'; write 'casual01', "
                 "'casual02' or 'sport01'");
  }
}

TEST(CrowdErrors, ASpacingThatCantBeKept) {
  EXPECT_EQ(errorOf(kOne + "crowd: {count: 9, placement: {kind: disc, spacing: 0.01, center: [1e6, 0, 0]}}\n",
                    one()),
            "a.yaml: crowd.placement: positions are too coarse for a spacing of 0.01 this far from the "
            "origin; move "
            "crowd.placement.center nearer to [0, 0, 0], or raise the spacing");
}

}  // namespace
}  // namespace ensemble
