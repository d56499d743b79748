// What the glTF reader refuses in meshes, nodes, skins, clips and materials, with the exact message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/gltf_file.h"
#include "core/image_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"
#include "tests/core/gltf_refusal.h"

namespace ensemble {
namespace {

using testing::refusal;
using testing::skinnedGlb;
using testing::TestGlb;
using testing::triangleGlb;

// Meshes.

TEST(GltfHostile, IndexOutOfRange) {
  TestGlb glb = triangleGlb();
  glb.bin[glb.bin.size() - 2] = std::byte{3};
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/indices: index 3 at 2 is not below the number of "
            "vertices, 3; export the file again");
}

TEST(GltfHostile, IndicesOfAWrongType) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][2]["componentType"] = 5122;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/2: expected unsigned integers; export the file again");
}

TEST(GltfHostile, PositionsThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    TestGlb glb = triangleGlb();
    std::memcpy(glb.bin.data() + 16, &bad, 4);
    EXPECT_EQ(refusal(glb),
              "x.glb: /accessors/0: element 1 is not a finite number; remove the damaged vertex "
              "or key and export the file again");
  }
}

TEST(GltfHostile, PositionsThatOverflowInTheWorld) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["scale"] = {1e38, 1e38, 1e38};
  const float big = 1e30f;
  std::memcpy(glb.bin.data() + 12, &big, 4);
  EXPECT_EQ(refusal(glb),
            "x.glb: /nodes/0: a vertex of the node is too far away to be a number; "
            "export the file again");
}

TEST(GltfHostile, AttributeCounts) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][1]["count"] = 2;
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/attributes/NORMAL: 2 NORMAL for 3 positions; "
            "export the file again");
  glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/attributes/NORMAL: NORMAL has 1 components instead of "
            "3; export the file again");
}

TEST(GltfHostile, MissingPositions) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/attributes: 'POSITION' is missing; "
            "export the file again");
}

TEST(GltfHostile, TooManyVerticesOverAllInstances) {
  TestGlb glb = triangleGlb();
  GltfReadOptions options;
  options.max_vertices = 7;
  for (int i = 0; i < 2; ++i) glb.json["scenes"][0]["nodes"].push_back(glb.add("nodes", {{"mesh", 0}}));
  EXPECT_EQ(refusal(glb, options),
            "x.glb: /meshes/0/primitives/0: 3 vertices are more than the 1 still allowed "
            "in this file; split the file");
}

TEST(GltfHostile, Mode) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["mode"] = 7;
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/mode: 7 is more than 6; export the file again");
}

TEST(GltfHostile, TemplateVertex) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["_TEMPLATE_VERTEX"] =
      glb.addAccessor<float>({0, 1.5f, 2}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/attributes/_TEMPLATE_VERTEX: 1.5 is no vertex number; "
            "tag the outfit again");
}

TEST(GltfHostile, Collapse) {
  const auto refusalOf = [](const std::vector<float>& values) {
    TestGlb glb = triangleGlb();
    glb.json["meshes"][0]["primitives"][0]["attributes"]["_COLLAPSE"] =
        glb.addAccessor<float>(values, "VEC2");
    return refusal(glb);
  };
  const std::string at = "x.glb: /meshes/0/primitives/0/attributes/_COLLAPSE: ",
                    mend = "; tag the outfit again";
  EXPECT_EQ(refusalOf({0, 0, 0.5f, 1, 2, 0}), at + "vertex 1 can't go to 0.5 at level 1" + mend);
  EXPECT_EQ(refusalOf({0, 0, 0, 256, 2, 0}), at + "vertex 1 can't go to 0 at level 256" + mend);
  EXPECT_EQ(refusalOf({0, 0, -1, 1, 2, 0}), at + "vertex 1 can't go to -1 at level 1" + mend);
  const std::string ends = at + "a vertex goes to one that does not outlast it" + mend;
  EXPECT_EQ(refusalOf({0, 0, 3, 1, 2, 0}), ends) << "there are three vertices";
  EXPECT_EQ(refusalOf({1, 1, 0, 1, 2, 0}), ends) << "in a ring";
  EXPECT_EQ(refusalOf({0, 0, 0, 0, 2, 0}), ends) << "it goes at no level";
}

TEST(GltfHostile, Paint) {
  const auto refusalOf = [](const std::vector<float>& values, const char* type) {
    TestGlb glb = triangleGlb();
    glb.json["meshes"][0]["primitives"][0]["attributes"]["_HIDE"] = glb.addAccessor<float>(values, type);
    return refusal(glb);
  };
  EXPECT_EQ(refusalOf({1, 1}, "SCALAR"),
            "x.glb: /meshes/0/primitives/0/attributes/_HIDE: 2 _HIDE for 3 positions; export the file again");
  EXPECT_EQ(refusalOf({1, 1, 1, 1, 1, 1}, "VEC2"),
            "x.glb: /meshes/0/primitives/0/attributes/_HIDE: _HIDE has 2 components instead of 1; export the "
            "file again");
  EXPECT_EQ(
      refusalOf({1, std::nanf(""), 1}, "SCALAR"),
      "x.glb: /accessors/3: element 1 is not a finite number; remove the damaged vertex or key and export "
      "the file again");
}

TEST(GltfHostile, ReferencesOutOfRange) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/material: there is no 'materials' number 0; "
            "export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["mesh"] = 1;
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/mesh: there is no 'meshes' number 1; export the file again");
  glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["indices"] = 9;
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/indices: there is no 'accessors' number 9; "
            "export the file again");
  glb = triangleGlb();
  glb.json["scene"] = 1;
  EXPECT_EQ(refusal(glb), "x.glb: /scene: there is no 'scenes' number 1; export the file again");
}

// Nodes.

TEST(GltfHostile, NodeCycle) {
  TestGlb glb = triangleGlb();
  glb.add("nodes", {{"children", {2}}});
  glb.add("nodes", {{"children", {1}}});
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/1: the node is its own ancestor; export the file again");
}

TEST(GltfHostile, NodeWithTwoParents) {
  TestGlb glb = triangleGlb();
  glb.add("nodes", {{"children", {3}}});
  glb.add("nodes", {{"children", {3}}});
  glb.add("nodes", nlohmann::json::object());
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/3: the node has two parents, 1 and 2; export the file again");
}

TEST(GltfHostile, SceneNamesAChild) {
  TestGlb glb = skinnedGlb();
  glb.json["scenes"][0]["nodes"] = {0, 2};
  EXPECT_EQ(refusal(glb), "x.glb: /scenes/0/nodes/1: node 2 is no root; export the file again");
}

TEST(GltfHostile, TooManyNodes) {
  TestGlb glb = skinnedGlb();
  GltfReadOptions options;
  options.max_nodes = 2;
  EXPECT_EQ(refusal(glb, options), "x.glb: /nodes: 3 nodes are more than the 2 allowed; split the file");
}

TEST(GltfHostile, NodeTransforms) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
  EXPECT_EQ(refusal(glb),
            "x.glb: /nodes/0/rotation: the rotation is no unit quaternion; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {0, 0};
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/translation: expected 3 numbers, found 2; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(refusal(glb),
            "x.glb: /nodes/0/matrix: the matrix is not affine: its last row must be 0 0 0 1; "
            "export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {1e39, 0, 0};
  EXPECT_EQ(refusal(glb),
            "x.glb: /nodes/0: the node's place in the world is not finite; export the file again");
}

// Skins.

TEST(GltfHostile, JointTwice) {
  TestGlb glb = skinnedGlb();
  glb.json["skins"][0]["joints"] = {1, 1};
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0/joints/1: node 1 is a joint twice; export the file again");
}

TEST(GltfHostile, SkinWithoutJoints) {
  TestGlb glb = skinnedGlb();
  glb.json["skins"][0]["joints"] = nlohmann::json::array();
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0/joints: the skin has no joints; export the file again");
}

TEST(GltfHostile, TooManyJoints) {
  GltfReadOptions options;
  options.max_joints = 1;
  EXPECT_EQ(refusal(skinnedGlb(), options),
            "x.glb: /skins/0/joints: 2 joints are more than the 1 allowed; split the file");
}

TEST(GltfHostile, InverseBindMatrices) {
  TestGlb glb = skinnedGlb();
  glb.json["accessors"][5]["count"] = 1;
  EXPECT_EQ(refusal(glb),
            "x.glb: /skins/0/inverseBindMatrices: 1 inverse bind matrices for 2 joints; "
            "export the file again");
  glb = skinnedGlb();
  glb.json["skins"][0]["inverseBindMatrices"] = glb.addAccessor<float>(std::vector<float>(32, 0.0f), "MAT4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /skins/0/inverseBindMatrices: matrix 0 is not affine: its last row must be "
            "0 0 0 1; export the file again");
  std::vector<float> flat(32, 0.0f);
  flat[15] = flat[31] = 1.0f;
  glb.json["skins"][0]["inverseBindMatrices"] = glb.addAccessor<float>(flat, "MAT4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /skins/0/inverseBindMatrices: matrix 0 has no inverse; export the file again");
}

TEST(GltfHostile, Weights) {
  TestGlb glb = skinnedGlb();
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: vertex 1 has no weight: its weights sum to zero; bind "
            "the vertex to a joint and export again");
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 1.5f, -0.5f, 0, 0, 1, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: vertex 1 has the negative weight -0.5; normalise the "
            "weights and export again");
  attributes.erase("WEIGHTS_0");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: the primitive has only one of JOINTS_0 and WEIGHTS_0; "
            "export the file again");
  attributes.erase("JOINTS_0");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: the mesh has a skin, but the primitive has no JOINTS_0 "
            "and WEIGHTS_0; bind every vertex to a joint and export again");
}

TEST(GltfHostile, JointOutOfRange) {
  TestGlb glb = skinnedGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      glb.addAccessor<std::uint8_t>({0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: vertex 1 names joint 2 of 2; export the file again");
}

TEST(GltfHostile, SkeletonOfScaleZero) {
  TestGlb glb = skinnedGlb();
  glb.json["nodes"][1]["scale"] = {0, 0, 0};
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("accepted"));  // posed flat, but bound soundly
  glb = skinnedGlb();
  glb.add("nodes", {{"name", "Armature"}, {"scale", {0, 0, 0}}, {"children", {1}}});
  glb.json["scenes"][0]["nodes"] = {0, 3};
  EXPECT_EQ(refusal(glb),
            "x.glb: /skins/0: the skeleton's scale is 0; apply the armature's transforms and "
            "export again");
}

// Clips.

TEST(GltfHostile, Times) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({1, 1}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/input: the times do not ascend at key 1; "
            "export the file again");
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({-1, 1}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/input: key 0 has a negative time; export the file again");
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({0, 1, 2}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/output: 2 values for 3 keys; export the file again");
  const int times = glb.addAccessor<float>({0, std::numeric_limits<float>::quiet_NaN()}, "SCALAR");
  glb.json["animations"][0]["samplers"][0]["input"] = times;
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("element 1 is not a finite number"));
}

TEST(GltfHostile, TooManyKeys) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  GltfReadOptions options;
  options.max_keys = 1;
  EXPECT_EQ(refusal(glb, options),
            "x.glb: /animations/0/samplers/0/input: more than the 1 keys allowed in a "
            "file; export at a lower frame rate");
  glb.json["accessors"].push_back({{"componentType", 5126}, {"count", 4000000000u}, {"type", "SCALAR"}});
  glb.json["animations"][0]["samplers"][0]["input"] = glb.json["accessors"].size() - 1;
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("more than the 4194304 keys"));
}

TEST(GltfHostile, EndlessClip) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({0, 1e30f}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0: the clip's 1.0000000150474662e+30 s for 2 bones are more than "
            "fit; shorten the clip");
}

TEST(GltfHostile, TooManySkinsAndInfluences) {
  TestGlb glb = skinnedGlb();
  GltfReadOptions options;
  options.max_joints = 2;
  for (int i = 0; i < 2; ++i) glb.add("skins", glb.json["skins"][0]);
  EXPECT_EQ(refusal(glb, options), "x.glb: /skins: 3 skins are more than the 2 allowed; split the file");
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  for (int set = 1; set <= 16; ++set) {
    attributes["JOINTS_" + std::to_string(set)] = attributes["JOINTS_0"];
    attributes["WEIGHTS_" + std::to_string(set)] = attributes["WEIGHTS_0"];
  }
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: a vertex has more than 64 influences; limit them to "
            "four");
}

TEST(GltfHostile, ImagesThatShareAView) {
  TestGlb glb = triangleGlb();
  std::vector<std::byte> png = encodePng({1, 1, {1, 2, 3, 4}});
  png.resize(1000);
  const int view = glb.addView(png);
  auto primitive = glb.json["meshes"][0]["primitives"][0];
  for (int i = 0; i < 5; ++i) {
    glb.add("images", {{"bufferView", view}});
    glb.add("textures", {{"source", i}});
    primitive["material"] =
        glb.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    glb.json["meshes"][0]["primitives"].push_back(primitive);
  }
  GltfReadOptions options;
  options.max_file_bytes = 4500;
  EXPECT_EQ(refusal(glb, options),
            "x.glb: /images/4: the images add up to more than 4500 bytes; split the file");
  EXPECT_EQ(refusal(glb), "accepted");
}

TEST(GltfHostile, LongNamesAreCutInMessages) {
  TestGlb glb = triangleGlb();
  glb.json["extensionsRequired"] = {std::string(100000, 'x')};
  EXPECT_LT(refusal(glb).size(), 600u);
}

TEST(GltfHostile, Channels) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  auto& animation = glb.json["animations"][0];
  animation["channels"].push_back(animation["channels"][0]);
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/channels/1: the clip animates this property of this node twice; "
            "export the file again");
  animation["channels"].erase(1);
  animation["channels"][0]["sampler"] = 1;
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/channels/0/sampler: there is no sampler number 1; "
            "export the file again");
  animation["channels"][0]["sampler"] = 0;
  animation["channels"][0]["target"]["path"] = "colour";
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/channels/0/target/path: path 'colour' does not exist; "
            "export the file again");
  animation["channels"][0]["target"]["path"] = "rotation";
  animation["samplers"][0]["interpolation"] = "SMOOTH";
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/interpolation: interpolation 'SMOOTH' does not exist; "
            "export the file again");
  animation["samplers"][0]["interpolation"] = "LINEAR";
  animation["samplers"][0]["output"] = glb.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/output: rotation 1 is a quaternion of length 0; "
            "export the file again");
}

TEST(GltfHostile, ClipWithoutKeys) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/input: the channel has no keys; export the file again");
}

// Materials and images.

TEST(GltfHostile, Materials) {
  TestGlb glb = triangleGlb();
  glb.add("materials", {{"alphaMode", "GLASS"}});
  EXPECT_EQ(refusal(glb),
            "x.glb: /materials/0/alphaMode: alphaMode 'GLASS' does not exist; "
            "export the file again");
  glb.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 2}}}}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /materials/0/pbrMetallicRoughness/baseColorFactor: 2 is not between 0 and 1; "
            "export the file again");
  glb.json["materials"][0] = {{"alphaMode", "MASK"}, {"alphaCutoff", -1}};
  EXPECT_EQ(refusal(glb), "x.glb: /materials/0/alphaCutoff: alphaCutoff is negative; export the file again");
}

TEST(GltfHostile, Images) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  glb.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  glb.add("textures", {{"source", 0}});
  glb.add("images", {{"bufferView", glb.addView<std::uint8_t>({'G', 'I', 'F', '8', '9', 'a', 0, 0})}});
  EXPECT_EQ(refusal(glb),
            "x.glb: /images/0: the image is neither PNG nor JPEG; convert the image to PNG or "
            "JPEG");
  glb.json["images"][0] = {{"bufferView", 77}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /images/0/bufferView: there is no 'bufferViews' number 77; "
            "export the file again");
  glb.json["images"][0] = {{"uri", "skin.png"}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /images/0/uri: a file in memory can't name other files; pack everything into "
            "the GLB");
}

}  // namespace
}  // namespace ensemble
