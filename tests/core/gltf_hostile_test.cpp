// Everything that the glTF reader refuses, with the exact message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/gltf_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

using testing::skinnedGlb;
using testing::TestGlb;
using testing::triangleGlb;

std::string refusal(const std::vector<std::byte>& bytes, const GltfReadOptions& options = {}) {
  try {
    readGlb(bytes, "x.glb", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}
std::string refusal(const TestGlb& glb, const GltfReadOptions& options = {}) {
  return refusal(glb.bytes(), options);
}

void putWord(std::vector<std::byte>& bytes, std::size_t offset, std::uint32_t value) {
  std::memcpy(bytes.data() + offset, &value, 4);
}

// The container.

TEST(GltfHostile, BaseIsAccepted) {
  EXPECT_EQ(refusal(triangleGlb()), "accepted");
  EXPECT_EQ(refusal(skinnedGlb()), "accepted");
}

TEST(GltfHostile, NotAGlb) {
  EXPECT_EQ(refusal(std::vector<std::byte>{}), "x.glb: byte 0: this is not a GLB; export the file again");
  EXPECT_EQ(refusal(std::vector<std::byte>(64, std::byte{7})),
            "x.glb: byte 0: this is not a GLB; export the file again");
}

TEST(GltfHostile, GlbVersion) {
  auto bytes = triangleGlb().bytes();
  putWord(bytes, 4, 1);
  EXPECT_EQ(refusal(bytes), "x.glb: byte 4: GLB version 1 instead of 2; export the file again");
}

TEST(GltfHostile, GlbLength) {
  auto bytes = TestGlb::fromText("{}");
  bytes.resize(bytes.size() - 4);
  EXPECT_EQ(refusal(bytes),
            "x.glb: byte 8: the header promises 24 bytes, the file has 20; export the file again");
}

TEST(GltfHostile, ChunkBeyondTheEnd) {
  auto bytes = TestGlb::fromText("{}");
  putWord(bytes, 12, 0xfffffffc);
  EXPECT_EQ(refusal(bytes), "x.glb: byte 12: a chunk of 4294967292 bytes reaches beyond the file's end; "
                            "export the file again");
}

TEST(GltfHostile, ChunkNotAligned) {
  auto bytes = TestGlb::fromText("{}  {}  ");
  putWord(bytes, 12, 6);
  EXPECT_EQ(refusal(bytes), "x.glb: byte 12: a chunk's 6 bytes are no multiple of 4; export the file again");
}

TEST(GltfHostile, FirstChunkIsBinary) {
  auto bytes = TestGlb::fromText("{}");
  putWord(bytes, 16, 0x004e4942);
  EXPECT_EQ(refusal(bytes), "x.glb: byte 12: the first chunk is not JSON; export the file again");
}

TEST(GltfHostile, NoJson) {
  EXPECT_EQ(refusal(TestGlb::fromText("")), "x.glb: byte 12: the GLB has no JSON; export the file again");
}

// The JSON.

TEST(GltfHostile, MalformedJson) {
  EXPECT_EQ(refusal(TestGlb::fromText("{\"asset\":}")),
            "x.glb: byte 10: the JSON is malformed; export the file again");
  EXPECT_EQ(refusal(TestGlb::fromText("{\"asset\":NaN}")),
            "x.glb: byte 10: the JSON is malformed; export the file again");
  EXPECT_EQ(refusal(TestGlb::fromText("{\"a\":\"\xff\xff\"}")),
            "x.glb: byte 7: the JSON is malformed; export the file again");
}

TEST(GltfHostile, JsonNumberOutOfRange) {
  EXPECT_EQ(refusal(TestGlb::fromText("{\"a\":1e999}")),
            "x.glb: the JSON has a number that is out of range; export the file again");
}

TEST(GltfHostile, JsonIsNoObject) {
  EXPECT_EQ(refusal(TestGlb::fromText("[1]")), "x.glb: the JSON is not an object; export the file again");
}

TEST(GltfHostile, DeepNesting) {
  std::string text = R"({"asset":{"version":"2.0"},"extras":)";
  const std::size_t start = text.size();
  text += std::string(20000, '[') + std::string(20000, ']') + "}";
  EXPECT_EQ(refusal(TestGlb::fromText(text)), "x.glb: byte " + std::to_string(start + 63) +
                                                  ": the JSON is nested more than 64 deep; remove the nested "
                                                  "extras");
  // Brackets in strings nest nothing, and the limit itself is allowed.
  TestGlb glb = triangleGlb();
  glb.json["extras"] = std::string(500, '[') + "\\\"" + std::string(500, '{');
  EXPECT_EQ(refusal(glb), "accepted");
  glb.json["extras"] = nlohmann::json::parse(std::string(63, '[') + std::string(63, ']'));
  EXPECT_EQ(refusal(glb), "accepted");
}

TEST(GltfHostile, TooMuchJson) {
  GltfReadOptions options;
  options.max_json_bytes = 100;
  EXPECT_THAT(refusal(triangleGlb(), options), ::testing::MatchesRegex(
      "x.glb: [0-9]+ bytes of JSON are more than the 100 allowed; split the file"));
}

TEST(GltfHostile, Version) {
  TestGlb glb = triangleGlb();
  glb.json["asset"]["version"] = "1.0";
  EXPECT_EQ(refusal(glb), "x.glb: /asset/version: glTF version 1.0 instead of 2.0; export as glTF 2.0");
  glb.json["asset"] = nlohmann::json::object();
  EXPECT_EQ(refusal(glb), "x.glb: /asset: 'version' is missing; export the file again");
}

TEST(GltfHostile, RequiredExtension) {
  TestGlb glb = triangleGlb();
  glb.json["extensionsRequired"] = {"KHR_mesh_quantization", "EXT_meshopt_compression"};
  EXPECT_EQ(refusal(glb), "x.glb: /extensionsRequired/1: the file requires extension "
                          "'EXT_meshopt_compression'; export without this extension");
}

TEST(GltfHostile, IndicesThatAreNoWholeNumbers) {
  for (const auto& [value, shown] : {std::pair<nlohmann::json, std::string>{-1, "-1"},
                                     {0.5, "0.5"},
                                     {"0", "string"},
                                     {nullptr, "null"},
                                     {1e30, "1e+30"}}) {
    TestGlb glb = triangleGlb();
    glb.json["nodes"][0]["mesh"] = value;
    EXPECT_EQ(refusal(glb),
              "x.glb: /nodes/0/mesh: expected a whole number, found " + shown + "; export the file again");
  }
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["mesh"] = 0.0;  // whole, if oddly written
  EXPECT_EQ(refusal(glb), "accepted");
}

TEST(GltfHostile, WrongKinds) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"] = 3;
  EXPECT_EQ(refusal(glb), "x.glb: /nodes: expected an array, found 3; export the file again");
  glb = triangleGlb();
  glb.json["nodes"] = {1};
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0: expected an object, found 1; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["name"] = 7;
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/name: expected a string, found 7; export the file again");
}

// Buffers, views, accessors.

TEST(GltfHostile, BufferLongerThanItsData) {
  TestGlb glb = triangleGlb();
  glb.json["buffers"] = {{{"byteLength", 1000}}};
  EXPECT_EQ(refusal(glb), "x.glb: /buffers/0: the buffer promises 1000 bytes and has 80; export the file again");
}

TEST(GltfHostile, SecondBufferWithoutData) {
  TestGlb glb = triangleGlb();
  glb.json["buffers"] = {{{"byteLength", 78}}, {{"byteLength", 4}}};
  EXPECT_EQ(refusal(glb), "x.glb: /buffers/1: the buffer has no data; export the file again");
}

TEST(GltfHostile, ViewBeyondItsBuffer) {
  TestGlb glb = triangleGlb();
  glb.json["bufferViews"][0]["byteLength"] = 79;
  EXPECT_EQ(refusal(glb),
            "x.glb: /bufferViews/0: bytes 0 to 79 reach beyond the buffer's 78; export the file again");
  glb = triangleGlb();
  glb.json["bufferViews"][0]["byteOffset"] = 9007199254740991ull;
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("reach beyond the buffer's 78"));
  glb.json["bufferViews"][0]["byteOffset"] = 18446744073709551615ull;  // would overflow the sum
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("18446744073709551615 is more than"));
}

TEST(GltfHostile, ViewOfNoBuffer) {
  TestGlb glb = triangleGlb();
  glb.json["bufferViews"][1]["buffer"] = 5;
  EXPECT_EQ(refusal(glb), "x.glb: /bufferViews/1/buffer: there is no 'buffers' number 5; export the file again");
}

TEST(GltfHostile, Stride) {
  TestGlb glb = triangleGlb();
  glb.json["bufferViews"][0]["byteStride"] = 6;
  EXPECT_EQ(refusal(glb),
            "x.glb: /bufferViews/0: byteStride 6 is no multiple of 4 from 4 to 252; export the file again");
  glb.json["bufferViews"][0]["byteStride"] = 8;
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0: elements of 12 bytes do not fit a stride of 8; export the file again");
  glb.json["bufferViews"][0]["byteStride"] = 256;
  EXPECT_EQ(refusal(glb), "x.glb: /bufferViews/0/byteStride: 256 is more than 252; export the file again");
}

TEST(GltfHostile, AccessorBeyondItsView) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0]["count"] = 4;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0: 4 elements need 48 bytes from byte 0, bufferView 0 has 36; "
                          "export the file again");
  glb.json["accessors"][0]["count"] = 4000000000u;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0: 4000000000 elements need 48000000000 bytes from byte 0, "
                          "bufferView 0 has 36; export the file again");
}

TEST(GltfHostile, HugeAccessorWithoutData) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0] = {{"componentType", 5126}, {"count", 4000000000u}, {"type", "VEC3"}};
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: 4000000000 vertices are more than the 16777216 still "
                          "allowed in this file; split the file");
}

TEST(GltfHostile, HugeIndexAccessorWithoutData) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][2] = {{"componentType", 5125}, {"count", 4000000000u}, {"type", "SCALAR"}};
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: 4000000000 indices are more than the 100663296 still "
                          "allowed in this file; split the file");
}

TEST(GltfHostile, AccessorKinds) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0]["componentType"] = 5124;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/componentType: componentType 5124 does not exist; "
                          "export the file again");
  glb = triangleGlb();
  glb.json["accessors"][0]["type"] = "VEC5";
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/type: type 'VEC5' does not exist; export the file again");
  glb = triangleGlb();
  glb.json["accessors"][2]["byteOffset"] = 1;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/2: byteOffset 1 is no multiple of 2; export the file again");
}

TEST(GltfHostile, Sparse) {
  TestGlb glb = triangleGlb();
  const int indices = glb.addView<std::uint16_t>({2, 1});
  const int values = glb.addView<float>({9, 9, 9, 8, 8, 8});
  glb.json["accessors"][0]["sparse"] = {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", values}}}};
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/sparse/indices: sparse index 1 is out of order or not below 3; "
                          "export the file again");
  glb.json["accessors"][0]["sparse"]["count"] = 4;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/sparse/count: 4 is more than 3; export the file again");
  glb.json["accessors"][0]["sparse"]["count"] = 3;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/sparse/indices: 3 elements need 6 bytes from byte 0, "
                          "bufferView 3 has 4; export the file again");
  glb.json["accessors"][0]["sparse"]["indices"]["componentType"] = 5126;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/sparse/indices: sparse indices must be unsigned integers; "
                          "export the file again");
}

// Meshes.

TEST(GltfHostile, IndexOutOfRange) {
  TestGlb glb = triangleGlb();
  glb.bin[glb.bin.size() - 2] = std::byte{3};
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/indices: index 3 at 2 is not below the number of "
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
    EXPECT_EQ(refusal(glb), "x.glb: /accessors/0: element 1 is not a finite number; remove the damaged vertex "
                            "or key and export the file again");
  }
}

TEST(GltfHostile, PositionsThatOverflowInTheWorld) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["scale"] = {1e38, 1e38, 1e38};
  const float big = 1e30f;
  std::memcpy(glb.bin.data() + 12, &big, 4);
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0: a vertex of the node is too far away to be a number; "
                          "export the file again");
}

TEST(GltfHostile, AttributeCounts) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][1]["count"] = 2;
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/attributes/NORMAL: 2 NORMAL for 3 positions; "
                          "export the file again");
  glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/attributes/NORMAL: NORMAL has 1 components instead of "
                          "3; export the file again");
}

TEST(GltfHostile, MissingPositions) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/attributes: 'POSITION' is missing; "
                          "export the file again");
}

TEST(GltfHostile, TooManyVerticesOverAllInstances) {
  TestGlb glb = triangleGlb();
  GltfReadOptions options;
  options.max_vertices = 7;
  for (int i = 0; i < 2; ++i) glb.json["scenes"][0]["nodes"].push_back(glb.add("nodes", {{"mesh", 0}}));
  EXPECT_EQ(refusal(glb, options), "x.glb: /meshes/0/primitives/0: 3 vertices are more than the 1 still allowed "
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
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/attributes/_TEMPLATE_VERTEX: 1.5 is no vertex number; "
                          "tag the outfit again");
}

TEST(GltfHostile, ReferencesOutOfRange) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/material: there is no 'materials' number 0; "
                          "export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["mesh"] = 1;
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/mesh: there is no 'meshes' number 1; export the file again");
  glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["indices"] = 9;
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0/indices: there is no 'accessors' number 9; "
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
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/rotation: the rotation is no unit quaternion; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {0, 0};
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/translation: expected 3 numbers, found 2; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0/matrix: the matrix is not affine: its last row must be 0 0 0 1; "
                          "export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {1e39, 0, 0};
  EXPECT_EQ(refusal(glb), "x.glb: /nodes/0: the node's place in the world is not finite; export the file again");
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
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0/inverseBindMatrices: 1 inverse bind matrices for 2 joints; "
                          "export the file again");
  glb = skinnedGlb();
  glb.json["skins"][0]["inverseBindMatrices"] = glb.addAccessor<float>(std::vector<float>(32, 0.0f), "MAT4");
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0/inverseBindMatrices: matrix 0 is not affine: its last row must be "
                          "0 0 0 1; export the file again");
  std::vector<float> flat(32, 0.0f);
  flat[15] = flat[31] = 1.0f;
  glb.json["skins"][0]["inverseBindMatrices"] = glb.addAccessor<float>(flat, "MAT4");
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0/inverseBindMatrices: matrix 0 has no inverse; export the file again");
}

TEST(GltfHostile, Weights) {
  TestGlb glb = skinnedGlb();
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: vertex 1 has no weight: its weights sum to zero; bind "
                          "the vertex to a joint and export again");
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 1.5f, -0.5f, 0, 0, 1, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: vertex 1 has the negative weight -0.5; normalise the "
                          "weights and export again");
  attributes.erase("WEIGHTS_0");
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: the primitive has only one of JOINTS_0 and WEIGHTS_0; "
                          "export the file again");
  attributes.erase("JOINTS_0");
  EXPECT_EQ(refusal(glb), "x.glb: /meshes/0/primitives/0: the mesh has a skin, but the primitive has no JOINTS_0 "
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
  EXPECT_EQ(refusal(glb), "x.glb: /skins/0: the skeleton's scale is 0; apply the armature's transforms and "
                          "export again");
}

// Clips.

TEST(GltfHostile, Times) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({1, 1}, "SCALAR");
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/samplers/0/input: the times do not ascend at key 1; "
                          "export the file again");
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({-1, 1}, "SCALAR");
  EXPECT_EQ(refusal(glb),
            "x.glb: /animations/0/samplers/0/input: key 0 has a negative time; export the file again");
  glb.json["animations"][0]["samplers"][0]["input"] = glb.addAccessor<float>({0, 1, 2}, "SCALAR");
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/samplers/0/output: 2 values for 3 keys; export the file again");
  const int times = glb.addAccessor<float>({0, std::numeric_limits<float>::quiet_NaN()}, "SCALAR");
  glb.json["animations"][0]["samplers"][0]["input"] = times;
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("element 1 is not a finite number"));
}

TEST(GltfHostile, TooManyKeys) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  GltfReadOptions options;
  options.max_keys = 1;
  EXPECT_EQ(refusal(glb, options), "x.glb: /animations/0/samplers/0/input: more than the 1 keys allowed in a "
                                   "file; export at a lower frame rate");
  glb.json["accessors"].push_back({{"componentType", 5126}, {"count", 4000000000u}, {"type", "SCALAR"}});
  glb.json["animations"][0]["samplers"][0]["input"] = glb.json["accessors"].size() - 1;
  EXPECT_THAT(refusal(glb), ::testing::HasSubstr("more than the 4194304 keys"));
}

TEST(GltfHostile, Channels) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  auto& animation = glb.json["animations"][0];
  animation["channels"].push_back(animation["channels"][0]);
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/channels/1: the clip animates this property of this node twice; "
                          "export the file again");
  animation["channels"].erase(1);
  animation["channels"][0]["sampler"] = 1;
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/channels/0/sampler: there is no sampler number 1; "
                          "export the file again");
  animation["channels"][0]["sampler"] = 0;
  animation["channels"][0]["target"]["path"] = "colour";
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/channels/0/target/path: path 'colour' does not exist; "
                          "export the file again");
  animation["channels"][0]["target"]["path"] = "rotation";
  animation["samplers"][0]["interpolation"] = "SMOOTH";
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/samplers/0/interpolation: interpolation 'SMOOTH' does not exist; "
                          "export the file again");
  animation["samplers"][0]["interpolation"] = "LINEAR";
  animation["samplers"][0]["output"] = glb.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
  EXPECT_EQ(refusal(glb), "x.glb: /animations/0/samplers/0/output: rotation 1 is a quaternion of length 0; "
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
  EXPECT_EQ(refusal(glb), "x.glb: /materials/0/alphaMode: alphaMode 'GLASS' does not exist; "
                          "export the file again");
  glb.json["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 2}}}}};
  EXPECT_EQ(refusal(glb), "x.glb: /materials/0/pbrMetallicRoughness/baseColorFactor: 2 is not between 0 and 1; "
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
  EXPECT_EQ(refusal(glb), "x.glb: /images/0: the image is neither PNG nor JPEG; convert the image to PNG or "
                          "JPEG");
  glb.json["images"][0] = {{"bufferView", 77}};
  EXPECT_EQ(refusal(glb), "x.glb: /images/0/bufferView: there is no 'bufferViews' number 77; "
                          "export the file again");
  glb.json["images"][0] = {{"uri", "skin.png"}};
  EXPECT_EQ(refusal(glb), "x.glb: /images/0/uri: a file in memory can't name other files; pack everything into "
                          "the GLB");
}

// Random damage: never anything but a UserError.

TEST(GltfHostile, SurvivesRandomDamage) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 1);
  glb.add("materials", {{"name", "m"}, {"alphaMode", "MASK"}});
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  const std::vector<std::byte> sound = glb.bytes();
  GltfReadOptions options;
  options.max_vertices = options.max_faces = 1u << 16;
  std::uint64_t state = 42;
  const auto random = [&state](std::uint64_t below) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (state >> 33) % below;
  };
  int refused = 0;
  for (int round = 0; round < 6000; ++round) {
    std::vector<std::byte> bytes = sound;
    const std::uint64_t damages = 1 + random(4);
    for (std::uint64_t i = 0; i < damages; ++i) {
      // Digits become other digits now and then, which stays JSON and moves indices and counts.
      std::byte& target = bytes[random(bytes.size())];
      const bool is_digit = target >= std::byte{'0'} && target <= std::byte{'9'};
      target = static_cast<std::byte>(is_digit ? '0' + random(10) : random(256));
    }
    if (round % 10 == 0) {
      bytes.resize(random(bytes.size()));
      if (bytes.size() >= 12) putWord(bytes, 8, static_cast<std::uint32_t>(bytes.size()));
    }
    try {
      const RawAsset asset = readGlb(bytes, "x.glb", options);
      readGlb(writeGlb(asset), "again.glb");
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 6000);
}

}  // namespace
}  // namespace ensemble
