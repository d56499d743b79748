#include "assetpipe/segment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/input_error.h"
#include "tests/support/expect_error.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TemplateBody segmentTube(const SegmentOptions& options = {}, RawAsset asset = testing::tubeTemplate()) {
  std::vector<std::string> warnings;
  return segmentTemplate(asset, options, "tube.glb", warnings);
}

std::vector<std::string> regionNames(const TemplateBody& body) {
  std::vector<std::string> names;
  for (const Region& region : body.regions) names.push_back(region.name);
  return names;
}

TEST(Segment, ByMaterialKeepsTheFilesOrder) {
  const TemplateBody body = segmentTube();
  EXPECT_THAT(regionNames(body), ElementsAre("legs", "torso", "head"));
  EXPECT_EQ(body.faces.size(), 192u);
  for (const Region& region : body.regions) EXPECT_EQ(region.face_count, 64u);
  const RawAsset source = testing::tubeTemplate();
  for (std::uint32_t r = 0; r < 3; ++r) {
    const RawPrimitive& primitive = source.meshes[0].primitives[r];
    for (std::uint32_t f = 0; f < 64; ++f) {
      const FaceId face(r * 64 + f);
      EXPECT_EQ(body.region_of_face[face], RegionId(r));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(body.vertices[VertexId(body.faces[face][k])].position,
                  primitive.vertices[primitive.faces[f][k]].position);
      }
    }
  }
}

TEST(Segment, JoinsPrimitivesOfOneMaterialAndWeldsThem) {
  RawAsset asset = testing::tubeTemplate();
  auto& primitives = asset.meshes[0].primitives;
  RawPrimitive second_half = primitives[0];
  second_half.faces.erase(second_half.faces.begin(), second_half.faces.begin() + 32);
  primitives[0].faces.resize(32);
  primitives.push_back(second_half);
  const TemplateBody split = segmentTube({}, asset), whole = segmentTube();
  EXPECT_THAT(regionNames(split), ElementsAre("legs", "torso", "head"));
  EXPECT_EQ(split.vertices.size(), whole.vertices.size());
  EXPECT_EQ(split.faces, whole.faces);
}

TEST(Segment, IgnoresBlendersCopyNumbersUnlessTwoWouldBeOne) {
  RawAsset asset = testing::tubeTemplate();
  asset.materials[0].name = "legs.001";
  EXPECT_THAT(regionNames(segmentTube({}, asset)), ElementsAre("legs", "torso", "head"));
  asset.materials[1].name = "legs.002";
  EXPECT_THAT(regionNames(segmentTube({}, asset)), ElementsAre("legs.001", "legs.002", "head"));
}

TEST(Segment, ByJointsUsesTheDominantWeight) {
  const TemplateBody body = segmentTube({SegmentBy::kJoints, {}, ""});
  // Both joints are the torso's by name.
  EXPECT_THAT(regionNames(body), ElementsAre("torso"));
  RawAsset asset = testing::tubeTemplate();
  asset.skeleton.bones[0].name = "Bone";
  asset.skeleton.bones[1].name = "mixamorig:Head";
  const TemplateBody named = segmentTube({SegmentBy::kJoints, {}, ""}, asset);
  EXPECT_THAT(regionNames(named), ElementsAre("torso", "head"));
  EXPECT_EQ(named.regions[RegionId(0)].face_count + named.regions[RegionId(1)].face_count, 192u);
  EXPECT_EQ(named.regions[RegionId(0)].face_count, 96u);
}

TEST(Segment, ByJointsOfUnknownNamesMakesARegionOfEach) {
  RawAsset asset = testing::tubeTemplate();
  asset.skeleton.bones[0].name = "b0";
  asset.skeleton.bones[1].name = "b1";
  EXPECT_THAT(regionNames(segmentTube({SegmentBy::kJoints, {}, ""}, asset)), ElementsAre("b0", "b1"));
}

TEST(Segment, KnowsTheJointNamesOfCommonSkeletons) {
  const std::vector<std::pair<const char*, const char*>> expected = {{"mixamorig:LeftForeArm", "arms"},
                                                                     {"mixamorig:LeftUpLeg", "legs"},
                                                                     {"mixamorig:LeftHandIndex1", "hands"},
                                                                     {"mixamorig:LeftToeBase", "feet"},
                                                                     {"mixamorig:Spine2", "torso"},
                                                                     {"mixamorig:LeftShoulder", "torso"},
                                                                     {"lShldrBend", "arms"},
                                                                     {"lThighTwist", "legs"},
                                                                     {"rMid1", "hands"},
                                                                     {"upperarm_l", "arms"},
                                                                     {"clavicle_l", "torso"},
                                                                     {"ball_r", "feet"},
                                                                     {"upper_arm.L", "arms"},
                                                                     {"f_ring.01.L", "hands"},
                                                                     {"shin.L", "legs"},
                                                                     {"upperarm01.L", "arms"},
                                                                     {"toe1-1.L", "feet"},
                                                                     {"neck_01", "head"},
                                                                     {"jaw", "head"},
                                                                     {"tail", ""},
                                                                     {"spring", ""}};
  for (const auto& [joint, part] : expected) EXPECT_EQ(bodyPartOfJoint(joint), part) << joint;
}

TEST(Segment, ByRulesTakesMaterialsJointsAndFaces) {
  SegmentOptions options;
  options.by = SegmentBy::kRules;
  options.rules = {
      {"hat", {}, {}, {{190, 191}}}, {"top", {"head"}, {}, {}}, {"rest", {}, {"pelvis", "spine"}, {}}};
  const TemplateBody body = segmentTube(options);
  EXPECT_THAT(regionNames(body), ElementsAre("rest", "top", "hat"));
  EXPECT_EQ(body.regions[RegionId(0)].face_count, 128u);
  EXPECT_EQ(body.regions[RegionId(1)].face_count, 62u);
  EXPECT_EQ(body.regions[RegionId(2)].face_count, 2u);
  options.rules.pop_back();
  EXPECT_INPUT_ERROR(segmentTube(options),
                     "tube.glb: /meshes: no region takes face 0 (material 'legs', joint 'pelvis'); name its "
                     "material or joint in the --regions file");
}

TEST(Segment, RulesComeFromAFile) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "regions.yaml";
  std::ofstream(file)
      << "regions:\n  top: {materials: [head], faces: [0-9, 12]}\n  rest: {joints: [pelvis, spine]}\n";
  const std::vector<RegionRule> rules = readRegionRules(file);
  ASSERT_EQ(rules.size(), 2u);
  EXPECT_EQ(rules[0].name, "top");
  EXPECT_THAT(rules[0].faces, ElementsAre(std::pair(0u, 9u), std::pair(12u, 12u)));
  EXPECT_THAT(rules[1].joints, ElementsAre("pelvis", "spine"));
  std::ofstream(file) << "regions:\n  top: {faces: [9-0]}\n";
  EXPECT_INPUT_ERROR(
      readRegionRules(file),
      file.string() +
          ": 2:17: '9-0' is no range of faces; write a number such as 12 or a range such as 0-99");
}

TEST(Segment, LetsWedgesOfOnePositionShareSkinWeights) {
  RawAsset asset = testing::tubeTemplate();
  // The torso's lowest ring lies on the legs' highest one; give it other weights.
  for (int segment = 0; segment < testing::kTubeSegments; ++segment) {
    RawVertex& vertex = asset.meshes[0].primitives[1].vertices[static_cast<std::size_t>(segment)];
    vertex.skin.weights = {0.9f, 0.1f, 0.0f, 0.0f};
  }
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(asset, {}, "tube.glb", warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("8 vertices at seams"));
  for (const RawVertex& a : body.vertices) {
    for (const RawVertex& b : body.vertices) {
      EXPECT_TRUE(a.position != b.position || a.skin == b.skin);
    }
  }
}

TEST(Segment, RefusesWhatItCantUse) {
  RawAsset nameless = testing::tubeTemplate();
  nameless.materials[1].name = "";
  EXPECT_INPUT_ERROR(
      segmentTube({}, nameless),
      "tube.glb: /materials: the template's faces have no material name to make regions of; give each "
      "part of the body a named material, or use --regions joints");
  // A stand-in for a name that the file does not have makes no region either.
  nameless.materials[1].name = "material 1";
  nameless.materials[1].has_name = false;
  EXPECT_INPUT_ERROR(
      segmentTube({}, nameless),
      "tube.glb: /materials: the template's faces have no material name to make regions of; give each "
      "part of the body a named material, or use --regions joints");
  RawAsset boneless = testing::tubeTemplate();
  boneless.skeleton = {};
  EXPECT_INPUT_ERROR(
      segmentTube({}, boneless),
      "tube.glb: /skins: the template has no skin, so it can't be animated; bind the body to a skeleton "
      "and export it with its skin");
  RawAsset faceless = testing::tubeTemplate();
  faceless.meshes.clear();
  EXPECT_INPUT_ERROR(
      segmentTube({}, faceless),
      "tube.glb: /meshes: the template has no skinned triangles; bind the body to a skeleton and export "
      "it with its skin");
  EXPECT_INPUT_ERROR(
      segmentTube({SegmentBy::kMaterial, {}, "Body"}),
      "tube.glb: /nodes: no mesh node is named 'Body'; name one with --body (`ensemble inspect` lists them)");
}

}  // namespace
}  // namespace ensemble
