// Single items, combined: pictures of the techniques, and a colour for each item.
#include <cmath>
#include <set>

#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;

/// Makes single items of the tube wardrobe's outfits; what they hide overlaps.
void makeItems(Wardrobe& wardrobe) {
  wardrobe.items[ItemId(0)].slot = Slot::kUpper;  // tunic
  wardrobe.items[ItemId(1)].slot = Slot::kOver;   // net
  wardrobe.items[ItemId(2)].slot = Slot::kLower;  // patch, with faces that the template lacks
  Item cap =
      testing::tubeItem("cap", wardrobe.body, [](int region, int face) { return region != 2 || face < 40; });
  cap.slot = Slot::kHead;
  testing::addBand(cap, "garment.cap", testing::clothMaterial("cloth.cap"), 0.24f, 1.65f, 1.9f);
  wardrobe.items.push(std::move(cap));
  wardrobe.item_files.push("outfits/cap.glb");
}

class Combinations : public GpuTest, public ::testing::WithParamInterface<std::uint32_t> {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!IsSkipped()) makeItems(wardrobes_[0]);
  }
  Scene scene(Technique technique) const {
    Scene scene = testing::tubeScene(12);
    scene.technique = technique;
    scene.crowd.wear = {{Slot::kHead, {{"cap", 1.0f, {}}, {"none", 1.0f, {}}}, {}},
                        {Slot::kOver, {{"net", 1.0f, {}}, {"none", 1.0f, {}}}, {}}};
    return scene;
  }
  std::vector<Picture> drawAll(Renderer& renderer, const Scene& scene, bool with_aovs) const {
    std::vector<Picture> pictures;
    for (const double seconds : {0.0, 0.43}) {
      View view = viewOf(scene);
      view.samples = GetParam();
      if (with_aovs) view.aovs = testing::allAovs();
      pictures.push_back(draw(renderer, view, seconds));
    }
    return pictures;
  }
};

TEST_P(Combinations, TaggedIsPrefittedByteForByte) {
  const auto tagged_renderer = makeRenderer(scene(Technique::kTagged));
  const auto prefitted_renderer = makeRenderer(scene(Technique::kPrefitted));
  EXPECT_EQ(tagged_renderer->crowd().combinations.size(), 4u);
  const auto tagged = drawAll(*tagged_renderer, scene(Technique::kTagged), true);
  const auto prefitted = drawAll(*prefitted_renderer, scene(Technique::kPrefitted), true);
  for (std::size_t i = 0; i < tagged.size(); ++i) {
    EXPECT_GT(testing::countPeoplePixels(tagged[i]), tagged[i].character.size() / 10);
    EXPECT_EQ(tagged[i].color.rgba, prefitted[i].color.rgba) << i;
    EXPECT_EQ(tagged[i].character, prefitted[i].character) << i;
    EXPECT_EQ(tagged[i].region, prefitted[i].region) << i;
    EXPECT_EQ(tagged[i].face, prefitted[i].face) << i;
    EXPECT_EQ(tagged[i].depth, prefitted[i].depth) << i;
    EXPECT_EQ(tagged[i].normal, prefitted[i].normal) << i;
    EXPECT_EQ(tagged[i].stats.triangles(), prefitted[i].stats.triangles()) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Samples, Combinations, ::testing::Values(1u, 4u));

class NaiveCombinations : public Combinations {};
INSTANTIATE_TEST_SUITE_P(Samples, NaiveCombinations, ::testing::Values(1u));

TEST_P(NaiveCombinations, DifferOnlyWhereAHiddenFaceShows) {
  wardrobes_[0].items[ItemId(2)].extra_body.clear();  // Their faces have numbers of their own.
  const auto naive_renderer = makeRenderer(scene(Technique::kNaive));
  const auto tagged_renderer = makeRenderer(scene(Technique::kTagged));
  const auto naive = drawAll(*naive_renderer, scene(Technique::kNaive), true);
  const auto tagged = drawAll(*tagged_renderer, scene(Technique::kTagged), true);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < naive.size(); ++i) {
    for (const std::size_t pixel : testing::differingPixels(tagged[i].color, naive[i].color)) {
      EXPECT_TRUE(testing::showsHiddenFace(naive[i], pixel, *naive_renderer, wardrobes_))
          << i << " " << pixel;
      ++differing;
    }
    for (std::size_t pixel = 0; pixel < tagged[i].face.size(); ++pixel) {
      EXPECT_FALSE(testing::showsHiddenFace(tagged[i], pixel, *tagged_renderer, wardrobes_));
    }
  }
  EXPECT_GT(differing, 20u);
}

/// Tunic and patch under the net, and the patch under the tunic, which hide some of their faces.
class LayeredCombinations : public Combinations {
 protected:
  void SetUp() override {
    Combinations::SetUp();
    if (IsSkipped()) return;
    wardrobes_[0].items[ItemId(2)].extra_body.clear();  // Their faces have numbers of their own.
    hide(0, 1, [](std::size_t face) { return face % 3 == 0; });
    hide(2, 1, [](std::size_t face) { return face < 40; });
    hide(2, 0, [](std::size_t face) { return face >= 30 && face < 60; });
  }
  template <class Hides>
  void hide(std::size_t inner, std::size_t outer, const Hides& hides) {
    HiddenGarmentFaces hidden(wardrobes_[0].items[ItemId(inner)].garmentFaceCount());
    for (std::size_t face = 0; face < hidden.size(); ++face) hidden[face] = hides(face) ? 1 : 0;
    wardrobes_[0].hidden_under[{ItemId(inner), ItemId(outer)}] = hidden;
  }
};
INSTANTIATE_TEST_SUITE_P(Samples, LayeredCombinations, ::testing::Values(1u));

// With shadows: hidden garments cast none in naive either.
TEST_P(LayeredCombinations, TechniquesDifferOnlyWhereAHiddenFaceShows) {
  const auto naive_renderer = makeRenderer(scene(Technique::kNaive));
  const auto tagged_renderer = makeRenderer(scene(Technique::kTagged));
  const auto prefitted_renderer = makeRenderer(scene(Technique::kPrefitted));
  const auto naive = drawAll(*naive_renderer, scene(Technique::kNaive), true);
  const auto tagged = drawAll(*tagged_renderer, scene(Technique::kTagged), true);
  const auto prefitted = drawAll(*prefitted_renderer, scene(Technique::kPrefitted), true);
  std::size_t hidden_garments = 0;
  for (std::size_t i = 0; i < naive.size(); ++i) {
    EXPECT_EQ(tagged[i].color.rgba, prefitted[i].color.rgba) << i;
    EXPECT_EQ(tagged[i].face, prefitted[i].face) << i;
    EXPECT_EQ(tagged[i].depth, prefitted[i].depth) << i;
    EXPECT_EQ(tagged[i].stats.triangles(), prefitted[i].stats.triangles()) << i;
    EXPECT_LT(tagged[i].stats.triangles(), naive[i].stats.triangles()) << i;
    for (const std::size_t pixel : testing::differingPixels(tagged[i].color, naive[i].color)) {
      const bool is_garment = testing::showsHiddenGarment(naive[i], pixel, *naive_renderer, wardrobes_);
      EXPECT_TRUE(is_garment || testing::showsHiddenFace(naive[i], pixel, *naive_renderer, wardrobes_))
          << i << " " << pixel;
      hidden_garments += is_garment ? 1 : 0;
    }
    for (std::size_t pixel = 0; pixel < tagged[i].face.size(); ++pixel) {
      EXPECT_FALSE(testing::showsHiddenGarment(tagged[i], pixel, *tagged_renderer, wardrobes_));
    }
  }
  EXPECT_GT(hidden_garments, 50u);
}

class ItemColours : public GpuTest {
 protected:
  /// A shirt and trousers of one garment name and material, in two items of these slots, worn together.
  void dress(Slot upper, Slot lower) {
    Wardrobe& wardrobe = wardrobes_[0];
    wardrobe.items = {};
    for (const bool is_upper : {true, false}) {
      Item item = testing::tubeItem(is_upper ? "a" : "b", wardrobe.body, [](int, int) { return true; });
      item.slot = is_upper ? upper : lower;
      testing::addBand(item, "garment.plain", testing::clothMaterial("cloth.plain"), 0.3f,
                       is_upper ? 1.0f : 0.2f, is_upper ? 1.6f : 0.8f);
      wardrobe.items.push(std::move(item));
    }
  }
  Picture drawPerson(std::uint32_t tint, Technique technique) {
    Scene scene = testing::tubeScene(0);
    scene.technique = technique;
    scene.light.shadows = false;
    ScenePerson& person = scene.people.emplace_back();
    person.wears = {{"a", {}}, {"b", {}}};
    person.tint = tint;
    person.speed = 0.0f;
    scene.camera = {.position = Vec3(0.0f, 0.9f, 3.0f), .target = Vec3(0.0f, 0.9f, 0.0f)};
    return drawScene(scene, viewOf(scene));
  }
  /// The share of red, green and blue (sRGB) at a height of the person's front, in percent.
  static Vec3 shareAt(const Picture& picture, float height) {
    const float half = std::tan(SceneCamera().fov_y / 2.0f) * 2.7f;
    const auto y = static_cast<std::size_t>((0.5f - 0.5f * (height - 0.9f) / half) * 120.0f);
    const std::uint8_t* texel = &picture.color.rgba[4 * (y * 160 + 80)];
    const Vec3 color(texel[0], texel[1], texel[2]);
    return 100.0f * color / (color.x + color.y + color.z);
  }
};

TEST_F(ItemColours, ShirtAndTrousersOfOnePersonDiffer) {
  dress(Slot::kUpper, Slot::kLower);
  int different = 0;
  std::set<int> reds;
  for (std::uint32_t tint = 0; tint < 12; ++tint) {
    const Picture tagged = drawPerson(tint, Technique::kTagged);
    const Vec3 upper = shareAt(tagged, 1.3f), lower = shareAt(tagged, 0.5f);
    different += glm::distance(upper, lower) > 1.0f ? 1 : 0;
    reds.insert(static_cast<int>(upper.x));
    for (const Technique technique : {Technique::kPrefitted, Technique::kNaive}) {
      EXPECT_EQ(drawPerson(tint, technique).color.rgba, tagged.color.rgba) << tint << toString(technique);
    }
  }
  EXPECT_GE(different, 9) << "of 12 people";
  EXPECT_GE(reds.size(), 5u) << "people have shirts of one colour";
}

// One item: its trimming is a shade of the same tint, its white stripe stays white.
TEST_F(ItemColours, TrimmingsFollowTheirItem) {
  Wardrobe& wardrobe = wardrobes_[0];
  const auto colorOf = [&](Vec3 color, const char* name) {
    RawMaterial material = testing::clothMaterial(name);
    material.base_color = Vec4(color, 1.0f);
    return material;
  };
  dress(Slot::kUpper, Slot::kLower);
  Item& shirt = wardrobe.items[ItemId(0)];
  shirt.materials = {colorOf({0.04f, 0.06f, 0.12f}, "cloth.shirt"),
                     colorOf({0.02f, 0.03f, 0.06f}, "cloth.shirt.trim")};
  testing::addBand(shirt, "garment.shirt", shirt.materials[0], 0.31f, 1.4f, 1.8f);
  shirt.garments[0].parts[0].material = 1;
  shirt.garments.push_back(shirt.garments[1]);  // most of the faces are of its own colour
  wardrobe.items[ItemId(1)].materials = {colorOf({0.8f, 0.8f, 0.8f}, "cloth.stripe"),
                                         colorOf({0.04f, 0.06f, 0.12f}, "cloth.b")};
  Item& trousers = wardrobe.items[ItemId(1)];
  for (const float radius : {0.21f, 0.22f})
    testing::addBand(trousers, "garment.b", trousers.materials[1], radius, 0.0f, 0.1f);
  for (const std::size_t garment : {1, 2}) trousers.garments[garment].parts[0].material = 1;
  for (std::uint32_t tint = 0; tint < 6; ++tint) {
    const Picture picture = drawPerson(tint, Technique::kTagged);
    const Vec3 trim = shareAt(picture, 1.2f), main = shareAt(picture, 1.62f), stripe = shareAt(picture, 0.5f);
    EXPECT_LT(glm::distance(trim, main), 5.0f) << tint;
    EXPECT_LT(glm::distance(stripe, Vec3(100.0f / 3)), 4.0f) << tint;
  }
}

// A belt in between does not make a shirt and trousers of a dress; a fixed one keeps its colour.
TEST_F(ItemColours, ABeltDoesNotPartADress) {
  dress(Slot::kFull, Slot::kFeet);
  Item& item = wardrobes_[0].items[ItemId(0)];
  testing::addBand(item, "garment.dress", testing::clothMaterial("cloth.dress"), 0.32f, 0.2f, 0.8f);
  RawMaterial belt = testing::clothMaterial("fixed.dress.belt");
  belt.base_color = Vec4(0.4f, 0.4f, 0.4f, 1.0f);
  testing::addBand(item, "", belt, 0.32f, 0.8f, 1.0f);
  testing::addBand(item, "", item.materials[1], 0.32f, 1.0f, 1.6f);
  std::vector<Garment> made(item.garments.end() - 3, item.garments.end());
  RawPrimitive cloth = made[0].parts[0];
  for (Triangle face : made[2].parts[0].faces) {
    for (std::uint32_t& corner : face) corner += static_cast<std::uint32_t>(cloth.vertices.size());
    cloth.faces.push_back(face);
  }
  const std::vector<RawVertex>& above = made[2].parts[0].vertices;
  cloth.vertices.insert(cloth.vertices.end(), above.begin(), above.end());
  item.garments = {{"garment.dress", {cloth, made[1].parts[0]}}};
  std::set<int> reds;
  for (std::uint32_t tint = 0; tint < 8; ++tint) {
    const Picture picture = drawPerson(tint, Technique::kTagged);
    const Vec3 bodice = shareAt(picture, 1.3f), skirt = shareAt(picture, 0.5f),
               at_belt = shareAt(picture, 0.9f);
    EXPECT_LT(glm::distance(bodice, skirt), 3.0f) << tint;
    EXPECT_LT(glm::distance(at_belt, Vec3(100.0f / 3)), 4.0f) << tint;
    reds.insert(static_cast<int>(bodice.x));
  }
  EXPECT_GE(reds.size(), 4u);
}

}  // namespace
}  // namespace ensemble
