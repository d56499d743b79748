#include "assetpipe/tag_regions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "assetpipe/segment.h"
#include "core/atomic_file.h"
#include "core/image_file.h"
#include "tests/support/expect_error.h"
#include "tests/support/small_people.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TemplateBody tubeBody() {
  std::vector<std::string> warnings;
  return segmentTemplate(testing::tubeTemplate(), {}, "tube.glb", warnings);
}

/// Legs all visible, half of the torso's faces, none of the head's.
RawAsset halfDressed() {
  return testing::tubeOutfit(
      [](int region, int face) { return region == 0 || (region == 1 && face % 2 == 0); });
}

Item tag(const RawAsset& outfit, std::vector<std::string>* warnings = nullptr,
         const TagOptions& options = {}) {
  std::vector<std::string> ignored;
  return tagOutfit(outfit, tubeBody(), options, "tunic", "tunic.glb",
                   warnings != nullptr ? *warnings : ignored);
}

void expectHalfDressed(const Item& item) {
  ASSERT_EQ(item.tags.size(), 3u);
  EXPECT_EQ(item.tags[RegionId(0)].visibility, Visibility::kFull);
  EXPECT_EQ(item.tags[RegionId(1)].visibility, Visibility::kPartial);
  EXPECT_EQ(item.tags[RegionId(1)].visible_faces, 32u);
  EXPECT_EQ(item.tags[RegionId(2)].visibility, Visibility::kHidden);
  for (std::uint32_t f = 0; f < 192; ++f) {
    EXPECT_EQ(item.visible[FaceId(f)] != 0, f < 64 || (f < 128 && f % 2 == 0)) << f;
  }
}

TEST(TagRegions, ClassifiesByTheMatchedSet) {
  const Item item = tag(halfDressed());
  expectHalfDressed(item);
  EXPECT_EQ(item.visibleBodyFaceCount(), 96u);
  EXPECT_EQ(item.dedicatedFaceCount(), 32u);
  ASSERT_EQ(item.garments.size(), 1u);
  EXPECT_EQ(item.garments[0].name, "garment.tunic");
  EXPECT_EQ(item.garmentFaceCount(), 80u);
  EXPECT_EQ(item.slot, Slot::kFull);
  EXPECT_EQ(item.layer, 0);
}

TEST(TagRegions, SurvivesCopiedMaterialNamesAndSplitPrimitives) {
  RawAsset outfit = halfDressed();
  for (RawMaterial& material : outfit.materials) material.name += ".003";
  auto& primitives = outfit.meshes[0].primitives;
  RawPrimitive half = primitives[0];
  half.faces.erase(half.faces.begin(), half.faces.begin() + 20);
  primitives[0].faces.resize(20);
  primitives.push_back(half);
  expectHalfDressed(tag(outfit));
}

TEST(TagRegions, MapsJointsByName) {
  RawAsset outfit = halfDressed();
  const Item plain = tag(outfit);
  std::swap(outfit.skeleton.joints[0], outfit.skeleton.joints[1]);
  RawJoint extra = outfit.skeleton.joints[0];  // a joint that nothing uses may be unknown
  outfit.skeleton.bones.push_back({"prop", 0, {}});
  extra.bone = 2;
  outfit.skeleton.joints.push_back(extra);
  for (RawMeshNode& node : outfit.meshes) {
    for (RawPrimitive& primitive : node.primitives) {
      for (RawVertex& vertex : primitive.vertices) {
        for (std::size_t i = 0; i < 4; ++i) {
          if (vertex.skin.weights[i] > 0.0f) vertex.skin.joints[i] = vertex.skin.joints[i] == 0 ? 1 : 0;
        }
      }
    }
  }
  const Item mapped = tag(outfit);
  EXPECT_EQ(mapped.garments[0].parts[0].vertices, plain.garments[0].parts[0].vertices);
}

TEST(TagRegions, RefusesAnotherSkeleton) {
  RawAsset missing = halfDressed();
  missing.skeleton.bones[1].name = "chest";
  EXPECT_INPUT_ERROR(
      tag(missing),
      "tunic.glb: /skins: the outfit is bound to joints that the template's skeleton lacks: 'chest'; bind "
      "it to the template's skeleton, or move these weights to the template's joints");
  RawAsset moved = halfDressed();
  moved.skeleton.joints[1].joint_from_model[3].y += 0.01f;
  EXPECT_INPUT_ERROR(
      tag(moved),
      "tunic.glb: /skins: joint 'spine' stands 10.0 mm from the template's in the bind pose; bind the "
      "outfit to the template's own skeleton, in the template's pose");
}

TEST(TagRegions, RefusesAnotherBodyAndTellsHowFar) {
  RawAsset outfit = halfDressed();
  for (RawPrimitive& primitive : outfit.meshes[0].primitives) {
    for (RawVertex& vertex : primitive.vertices) vertex.position.y += 0.004f;
  }
  EXPECT_INPUT_ERROR(
      tag(outfit),
      "tunic.glb: /meshes: 96 of the 96 body faces match no face of the template; corners are 4.00 mm "
      "(median) to 4.00 mm (maximum) from it; tag it with the template that it was made for");
}

TEST(TagRegions, KeepsUpToTwoPercentOfUnmatchedFaces) {
  RawAsset outfit = halfDressed();
  RawPrimitive& legs = outfit.meshes[0].primitives[0];
  RawVertex moved = legs.vertices[legs.faces[0][0]];
  moved.position.x += 0.003f;
  legs.vertices.push_back(moved);
  legs.faces[0][0] = static_cast<std::uint32_t>(legs.vertices.size() - 1);  // 1 of 96 faces
  std::vector<std::string> warnings;
  const Item item = tag(outfit, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0],
              HasSubstr("1 of the 96 body faces match no face of the template (corners up to 3.00 mm off)"));
  EXPECT_EQ(item.tags[RegionId(0)].visibility, Visibility::kPartial);
  EXPECT_EQ(item.tags[RegionId(0)].visible_faces, 64u);
  ASSERT_EQ(item.extra_body.size(), 1u);
  EXPECT_EQ(item.extra_body[0].region, RegionId(0));
  EXPECT_EQ(item.extra_body[0].part.faces.size(), 1u);

  legs.faces[1][0] = legs.faces[0][0];  // 2 of 96 are more than 2 %
  EXPECT_THROW(tag(outfit), InputError);
}

TEST(TagRegions, RefusesAnOutfitWithoutBody) {
  EXPECT_INPUT_ERROR(
      tag(testing::tubeOutfit([](int, int) { return false; })),
      "tunic.glb: /materials: there is no body in this outfit: no material is named as one of the "
      "template's ('legs', 'torso', 'head'); export the outfit with the body that it dresses, its "
      "materials named as the template's, or use --body NODE");
}

TEST(TagRegions, RefusesAnUnskinnedGarment) {
  RawAsset outfit = halfDressed();
  outfit.meshes[1].skinned = false;
  outfit.meshes[1].json_pointer = "/nodes/4";
  EXPECT_INPUT_ERROR(
      tag(outfit),
      "tunic.glb: /nodes/4: garment 'garment.tunic' is not skinned; bind it to the skeleton, parent it to "
      "a joint, or leave it out of the export");
}

TEST(TagRegions, TakesTheBodyFromANodeWhereAsked) {
  RawAsset outfit = halfDressed();
  for (RawMaterial& material : outfit.materials) material.name = "atlas";
  TagOptions options;
  options.body_node = "body";
  expectHalfDressed(tag(outfit, nullptr, options));
  options.body_node = "Body";
  EXPECT_INPUT_ERROR(tag(outfit, nullptr, options),
                     "tunic.glb: /nodes: no mesh node is named 'Body'; name one with --body (`ensemble "
                     "inspect` lists them)");
}

TEST(TagRegions, ReadsSlotAndLayerFromTheScene) {
  RawAsset outfit = halfDressed();
  outfit.scene_extras_json = R"({"ensemble": {"slot": "upper", "layer": 2}})";
  const Item item = tag(outfit);
  EXPECT_EQ(item.slot, Slot::kUpper);
  EXPECT_EQ(item.layer, 2);
  outfit.scene_extras_json = R"({"ensemble": {"slot": "top"}})";
  EXPECT_INPUT_ERROR(tag(outfit),
                     "tunic.glb: /scenes: the custom property 'slot' is 'top'; set hair, head, upper, lower, "
                     "full, feet or over");
  outfit.scene_extras_json = R"({"ensemble": {"slot": 3}})";
  EXPECT_INPUT_ERROR(
      tag(outfit),
      "tunic.glb: /scenes: the custom property 'slot' is no text; set hair, head, upper, lower, "
      "full, feet or over");
  outfit.scene_extras_json = R"({"ensemble": {"layer": "outer"}})";
  EXPECT_INPUT_ERROR(
      tag(outfit),
      "tunic.glb: /scenes: the custom property 'layer' is no whole number from -1000 to 1000; set a number");
}

TEST(TagRegions, AnItemMayKeepAndHideRegions) {
  RawAsset outfit = halfDressed();
  const auto visibility = [&](const char* own) {
    outfit.scene_extras_json = std::string("{\"ensemble\": ") + own + "}";
    const Item item = tag(outfit);
    std::vector<Visibility> all;
    for (const RegionTag& region : item.tags) all.push_back(region.visibility);
    return all;
  };
  using enum Visibility;
  const std::vector<Visibility> plain = visibility("{}");
  EXPECT_EQ(visibility(R"({"keep": "legs, torso,head"})"), (std::vector<Visibility>{kFull, kFull, kFull}));
  EXPECT_EQ(visibility(R"({"hide": ["legs", "torso"], "keep": ["head"]})"),
            (std::vector<Visibility>{kHidden, kHidden, kFull}));
  EXPECT_EQ(visibility(R"({"keep": [], "hide": ""})"), plain);
  EXPECT_INPUT_ERROR(visibility(R"({"keep": "legs,tail"})"),
                     "tunic.glb: /scenes: the custom property 'keep' names 'tail', which is no region of the "
                     "template; write 'legs'");
  EXPECT_INPUT_ERROR(
      visibility(R"({"hide": 3})"),
      "tunic.glb: /scenes: the custom property 'hide' is no list of regions; set names, such as "
      "hands,feet");
  EXPECT_INPUT_ERROR(
      visibility(R"({"hide": "legs", "keep": "legs"})"),
      "tunic.glb: /scenes: the custom properties 'keep' and 'hide' both name the region 'legs'; "
      "take it out of one of them");
}

/// Paints the two lowest rings of vertices of a region of the body, and so its first 16 faces.
void paintLowestRing(RawAsset& outfit, std::size_t region, float value) {
  RawPrimitive& primitive = outfit.meshes[0].primitives[region];
  primitive.hide.assign(primitive.vertices.size(), 0.0f);
  std::fill_n(primitive.hide.begin(), 2 * testing::kTubeSegments, value);
}

TEST(TagRegions, PaintedFacesShowOrDontWhateverElseIsFound) {
  RawAsset outfit = testing::tubeOutfit([](int, int) { return true; }, 0.203f);
  TagOptions rays;
  rays.occlusion = Occlusion::kAuto;
  const std::uint32_t torso_found = tag(outfit, nullptr, rays).tags[RegionId(1)].visible_faces;
  outfit.scene_extras_json = R"({"ensemble": {"keep": "legs", "hide": "torso"}})";
  paintLowestRing(outfit, 0, 0.75f);
  paintLowestRing(outfit, 1, -0.75f);
  paintLowestRing(outfit, 2, 0.5f);  // not more than a half: nothing said
  std::vector<std::string> warnings;
  for (const TagOptions& options : {TagOptions(), rays}) {
    const Item item = tag(outfit, &warnings, options);
    EXPECT_EQ(item.tags[RegionId(0)].visible_faces, 48u);
    EXPECT_EQ(item.tags[RegionId(1)].visible_faces, 16u);
    for (std::uint32_t f = 0; f < 128; ++f) {
      EXPECT_EQ(item.visible[FaceId(f)] != 0, (f >= 16 && f < 64) || (f >= 64 && f < 80)) << f;
    }
    EXPECT_EQ(item.tags[RegionId(2)].visibility, Visibility::kFull);
  }
  EXPECT_LT(torso_found, 16u) << "the rays alone would have hidden painted faces";
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(TagRegions, ExplainTellsOfPaint) {
  RawAsset outfit = testing::tubeOutfit([](int, int) { return true; }, 0.203f);
  paintLowestRing(outfit, 0, 1.0f);
  paintLowestRing(outfit, 1, -1.0f);
  const testing::TemporaryFolder folder;
  TagOptions rays;
  rays.occlusion = Occlusion::kAuto;
  rays.explain = folder.path();
  tag(outfit, nullptr, rays);
  const std::vector<std::byte> text = readFile(folder / "tunic.json");
  const auto why = nlohmann::json::parse(reinterpret_cast<const char*>(text.data()),
                                         reinterpret_cast<const char*>(text.data() + text.size()));
  std::map<std::string, std::vector<int>> painted;  // paint -> faces
  for (const auto& region : why["regions"]) {
    for (const auto& face : region["faces"]) {
      if (face["verdict"] == "painted") painted[face["paint"]].push_back(face["face"]);
    }
  }
  std::vector<int> first_16(16);
  std::iota(first_16.begin(), first_16.end(), 0);
  EXPECT_EQ(painted, (std::map<std::string, std::vector<int>>{{"hide", first_16}, {"keep", first_16}}));
  const Image8 picture = decodeImage({"", "image/png", readFile(folder / "tunic.png"), 0, 0}, "tunic.png");
  std::size_t green = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    green +=
        picture.rgba[i + 1] > picture.rgba[i] + 20 && picture.rgba[i + 1] > picture.rgba[i + 2] + 20 ? 1 : 0;
  }
  EXPECT_GT(green, 10'000u) << "two bands of 15 cm, of 1.8 m, from four sides";
}

TEST(TagRegions, PaintOnAGarmentIsTold) {
  RawAsset outfit = halfDressed();
  RawPrimitive& tunic = outfit.meshes.back().primitives[0];
  tunic.hide.assign(tunic.vertices.size(), 1.0f);
  std::vector<std::string> warnings;
  const Item item = tag(outfit, &warnings);
  expectHalfDressed(item);
  EXPECT_THAT(item.garments[0].parts[0].hide, IsEmpty());
  EXPECT_THAT(warnings,
              ::testing::ElementsAre("garment 'garment.tunic' has the attribute _HIDE, which says nothing "
                                     "there; paint the body"));
}

// A tunic far inside the body covers nothing; what its author removed comes back where rays are asked.
TEST(TagRegions, AnItemMayAskForAKindOfOcclusion) {
  RawAsset outfit = halfDressed();
  TagOptions rays;
  rays.occlusion = Occlusion::kAuto;
  const auto shown = [&](const char* kind, const TagOptions& options) {
    outfit.scene_extras_json = std::string("{\"ensemble\": {\"occlusion\": ") + kind + "}}";
    return tag(outfit, nullptr, options).visibleBodyFaceCount();
  };
  const std::uint32_t authored = shown("null", {}), found = shown("null", rays);
  EXPECT_NE(authored, found);
  EXPECT_EQ(shown("\"authored\"", rays), authored);
  EXPECT_EQ(shown("\"auto\"", {}), found);
  EXPECT_LE(shown("\"both\"", {}), std::min(authored, found));
  EXPECT_INPUT_ERROR(shown("\"rays\"", {}),
                     "tunic.glb: /scenes: the custom property 'occlusion' is no kind of occlusion; set "
                     "authored, auto or both");
}

/// With a face inside the legs, which no one sees with or without clothes.
RawAsset withInnerFace(RawAsset asset) {
  for (RawMeshNode& node : asset.meshes) {
    for (RawPrimitive& primitive : node.primitives) {
      if (asset.materials[primitive.material].name != "legs") continue;
      const auto first = static_cast<std::uint32_t>(primitive.vertices.size());
      for (const float x : {-0.01f, 0.0f, 0.01f}) {
        RawVertex vertex = primitive.vertices[0];
        vertex.position = Vec3(x, x == 0.0f ? 0.32f : 0.3f, 0.0f);
        primitive.vertices.push_back(vertex);
      }
      primitive.faces.push_back({first, first + 1, first + 2});
    }
  }
  return asset;
}

TEST(TagRegions, WhatTheBodyItselfHidesLeavesItsRegionWhole) {
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(withInnerFace(testing::tubeTemplate()), {}, "tube.glb", warnings);
  TagOptions rays;
  rays.occlusion = Occlusion::kAuto;
  const RawAsset outfit = withInnerFace(testing::tubeOutfit([](int, int) { return true; }, 0.203f));
  const Item item = tagOutfit(outfit, body, rays, "tunic", "tunic.glb", warnings);
  EXPECT_EQ(item.tags[RegionId(0)].visibility, Visibility::kFull);
  EXPECT_EQ(item.tags[RegionId(0)].visible_faces, 65u);
  EXPECT_NE(item.tags[RegionId(1)].visibility, Visibility::kFull);
  BareBody bare(body, {});
  const FaceHoles& holes = bare.holes();
  EXPECT_EQ(&holes, &bare.holes());
  EXPECT_EQ(
      std::count_if(holes.faces.begin(), holes.faces.end(), [](const FaceHole& f) { return !f.is_kept; }), 1);
  rays.bare = &bare;
  EXPECT_EQ(tagOutfit(outfit, body, rays, "tunic", "tunic.glb", warnings).visible, item.visible);
}

TEST(TagRegions, ExplainNamesWhatABareRegionKeeps) {
  const testing::TemporaryFolder folder;
  std::vector<std::string> warnings;
  const RawAsset asset = withInnerFace(testing::tubeTemplate());
  const TemplateBody body = segmentTemplate(asset, {}, "template.glb", warnings);
  TagOptions rays;
  rays.occlusion = Occlusion::kAuto;
  rays.explain = folder / "why";
  tagOutfit(withInnerFace(testing::tubeOutfit([](int, int) { return true; }, 0.203f)), body, rays, "tunic",
            "tunic.glb", warnings);
  std::ifstream file(folder / "why" / "tunic.json");
  const auto why = nlohmann::json::parse(file);
  EXPECT_EQ(why["regions"][0]["kept"], 65);
  int bare = 0;
  for (const auto& face : why["regions"][0]["faces"]) bare += face["verdict"] == "bare region" ? 1 : 0;
  EXPECT_EQ(bare, 1);
}

TEST(TagRegions, ExplainSaysWhereItHasNothingToTell) {
  std::vector<std::string> warnings;
  TagOptions authored;
  authored.explain = "why";
  tag(halfDressed(), &warnings, authored);
  EXPECT_THAT(warnings,
              ::testing::ElementsAre("--explain has nothing to tell: its author chose the hidden faces, none "
                                     "were looked for; ask for --auto-occlusion"));
}

TEST(TagRegions, WarnsOfWhatIsHardlyMeant) {
  std::vector<std::string> warnings;
  RawAsset far = halfDressed();
  for (RawMeshNode& node : far.meshes) {
    if (node.name != "garment.tunic") continue;
    for (RawPrimitive& primitive : node.primitives) {
      for (RawVertex& vertex : primitive.vertices) vertex.position *= 100.0f;
    }
    for (RawPrimitive& primitive : node.primitives) {
      for (RawVertex& vertex : primitive.vertices) vertex.position.x += 300.0f;
    }
  }
  tag(far, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], ::testing::StartsWith("garment 'garment.tunic' lies "));
  warnings.clear();
  RawAsset covered = halfDressed();
  covered.scene_extras_json = R"({"ensemble": {"hide": "legs,torso,head"}})";
  tag(covered, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("nothing of the body shows under it"));
}

TEST(TagRegions, WarnsOnceOfACompleteBody) {
  std::vector<std::string> warnings;
  const Item item = tag(testing::tubeOutfit([](int, int) { return true; }), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("--auto-occlusion"));
  for (const RegionTag& region : item.tags) EXPECT_EQ(region.visibility, Visibility::kFull);
  std::vector<std::string> none;
  tag(halfDressed(), &none);
  EXPECT_THAT(none, IsEmpty());
}

TEST(TagRegions, ABodyMaterialThatTheTemplateLacksIsTold) {
  RawAsset misnamed = halfDressed();
  misnamed.materials[0].name = "tail";
  misnamed.meshes[0].json_pointer = "/nodes/2";
  EXPECT_INPUT_ERROR(tag(misnamed),
                     "tunic.glb: /nodes/2: the 64 faces of material 'tail' in node 'body' are the template's "
                     "body, which has no region of this name; name the material as the template's ('legs', "
                     "'torso', 'head'), or export it as a node of its own if it is a garment");

  // Elsewhere they are a garment, and a warning says so.
  RawAsset tailed = halfDressed();
  tailed.materials.push_back(tailed.materials[3]);
  tailed.materials[4].name = "tail";
  tailed.meshes[0].primitives.push_back(testing::tubeBand(4, 0.05f, 0.1f, 0.3f, 1));
  std::vector<std::string> warnings;
  const Item item = tag(tailed, &warnings);
  EXPECT_EQ(item.garments.size(), 2u);
  EXPECT_THAT(warnings, ::testing::ElementsAre(
                            "the 16 faces of material 'tail' in node 'body' are in no region of the template "
                            "('legs', 'torso', 'head'), so they count as a garment"));
}

}  // namespace
}  // namespace ensemble
