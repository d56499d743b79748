// What the glTF reader refuses in containers, JSON and accessors, with the exact message; and a sweep of
// random damage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/gltf_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"
#include "tests/core/gltf_refusal.h"

namespace ensemble {
namespace {

using testing::refusal;
using testing::skinnedGlb;
using testing::TestGlb;
using testing::triangleGlb;

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
  EXPECT_EQ(refusal(bytes),
            "x.glb: byte 12: a chunk of 4294967292 bytes reaches beyond the file's end; "
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
  EXPECT_THAT(
      refusal(triangleGlb(), options),
      ::testing::MatchesRegex("x.glb: [0-9]+ bytes of JSON are more than the 100 allowed; split the file"));
}

TEST(GltfHostile, TooManyJsonValues) {
  GltfReadOptions options;
  options.max_json_values = 4;
  EXPECT_EQ(refusal(TestGlb::fromText("{\"a\":[1,\"[,{\",{}]}"), options),
            "x.glb: byte 13: the JSON has more than 4 values; remove the nested extras");
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
  EXPECT_EQ(refusal(glb),
            "x.glb: /extensionsRequired/1: the file requires extension "
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
  EXPECT_EQ(refusal(glb),
            "x.glb: /buffers/0: the buffer promises 1000 bytes and has 80; export the file again");
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
  EXPECT_EQ(refusal(glb),
            "x.glb: /bufferViews/1/buffer: there is no 'buffers' number 5; export the file again");
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
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0: 4 elements need 48 bytes from byte 0, bufferView 0 has 36; "
            "export the file again");
  glb.json["accessors"][0]["count"] = 4000000000u;
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0: 4000000000 elements need 48000000000 bytes from byte 0, "
            "bufferView 0 has 36; export the file again");
}

TEST(GltfHostile, HugeAccessorWithoutData) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0] = {{"componentType", 5126}, {"count", 4000000000u}, {"type", "VEC3"}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: 4000000000 vertices are more than the 16777216 still "
            "allowed in this file; split the file");
}

TEST(GltfHostile, ManyVerticesOrIndicesOfNoBytes) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0] = {{"componentType", 5126}, {"count", 16000000u}, {"type", "VEC3"}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: 16000000 vertices have no bufferView; export the file again");
  glb = triangleGlb();
  glb.json["accessors"][2] = {{"componentType", 5125}, {"count", 65537u}, {"type", "SCALAR"}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: 65537 indices have no bufferView; export the file again");
}

TEST(GltfHostile, HugeIndexAccessorWithoutData) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][2] = {{"componentType", 5125}, {"count", 4000000000u}, {"type", "SCALAR"}};
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0: 4000000000 indices are more than the 100663296 still "
            "allowed in this file; split the file");
}

TEST(GltfHostile, AccessorKinds) {
  TestGlb glb = triangleGlb();
  glb.json["accessors"][0]["componentType"] = 5124;
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0/componentType: componentType 5124 does not exist; "
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
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0/sparse/indices: sparse index 1 is out of order or not below 3; "
            "export the file again");
  glb.json["accessors"][0]["sparse"]["count"] = 4;
  EXPECT_EQ(refusal(glb), "x.glb: /accessors/0/sparse/count: 4 is more than 3; export the file again");
  glb.json["accessors"][0]["sparse"]["count"] = 3;
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0/sparse/indices: 3 elements need 6 bytes from byte 0, "
            "bufferView 3 has 4; export the file again");
  glb.json["accessors"][0]["sparse"]["indices"]["componentType"] = 5126;
  EXPECT_EQ(refusal(glb),
            "x.glb: /accessors/0/sparse/indices: sparse indices must be unsigned integers; "
            "export the file again");
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
