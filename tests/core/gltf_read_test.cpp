// What the glTF reader makes of the many ways to say the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/gltf_file.h"
#include "core/image_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using testing::skinnedGlb;
using testing::TestGlb;
using testing::triangleGlb;

RawAsset read(const TestGlb& glb, const GltfReadOptions& options = {}) {
  return readGlb(glb.bytes(), "x.glb", options);
}

RawPrimitive readTriangle(const TestGlb& glb) { return read(glb).meshes.at(0).primitives.at(0); }

nlohmann::json& primitive(TestGlb& glb) { return glb.json["meshes"][0]["primitives"][0]; }

std::vector<std::byte> smallPng() { return encodePng({2, 1, {255, 0, 0, 255, 0, 255, 0, 255}}); }

TEST(GltfRead, Triangle) {
  const RawAsset asset = read(triangleGlb());
  ASSERT_EQ(asset.meshes.size(), 1u);
  EXPECT_EQ(asset.meshes[0].name, "Tri");
  EXPECT_EQ(asset.meshes[0].json_pointer, "/nodes/0");
  EXPECT_FALSE(asset.meshes[0].skinned);
  const RawPrimitive& tri = asset.meshes[0].primitives.at(0);
  ASSERT_EQ(tri.vertices.size(), 3u);
  EXPECT_EQ(tri.vertices[2].position, Vec3(0, 2, 0));
  EXPECT_EQ(tri.vertices[2].normal, Vec3(0, 0, 1));
  EXPECT_THAT(tri.faces, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(asset.materials.at(tri.material).name, "default");
  EXPECT_TRUE(asset.dropped.empty());
  EXPECT_TRUE(asset.warnings.empty());
}

TEST(GltfRead, IndexWidths) {
  const RawPrimitive expected = readTriangle(triangleGlb());
  TestGlb glb = triangleGlb();
  primitive(glb)["indices"] = glb.addAccessor<std::uint8_t>({0, 1, 2}, "SCALAR");
  EXPECT_EQ(readTriangle(glb), expected);
  primitive(glb)["indices"] = glb.addAccessor<std::uint32_t>({0, 1, 2}, "SCALAR");
  EXPECT_EQ(readTriangle(glb), expected);
  primitive(glb).erase("indices");
  EXPECT_EQ(readTriangle(glb), expected);
}

TEST(GltfRead, StripsAndFans) {
  TestGlb glb;
  const int position = glb.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  nlohmann::json strip = {{"attributes", {{"POSITION", position}}}, {"mode", 5}};
  glb.add("meshes", {{"primitives", nlohmann::json::array({strip})}});
  glb.add("nodes", {{"mesh", 0}});
  EXPECT_THAT(readTriangle(glb).faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}, Triangle{2, 3, 4}));
  for (const RawVertex& vertex : readTriangle(glb).vertices) EXPECT_EQ(vertex.normal, Vec3(0, 0, 1));
  // A stitch (an index twice) makes no faces.
  primitive(glb)["indices"] = glb.addAccessor<std::uint16_t>({0, 1, 2, 2, 1, 3}, "SCALAR");
  EXPECT_EQ(readTriangle(glb).faces.size(), 2u);
  TestGlb fan = glb;
  primitive(fan)["mode"] = 6;
  primitive(fan)["indices"] = fan.addAccessor<std::uint16_t>({0, 1, 3, 2}, "SCALAR");
  EXPECT_THAT(readTriangle(fan).faces, ElementsAre(Triangle{1, 3, 0}, Triangle{3, 2, 0}));
}

TEST(GltfRead, PointsAndLinesAreDropped) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.meshes[0].primitives.size(), 1u);
  EXPECT_THAT(asset.dropped, ElementsAre("points and lines of node 'Tri'"));
}

TEST(GltfRead, InterleavedAccessors) {
  TestGlb glb = triangleGlb();
  const int view = glb.addView<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1});
  glb.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 24;
  for (const int attribute : {0, 1}) {
    glb.json["accessors"][static_cast<std::size_t>(attribute)]["bufferView"] = view;
    glb.json["accessors"][static_cast<std::size_t>(attribute)]["byteOffset"] = attribute * 12;
  }
  EXPECT_EQ(readTriangle(glb), readTriangle(triangleGlb()));
}

TEST(GltfRead, SparseAccessors) {
  TestGlb glb = triangleGlb();
  const int indices = glb.addView<std::uint8_t>({1, 2});
  const int values = glb.addView<float>({1, 0, 0, 0, 2, 0});
  // No bufferView: zeros, of which two are replaced.
  glb.json["accessors"][0] = {{"componentType", 5126},
                              {"count", 3},
                              {"type", "VEC3"},
                              {"sparse",
                               {{"count", 2},
                                {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                {"values", {{"bufferView", values}}}}}};
  EXPECT_EQ(readTriangle(glb), readTriangle(triangleGlb()));
}

TEST(GltfRead, QuantizedPositionsAndNormalizedNormals) {
  TestGlb glb = triangleGlb();
  glb.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  primitive(glb)["attributes"]["POSITION"] =
      glb.addAccessor<std::int16_t>({0, 0, 0, 100, 0, 0, 0, 200, 0}, "VEC3");
  const int normal = glb.addAccessor<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, -128}, "VEC3");
  glb.json["accessors"][static_cast<std::size_t>(normal)]["normalized"] = true;
  primitive(glb)["attributes"]["NORMAL"] = normal;
  glb.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
  const RawPrimitive tri = readTriangle(glb);
  EXPECT_NEAR(tri.vertices[2].position.y, 2.0f, 1e-6f);
  EXPECT_EQ(tri.vertices[0].normal, Vec3(0, 0, 1));
  EXPECT_EQ(tri.vertices[2].normal, Vec3(0, 0, -1));
}

TEST(GltfRead, NodeTransforms) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};  // +90 degrees about Z
  glb.json["nodes"][0]["scale"] = {1, 3, 1};
  glb.add("nodes", {{"children", {0}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1}}});
  glb.json["scenes"][0]["nodes"] = {1};
  const RawPrimitive tri = readTriangle(glb);
  EXPECT_NEAR(glm::distance(tri.vertices[1].position, Vec3(10, 2, 0)), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::distance(tri.vertices[2].position, Vec3(-2, 0, 0)), 0.0f, 1e-5f);
  EXPECT_NEAR(tri.vertices[0].normal.z, 1.0f, 1e-6f);
}

TEST(GltfRead, MirroredNodesTurnTheirFaces) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["scale"] = {-1, 1, 1};
  RawPrimitive tri = readTriangle(glb);
  EXPECT_EQ(tri.faces[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(tri.vertices[1].position, Vec3(-1, 0, 0));
  EXPECT_EQ(tri.vertices[0].normal, Vec3(0, 0, 1));
  // Normals made from the faces agree with the turned winding.
  primitive(glb)["attributes"].erase("NORMAL");
  tri = readTriangle(glb);
  EXPECT_EQ(tri.vertices[0].normal, Vec3(0, 0, 1));
}

TEST(GltfRead, NormalsAreMadeAndNormalized) {
  TestGlb glb = triangleGlb();
  primitive(glb)["attributes"]["NORMAL"] = glb.addAccessor<float>({0, 0, 0, 0, 3, 4, 0, 0, 1.0001f}, "VEC3");
  const RawPrimitive tri = readTriangle(glb);
  EXPECT_EQ(tri.vertices[0].normal, Vec3(0, 0, 1));
  EXPECT_EQ(tri.vertices[1].normal, Vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(tri.vertices[2].normal, Vec3(0, 0, 1.0001f));  // noise stays bit for bit
}

TEST(GltfRead, MadeNormalsAreWeightedByArea) {
  // A floor of area 2 and a wall of area 1 along one edge.
  TestGlb glb;
  const int position = glb.addAccessor<float>({0, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2}, "VEC3");
  nlohmann::json both = {{"attributes", {{"POSITION", position}}}};
  glb.add("meshes", {{"primitives", nlohmann::json::array({both})}});
  glb.add("nodes", {{"mesh", 0}});
  const RawPrimitive mesh = readTriangle(glb);
  ASSERT_EQ(mesh.vertices.size(), 4u);  // two corners coincide and weld
  const Vec3 expected = glm::normalize(Vec3(1, 2, 0));
  EXPECT_NEAR(glm::distance(mesh.vertices[0].normal, expected), 0.0f, 1e-6f);
  EXPECT_EQ(mesh.vertices[2].normal, Vec3(0, 1, 0));
}

TEST(GltfRead, WeldsInFileOrder) {
  TestGlb glb = triangleGlb();
  // Vertex 0 is unused, 1 and 3 are equal (0 == -0), 4 differs from 2 in its normal only.
  primitive(glb)["attributes"]["POSITION"] =
      glb.addAccessor<float>({7, 7, 7, 0, 0, 0, 1, 0, 0, -0.0f, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3");
  primitive(glb)["attributes"]["NORMAL"] =
      glb.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1}, "VEC3");
  primitive(glb)["indices"] = glb.addAccessor<std::uint16_t>({5, 3, 2, 1, 4, 5}, "SCALAR");
  RawPrimitive mesh = readTriangle(glb);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_THAT(mesh.faces, ElementsAre(Triangle{3, 0, 1}, Triangle{0, 2, 3}));
  EXPECT_EQ(mesh.vertices[0].position, Vec3(0));
  GltfReadOptions options;
  options.weld = false;
  mesh = read(glb, options).meshes[0].primitives[0];
  EXPECT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.faces[0], (Triangle{5, 3, 2}));
}

TEST(GltfRead, TemplateVerticesKeepVerticesApart) {
  TestGlb glb = triangleGlb();
  primitive(glb)["attributes"]["POSITION"] = glb.addAccessor<float>({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3");
  primitive(glb)["attributes"]["_TEMPLATE_VERTEX"] = glb.addAccessor<float>({4, 16777216, 6}, "SCALAR");
  const RawPrimitive tri = readTriangle(glb);
  EXPECT_THAT(tri.template_vertices, ElementsAre(4u, 16777216u, 6u));
  EXPECT_EQ(tri.vertices.size(), 3u);
}

TEST(GltfRead, PaintKeepsVerticesApart) {
  TestGlb glb = triangleGlb();
  primitive(glb)["attributes"]["POSITION"] = glb.addAccessor<float>({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3");
  primitive(glb)["attributes"]["_HIDE"] = glb.addAccessor<float>({1, -0.25f, 1}, "SCALAR");
  const RawPrimitive tri = readTriangle(glb);
  EXPECT_THAT(tri.hide, ElementsAre(1.0f, -0.25f, 1.0f));
  EXPECT_EQ(tri.vertices.size(), 3u);
  primitive(glb)["attributes"]["_HIDE"] = glb.addAccessor<float>({1, 1, 1}, "SCALAR");
  EXPECT_EQ(readTriangle(glb).vertices.size(), 2u);
}

TEST(GltfRead, PaintMayBeOfAnyComponentType) {
  TestGlb glb = triangleGlb();
  primitive(glb)["attributes"]["_HIDE"] = glb.addAccessor<std::uint8_t>({255, 0, 51}, "SCALAR");
  glb.json["accessors"].back()["normalized"] = true;
  EXPECT_THAT(readTriangle(glb).hide, ElementsAre(1.0f, 0.0f, 0.2f));
  primitive(glb)["attributes"]["_HIDE"] = glb.addAccessor<std::int8_t>({-1, 0, 1}, "SCALAR");
  const RawAsset asset = read(glb);
  EXPECT_THAT(asset.meshes[0].primitives[0].hide, ElementsAre(-1.0f, 0.0f, 1.0f));
  EXPECT_TRUE(asset.dropped.empty());
}

TEST(GltfRead, WedgesShareOneBinding) {
  TestGlb glb = skinnedGlb();
  auto& attributes = primitive(glb)["attributes"];
  attributes["POSITION"] = glb.addAccessor<float>({0, 0, 0, 0, 0, 0, 0, 2, 0}, "VEC3");
  attributes["NORMAL"] = glb.addAccessor<float>({0, 0, 1, 0, 1, 0, 0, 0, 1}, "VEC3");
  const RawAsset asset = read(glb);
  const auto& vertices = asset.meshes[0].primitives[0].vertices;
  ASSERT_EQ(vertices.size(), 3u);
  EXPECT_EQ(vertices[1].skin, vertices[0].skin);
  EXPECT_THAT(asset.warnings,
              ElementsAre("node 'Tri': 1 vertices lie where another is that has other weights; "
                          "they take over its weights"));
}

TEST(GltfRead, MoreThanFourInfluences) {
  TestGlb glb = skinnedGlb();
  for (int i = 0; i < 4; ++i) {
    const int node = glb.add("nodes", {{"name", "extra" + std::to_string(i)}});
    glb.json["skins"][0]["joints"].push_back(node);
    glb.json["scenes"][0]["nodes"].push_back(node);
  }
  glb.json["skins"][0].erase("inverseBindMatrices");
  glb.json["nodes"][1].erase("translation");
  glb.json["nodes"][2].erase("translation");
  auto& attributes = primitive(glb)["attributes"];
  attributes["JOINTS_0"] = glb.addAccessor<std::uint8_t>({0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 1, 0}, "VEC4");
  attributes["WEIGHTS_0"] =
      glb.addAccessor<float>({0.1f, 0.2f, 0.3f, 0.05f, 1, 0, 0, 0, 0.25f, 0.25f, 0.5f, 0}, "VEC4");
  attributes["JOINTS_1"] = glb.addAccessor<std::uint16_t>({4, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_1"] = glb.addAccessor<float>({0.25f, 0.1f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  const RawAsset asset = read(glb);
  const SkinBinding& skin = asset.meshes[0].primitives[0].vertices[0].skin;
  EXPECT_THAT(skin.joints, ElementsAre(2, 4, 1, 0));
  EXPECT_NEAR(skin.weights[0], 0.3f / 0.85f, 1e-6f);
  EXPECT_NEAR(skin.weights[3], 0.1f / 0.85f, 1e-6f);
  // One joint named twice counts once, with both weights.
  EXPECT_THAT(asset.meshes[0].primitives[0].vertices[2].skin.joints, ElementsAre(0, 1, 0, 0));
  EXPECT_THAT(asset.meshes[0].primitives[0].vertices[2].skin.weights, ElementsAre(0.5f, 0.5f, 0, 0));
  EXPECT_THAT(
      asset.warnings,
      ElementsAre("node 'Tri': 1 vertices have more than four influences; the four largest are kept"));
}

TEST(GltfRead, NormalizedWeightsSumToOne) {
  TestGlb glb = skinnedGlb();
  const int weights = glb.addAccessor<std::uint8_t>({255, 0, 0, 0, 200, 54, 0, 0, 85, 170, 0, 0}, "VEC4");
  glb.json["accessors"][static_cast<std::size_t>(weights)]["normalized"] = true;
  primitive(glb)["attributes"]["WEIGHTS_0"] = weights;
  primitive(glb)["attributes"]["JOINTS_0"] =
      glb.addAccessor<std::uint16_t>({0, 9, 9, 9, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  const auto vertices = readTriangle(glb).vertices;
  EXPECT_THAT(vertices[0].skin.joints, ElementsAre(0, 0, 0, 0));  // what has no weight names no joint
  EXPECT_NEAR(vertices[1].skin.weights[0], 200.0f / 254.0f, 1e-6f);
  EXPECT_EQ(vertices[1].skin.weights[0] + vertices[1].skin.weights[1], 1.0f);
  EXPECT_THAT(vertices[2].skin.joints, ElementsAre(1, 0, 0, 0));  // descending weights
}

TEST(GltfRead, MaterialsThatAreUsed) {
  TestGlb glb = triangleGlb();
  glb.add("materials", {{"name", "unused"}});
  glb.add("materials", {{"name", "skin"},
                        {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}},
                        {"alphaMode", "MASK"},
                        {"alphaCutoff", 0.25},
                        {"doubleSided", true}});
  primitive(glb)["material"] = 1;
  const RawAsset asset = read(glb);
  ASSERT_EQ(asset.materials.size(), 1u);
  const RawMaterial& material = asset.materials[asset.meshes[0].primitives[0].material];
  EXPECT_EQ(material.name, "skin");
  EXPECT_EQ(material.base_color, Vec4(0.5f, 0.25f, 1, 1));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.double_sided);
}

TEST(GltfRead, BlendBecomesMask) {
  TestGlb glb = triangleGlb();
  glb.add("materials", {{"name", "veil"}, {"alphaMode", "BLEND"}});
  primitive(glb)["material"] = 0;
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_THAT(asset.warnings, ElementsAre("material 'veil': BLEND is treated as MASK"));
}

TestGlb texturedGlb() {
  TestGlb glb = triangleGlb();
  const std::vector<std::byte> png = smallPng();
  glb.add("images", {{"name", "cloth"}, {"mimeType", "image/png"}, {"bufferView", glb.addView(png)}});
  glb.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}});
  glb.add("textures", {{"source", 0}, {"sampler", 0}});
  glb.add("materials", {{"name", "cloth"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = glb.addAccessor<float>({0, 0, 0, 0, 0, 0}, "VEC2");
  attributes["TEXCOORD_1"] = glb.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  return glb;
}

TEST(GltfRead, TextureAndItsCoordinates) {
  TestGlb glb = texturedGlb();
  glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  const RawAsset asset = read(glb);
  ASSERT_EQ(asset.images.size(), 1u);
  EXPECT_EQ(asset.images[0].name, "cloth");
  EXPECT_EQ(asset.images[0].mime_type, "image/png");
  EXPECT_EQ(asset.images[0].width, 2u);
  EXPECT_EQ(asset.images[0].bytes, smallPng());
  EXPECT_EQ(asset.materials[0].image, 0u);
  EXPECT_FALSE(asset.materials[0].repeat_u);
  EXPECT_TRUE(asset.materials[0].repeat_v);
  EXPECT_EQ(asset.meshes[0].primitives[0].vertices[1].uv, Vec2(1, 0));
}

TEST(GltfRead, TextureTransformIsBakedIn) {
  TestGlb glb = texturedGlb();
  auto& texture = glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"rotation", 1.5707963267948966}, {"scale", {2, 4}}, {"texCoord", 1}};
  const auto vertices = readTriangle(glb).vertices;
  // By the extension's formula: offset + rotation (counter-clockwise in v-down space) * scale * uv.
  EXPECT_NEAR(glm::distance(vertices[0].uv, Vec2(0.5f, 0.25f)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(vertices[1].uv, Vec2(0.5f, 0.25f - 2.0f)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(vertices[2].uv, Vec2(0.5f + 4.0f, 0.25f)), 0.0f, 1e-6f);
}

TEST(GltfRead, SpecularGlossinessGivesItsDiffuseColour) {
  TestGlb glb = triangleGlb();
  glb.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  glb.add(
      "materials",
      {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.1, 0.2, 0.3, 1}}}}}}});
  primitive(glb)["material"] = 0;
  EXPECT_EQ(read(glb).materials[0].base_color, Vec4(0.1f, 0.2f, 0.3f, 1));
  EXPECT_EQ(read(glb).materials[0].name, "material 0");
}

TEST(GltfRead, NamesWhatItDrops) {
  TestGlb glb = texturedGlb();
  glb.json["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_unlit"};
  glb.json["extensions"]["KHR_lights_punctual"] = {{"lights", nlohmann::json::array()}};
  glb.add("cameras", {{"type", "perspective"}});
  glb.json["materials"][0]["normalTexture"] = {{"index", 0}};
  glb.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
  auto& attributes = primitive(glb)["attributes"];
  attributes["COLOR_0"] = attributes["NORMAL"];
  attributes["TANGENT"] = attributes["NORMAL"];
  attributes["_SEW"] = attributes["NORMAL"];
  primitive(glb)["targets"] = {{{"POSITION", 0}}};
  glb.add("nodes", {{"name", "Backup"}, {"mesh", 0}});  // not in the scene
  EXPECT_THAT(read(glb).dropped,
              ElementsAre("normal maps", "metallic-roughness maps", "vertex colours of node 'Tri'",
                          "tangents", "attribute '_SEW'", "morph targets of node 'Tri'",
                          "node 'Backup', which is not in the default scene", "cameras", "lights",
                          "extension 'KHR_materials_sheen'"));
}

TEST(GltfRead, TextureOfAnUnknownFormatIsDropped) {
  TestGlb glb = texturedGlb();
  glb.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  const RawAsset asset = read(glb);
  EXPECT_FALSE(asset.materials[0].image.has_value());
  EXPECT_TRUE(asset.images.empty());
  EXPECT_THAT(asset.dropped, ElementsAre("the texture of material 'cloth', which is neither PNG nor JPEG"));
}

TEST(GltfRead, Texts) {
  TestGlb glb = triangleGlb();
  glb.json["asset"]["copyright"] = "CC0";
  glb.json["extras"] = {{"ensemble", {{"slot", "full"}}}};
  glb.json["scenes"][0]["extras"] = 7;
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.copyright, "CC0");
  EXPECT_EQ(asset.extras_json, R"({"ensemble":{"slot":"full"}})");
  EXPECT_EQ(asset.scene_extras_json, "7");
}

TEST(GltfRead, Clips) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 2, "STEP");
  const RawAsset asset = read(glb);
  ASSERT_EQ(asset.clips.size(), 1u);
  EXPECT_EQ(asset.clips[0].name, "turn");
  const RawChannel& channel = asset.clips[0].channels.at(0);
  EXPECT_EQ(asset.skeleton.bones[channel.bone].name, "knee");
  EXPECT_EQ(channel.interpolation, Interpolation::kStep);
  EXPECT_THAT(channel.times, ElementsAre(0.0f, 1.0f));
  EXPECT_EQ(channel.values[0], Vec4(0, 0, 0, 1));
}

TEST(GltfRead, ChannelsOfOtherNodesAreDropped) {
  TestGlb glb = skinnedGlb();
  testing::addTurn(glb, 0);
  const RawAsset asset = read(glb);
  EXPECT_TRUE(asset.clips.empty());
  EXPECT_THAT(asset.dropped, ElementsAre("animation of node 'Tri', which is no bone"));
}

TEST(GltfRead, ClipsWithoutASkinBringTheirBones) {
  TestGlb glb;
  glb.add("nodes", {{"name", "hip"}, {"children", {1}}});
  glb.add("nodes", {{"name", "knee"}});
  testing::addTurn(glb, 1);
  const RawAsset asset = read(glb);
  ASSERT_EQ(asset.skeleton.bones.size(), 2u);
  EXPECT_TRUE(asset.skeleton.joints.empty());
  EXPECT_EQ(asset.clips.at(0).channels.at(0).bone, 1u);
}

}  // namespace
}  // namespace ensemble
