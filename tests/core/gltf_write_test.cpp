// Round trips: what is written is read back as it was, with and without Draco.
#include <draco/compression/encode.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/check.h"
#include "core/gltf_file.h"
#include "core/image_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using testing::TestGlb;

const std::filesystem::path kPeople = "../shared/people";

std::vector<std::filesystem::path> peopleFiles() {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(kPeople)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kPeople)) {
    if (entry.path().extension() == ".glb") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void expectSameSkeleton(const RawSkeleton& a, const RawSkeleton& b) {
  ASSERT_EQ(a.bones.size(), b.bones.size());
  for (std::size_t i = 0; i < a.bones.size(); ++i) {
    EXPECT_EQ(a.bones[i].name, b.bones[i].name);
    EXPECT_EQ(a.bones[i].parent, b.bones[i].parent);
    EXPECT_EQ(a.bones[i].rest.translation, b.bones[i].rest.translation);
    EXPECT_EQ(a.bones[i].rest.rotation, b.bones[i].rest.rotation);
    EXPECT_EQ(a.bones[i].rest.scale, b.bones[i].rest.scale);
  }
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    EXPECT_EQ(a.joints[i].bone, b.joints[i].bone);
    EXPECT_EQ(a.joints[i].joint_from_model, b.joints[i].joint_from_model);
  }
}

void expectSameClips(const RawAsset& a, const RawAsset& b) {
  ASSERT_EQ(a.clips.size(), b.clips.size());
  for (std::size_t i = 0; i < a.clips.size(); ++i) {
    EXPECT_EQ(a.clips[i].name, b.clips[i].name);
    ASSERT_EQ(a.clips[i].channels.size(), b.clips[i].channels.size());
    for (std::size_t c = 0; c < a.clips[i].channels.size(); ++c) {
      const RawChannel &x = a.clips[i].channels[c], &y = b.clips[i].channels[c];
      EXPECT_EQ(x.bone, y.bone);
      EXPECT_EQ(x.path, y.path);
      EXPECT_EQ(x.interpolation, y.interpolation);
      EXPECT_EQ(x.times, y.times);
      EXPECT_EQ(x.values, y.values);
    }
  }
}

// Everything but the geometry.
void expectSameFrame(const RawAsset& a, const RawAsset& b) {
  expectSameSkeleton(a.skeleton, b.skeleton);
  expectSameClips(a, b);
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.images, b.images);
  EXPECT_EQ(a.copyright, b.copyright);
  EXPECT_EQ(a.extras_json, b.extras_json);
  EXPECT_EQ(a.scene_extras_json, b.scene_extras_json);
  EXPECT_TRUE(b.dropped.empty());
  EXPECT_TRUE(b.warnings.empty());
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    EXPECT_EQ(a.meshes[m].name, b.meshes[m].name);
    EXPECT_EQ(a.meshes[m].skinned, b.meshes[m].skinned);
    ASSERT_EQ(a.meshes[m].primitives.size(), b.meshes[m].primitives.size());
  }
}

void expectSame(const RawAsset& a, const RawAsset& b) {
  expectSameFrame(a, b);
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    EXPECT_TRUE(a.meshes[m].primitives == b.meshes[m].primitives) << a.meshes[m].name;
  }
}

// Draco keeps numbers, bindings and template vertices; positions move by at most half a step an axis.
void expectNear(const RawPrimitive& a, const RawPrimitive& b, const GlbWriteOptions& options) {
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.template_vertices, b.template_vertices);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  Vec3 min(1e30f), max(-1e30f);
  for (const RawVertex& v : a.vertices) {
    min = glm::min(min, v.position);
    max = glm::max(max, v.position);
  }
  const Vec3 size = max - min;
  const float range = std::max({size.x, size.y, size.z});
  const float step = range / static_cast<float>((1 << options.draco_position_bits) - 1);
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    const Vec3 difference = glm::abs(a.vertices[i].position - b.vertices[i].position);
    EXPECT_LE(std::max({difference.x, difference.y, difference.z}), 0.501f * step + 1e-6f);
    EXPECT_GT(glm::dot(a.vertices[i].normal, b.vertices[i].normal), 0.999f);
    EXPECT_NEAR(glm::length(b.vertices[i].normal), 1.0f, 1e-5f);
    EXPECT_EQ(a.vertices[i].skin, b.vertices[i].skin);
  }
}

void expectNear(const RawAsset& a, const RawAsset& b, const GlbWriteOptions& options) {
  expectSameFrame(a, b);
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    for (std::size_t p = 0; p < a.meshes[m].primitives.size(); ++p) {
      expectNear(a.meshes[m].primitives[p], b.meshes[m].primitives[p], options);
    }
  }
}

GltfReadOptions keepNumbers() {
  GltfReadOptions options;
  options.weld = false;
  return options;
}

// An asset that uses everything at once.
RawAsset makeAsset() {
  RawAsset asset;
  RawImage image;
  image.bytes = encodePng({1, 1, {10, 20, 30, 40}});
  image.name = "cloth";
  readImageHeader(image.bytes, "", "", image);
  asset.images = {image};
  asset.materials.push_back(
      {"skin", Vec4(0.1f, 0.2f, 0.3f, 1), std::nullopt, true, true, AlphaMode::kOpaque, 0.5f, false});
  asset.materials.push_back({"cloth", Vec4(1), 0u, false, true, AlphaMode::kMask, 0.3f, true});
  asset.skeleton.bones.push_back({"root", -1, {}});
  asset.skeleton.bones.push_back({"arm", 0, {{0.1f, 1, 0}, glm::angleAxis(0.3f, Vec3(0, 0, 1)), {1, 2, 1}}});
  asset.skeleton.bones.push_back({"leg", 0, {{0, -1, 0}, Quat(1, 0, 0, 0), Vec3(1)}});
  for (const std::uint32_t joint : {2u, 1u}) {
    asset.skeleton.joints.push_back({joint, glm::inverse(toMatrix(asset.skeleton.bones[joint].rest))});
  }
  RawPrimitive body;
  body.material = 0;
  for (int i = 0; i < 8; ++i) {
    RawVertex vertex;
    vertex.position =
        Vec3(static_cast<float>(i % 2), static_cast<float>(i / 2 % 2), 0.1f * static_cast<float>(i));
    vertex.normal = glm::normalize(Vec3(1, 0.1f * static_cast<float>(i), 0));
    vertex.uv = Vec2(0.125f * static_cast<float>(i), 1);
    vertex.skin = {{0, 1, 0, 0}, {0.75f, 0.25f, 0, 0}};
    body.vertices.push_back(vertex);
    body.template_vertices.push_back(static_cast<std::uint32_t>(100 - i));
  }
  body.faces = {{0, 1, 2}, {7, 6, 5}, {3, 4, 4}, {0, 1, 2}};
  RawPrimitive cloth = body;
  cloth.material = 1;
  cloth.template_vertices.clear();
  asset.meshes.push_back({"body", "", true, {body, cloth}});
  RawMeshNode prop{"prop", "", false, {cloth}};
  for (RawVertex& vertex : prop.primitives[0].vertices) vertex.skin = {};
  asset.meshes.push_back(prop);
  RawChannel walk;
  walk.bone = 1;
  walk.times = {0, 0.5f};
  walk.values = {Vec4(0, 0, 0, 1), Vec4(0, 0, 1, 0)};
  RawChannel spline = walk;
  spline.path = ChannelPath::kTranslation;
  spline.interpolation = Interpolation::kCubicSpline;
  spline.values.assign(6, Vec4(1, 2, 3, 0));
  asset.clips.push_back({"walk", {walk, spline}});
  asset.copyright = "CC0";
  asset.extras_json = R"({"ensemble":{"layer":1,"name":"Ä"}})";
  asset.scene_extras_json = "[1,2]";
  return asset;
}

TEST(GltfWrite, RoundTripOfEverything) {
  const RawAsset asset = makeAsset();
  expectSame(asset, readGlb(writeGlb(asset), "x.glb", keepNumbers()));
}

TEST(GltfWrite, SameAssetSameBytes) {
  const RawAsset asset = makeAsset();
  EXPECT_EQ(writeGlb(asset), writeGlb(asset));
  GlbWriteOptions draco;
  draco.draco = true;
  EXPECT_EQ(writeGlb(asset, draco), writeGlb(asset, draco));
  EXPECT_NE(writeGlb(asset), writeGlb(asset, draco));
}

TEST(GltfWrite, RoundTripThroughDraco) {
  GlbWriteOptions options;
  options.draco = true;
  const RawAsset asset = makeAsset();
  expectNear(asset, readGlb(writeGlb(asset, options), "x.glb", keepNumbers()), options);
}

TEST(GltfWrite, CollapsesComeBack) {
  for (const std::uint32_t count : {1000u, 65537u}) {  // 16-bit numbers, and wider ones
    RawAsset asset = makeAsset();
    RawPrimitive& primitive = asset.meshes[0].primitives[0];
    RawVertex vertex = primitive.vertices[0];
    primitive.vertices.clear();
    primitive.template_vertices.clear();
    primitive.faces.clear();
    for (std::uint32_t v = 0; v < count; ++v) {
      vertex.position = Vec3(static_cast<float>(v % 256), static_cast<float>(v / 256), 0.0f);
      primitive.vertices.push_back(vertex);
      primitive.collapses.push_back(v % 3 == 0 ? VertexCollapse{v, 0} : VertexCollapse{v - v % 3, 11});
      if (v > 1) primitive.faces.push_back({v - 2, v - 1, v});
    }
    primitive.collapses.back() = {count - 1, 4};
    for (const bool draco : {false, true}) {
      GlbWriteOptions options;
      options.draco = draco;
      const RawAsset back = readGlb(writeGlb(asset, options), "x.glb", keepNumbers());
      EXPECT_EQ(back.meshes[0].primitives[0].collapses, primitive.collapses) << count << ", Draco " << draco;
      EXPECT_TRUE(back.dropped.empty());
    }
  }
}

// Exporters compress what is painted on vertices, too. Written under another name: the writer paints nothing.
TEST(GltfWrite, PaintIsReadFromDraco) {
  RawAsset asset = makeAsset();
  std::vector<std::byte> bytes = [&] {
    GlbWriteOptions options;
    options.draco = true;
    return writeGlb(asset, options);
  }();
  const std::string written = "\"_TEMPLATE_VERTEX\"", read = "\"_HIDE\"           ";  // of one length
  auto* text = reinterpret_cast<char*>(bytes.data());
  int replaced = 0;
  for (std::size_t i = 0; i + written.size() <= bytes.size(); ++i) {
    if (std::string_view(text + i, written.size()) != written) continue;
    std::copy(read.begin(), read.end(), text + i);
    ++replaced;
  }
  ASSERT_GE(replaced, 2) << "among the attributes and in the extension";
  const RawAsset back = readGlb(bytes, "x.glb", keepNumbers());
  std::size_t painted = 0;
  for (std::size_t m = 0; m < back.meshes.size(); ++m) {
    for (std::size_t p = 0; p < back.meshes[m].primitives.size(); ++p) {
      const std::vector<std::uint32_t>& numbers = asset.meshes[m].primitives[p].template_vertices;
      EXPECT_THAT(back.meshes[m].primitives[p].hide,
                  ::testing::ElementsAreArray(std::vector<float>(numbers.begin(), numbers.end())));
      painted += numbers.size();
    }
  }
  EXPECT_GT(painted, 0u);
}

TEST(GltfWrite, DracoKeepsNumbersOfVerticesThatQuantisationMakesEqual) {
  RawAsset asset = makeAsset();
  for (RawVertex& vertex : asset.meshes[0].primitives[1].vertices) {
    vertex = asset.meshes[0].primitives[1].vertices[0];
    vertex.position.x += 1e-7f;
  }
  GlbWriteOptions options;
  options.draco = true;
  const RawAsset back = readGlb(writeGlb(asset, options), "x.glb", keepNumbers());
  EXPECT_EQ(back.meshes[0].primitives[1].vertices.size(), 8u);
  EXPECT_EQ(back.meshes[0].primitives[1].faces, asset.meshes[0].primitives[1].faces);
}

TEST(GltfWrite, LeavesOutWhatIsUnused) {
  RawAsset asset = makeAsset();
  asset.materials.insert(asset.materials.begin(), RawMaterial{});
  for (RawMeshNode& mesh : asset.meshes) {
    for (RawPrimitive& primitive : mesh.primitives) ++primitive.material;
  }
  asset.images.push_back(asset.images[0]);
  asset.meshes[0].primitives.push_back({});  // without faces
  asset.meshes.push_back({"empty", "", true, {}});
  asset.clips.push_back({"nothing", {}});
  expectSame(makeAsset(), readGlb(writeGlb(asset), "x.glb", keepNumbers()));
}

TEST(GltfWrite, WideIndicesAndManyJoints) {
  RawAsset asset = makeAsset();
  asset.meshes.pop_back();
  RawPrimitive& primitive = asset.meshes[0].primitives[1];
  while (primitive.vertices.size() < 65535) {
    primitive.vertices.push_back(primitive.vertices.back());
    primitive.vertices.back().position.z += 1.0f;
  }
  for (std::uint32_t i = 2; i < 300; ++i) {
    asset.skeleton.bones.push_back({"b" + std::to_string(i), 0, {}});
    asset.skeleton.joints.push_back({i + 1, Mat4(1.0f)});
  }
  primitive.vertices[3].skin = {{299, 0, 0, 0}, {1, 0, 0, 0}};
  primitive.faces.push_back({0, 1, 65534});
  // Bone 300's bind pose differs from the others' B, as in a file that was saved in a pose.
  expectSame(asset, readGlb(writeGlb(asset), "narrow.glb", keepNumbers()));
  primitive.vertices.push_back(primitive.vertices.back());
  primitive.vertices.back().position.z += 1.0f;
  primitive.faces.push_back({0, 1, 65535});
  expectSame(asset, readGlb(writeGlb(asset), "wide.glb", keepNumbers()));
}

TEST(GltfWrite, SeveralRootsGetOneAbove) {
  RawAsset asset = makeAsset();
  asset.skeleton.bones[2].parent = -1;
  const RawAsset back = readGlb(writeGlb(asset), "x.glb", keepNumbers());
  ASSERT_EQ(back.skeleton.bones.size(), 4u);
  EXPECT_EQ(back.skeleton.bones[0].name, "skeletons");
}

TEST(GltfWrite, NormalisesWeights) {
  RawAsset asset = makeAsset();
  asset.meshes[0].primitives[0].vertices[0].skin = {{1, 0, 0, 0}, {0.25f, 0.5f, 0, 0}};
  const RawAsset back = readGlb(writeGlb(asset), "x.glb", keepNumbers());
  const SkinBinding& skin = back.meshes[0].primitives[0].vertices[0].skin;
  EXPECT_THAT(skin.joints, ElementsAre(0, 1, 0, 0));
  EXPECT_EQ(skin.weights[0] + skin.weights[1], 1.0f);
}

TEST(GltfWrite, ChecksItsCaller) {
  RawAsset asset = makeAsset();
  asset.meshes[0].primitives[0].faces[0][0] = 8;
  EXPECT_THROW(writeGlb(asset), CheckError);
  asset = makeAsset();
  asset.meshes[0].primitives[0].material = 2;
  EXPECT_THROW(writeGlb(asset), CheckError);
  asset = makeAsset();
  asset.meshes[0].primitives[0].vertices[0].skin.joints[0] = 2;
  EXPECT_THROW(writeGlb(asset), CheckError);
  asset = makeAsset();
  asset.skeleton.joints.clear();
  EXPECT_THROW(writeGlb(asset), CheckError);
}

TEST(GltfWrite, PeopleRoundTrip) {
  const auto files = peopleFiles();
  if (files.empty()) GTEST_SKIP() << kPeople << " is not there: the real people are not tested";
  for (const auto& file : files) {
    SCOPED_TRACE(file.string());
    const RawAsset asset = readGltf(file);
    EXPECT_TRUE(asset.warnings.empty() && asset.dropped.empty());
    const std::vector<std::byte> bytes = writeGlb(asset);
    expectSame(asset, readGlb(bytes, "x.glb"));  // a welded asset is not changed by welding
    expectSame(asset, readGlb(bytes, "x.glb", keepNumbers()));
    EXPECT_EQ(writeGlb(readGlb(bytes, "x.glb")), bytes);
    GlbWriteOptions options;
    options.draco = true;
    options.draco_position_bits = 14;
    expectNear(asset, readGlb(writeGlb(asset, options), "x.glb", keepNumbers()), options);
  }
}

// Draco as others write it: edgebreaker, which renumbers, and quantised weights.

std::vector<std::byte> edgebreakerGrid(int* position_id, int* joint_id, int* weight_id) {
  constexpr std::uint32_t kSide = 9;
  draco::Mesh mesh;
  mesh.set_num_points(kSide * kSide);
  const auto add = [&mesh](draco::GeometryAttribute::Type type, draco::DataType data_type,
                           std::int8_t components, std::int64_t stride) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, components, data_type, false, stride, 0);
    return mesh.AddAttribute(attribute, true, kSide * kSide);
  };
  const int position = add(draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, 12);
  const int joint = add(draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 4, 4);
  const int weight = add(draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 4, 4);
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const float xyz[3] = {static_cast<float>(i % kSide), static_cast<float>(i / kSide), 0.0f};
    const std::uint8_t joints[4] = {0, 1, 0, 0}, weights[4] = {static_cast<std::uint8_t>(i), 100, 0, 0};
    mesh.attribute(position)->SetAttributeValue(draco::AttributeValueIndex(i), xyz);
    mesh.attribute(joint)->SetAttributeValue(draco::AttributeValueIndex(i), joints);
    mesh.attribute(weight)->SetAttributeValue(draco::AttributeValueIndex(i), weights);
  }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x;
      using P = draco::PointIndex;
      mesh.AddFace({P(a), P(a + 1), P(a + kSide)});
      mesh.AddFace({P(a + 1), P(a + kSide + 1), P(a + kSide)});
    }
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  *position_id = static_cast<int>(mesh.attribute(position)->unique_id());
  *joint_id = static_cast<int>(mesh.attribute(joint)->unique_id());
  *weight_id = static_cast<int>(mesh.attribute(weight)->unique_id());
  const auto* first = reinterpret_cast<const std::byte*>(buffer.data());
  return {first, first + buffer.size()};
}

TestGlb edgebreakerGlb() {
  TestGlb glb;
  int position = 0, joint = 0, weight = 0;
  const int view = glb.addView(edgebreakerGrid(&position, &joint, &weight));
  glb.add("accessors", {{"componentType", 5126}, {"count", 81}, {"type", "VEC3"}});
  glb.add("accessors", {{"componentType", 5121}, {"count", 81}, {"type", "VEC4"}});
  glb.add("accessors", {{"componentType", 5121}, {"count", 81}, {"type", "VEC4"}, {"normalized", true}});
  glb.add("accessors", {{"componentType", 5123}, {"count", 384}, {"type", "SCALAR"}});
  nlohmann::json primitive = {
      {"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}}},
      {"indices", 3},
      {"extensions",
       {{"KHR_draco_mesh_compression",
         {{"bufferView", view},
          {"attributes", {{"POSITION", position}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}}}}}}}};
  glb.add("meshes", {{"primitives", nlohmann::json::array({primitive})}});
  glb.add("nodes", {{"mesh", 0}, {"skin", 0}});
  glb.add("nodes", {{"name", "a"}});
  glb.add("nodes", {{"name", "b"}});
  glb.add("skins", {{"joints", {1, 2}}});
  glb.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return glb;
}

TEST(GltfDraco, ReadsEdgebreakerAndNormalizedWeights) {
  const RawAsset asset = readGlb(edgebreakerGlb().bytes(), "x.glb");
  const RawPrimitive& grid = asset.meshes.at(0).primitives.at(0);
  EXPECT_EQ(grid.faces.size(), 128u);
  ASSERT_EQ(grid.vertices.size(), 81u);
  double area = 0.0;
  for (const Triangle& face : grid.faces) {
    const Vec3 cross = glm::cross(grid.vertices[face[1]].position - grid.vertices[face[0]].position,
                                  grid.vertices[face[2]].position - grid.vertices[face[0]].position);
    EXPECT_GT(cross.z, 0.0f);
    area += 0.5 * static_cast<double>(cross.z);
  }
  EXPECT_NEAR(area, 64.0, 1e-2);
  for (const RawVertex& vertex : grid.vertices) {
    const auto number =
        static_cast<float>(std::lround(vertex.position.y) * 9 + std::lround(vertex.position.x));
    const float expected = std::max(number, 100.0f) / (number + 100.0f);
    EXPECT_NEAR(vertex.skin.weights[0], expected, 1e-5f);
  }
}

std::string refusal(const TestGlb& glb, const GltfReadOptions& options = {}) {
  try {
    readGlb(glb.bytes(), "x.glb", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kAt = "x.glb: /meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";

TEST(GltfDraco, RefusesWhatItDoesNotKnow) {
  const auto broken = [](std::size_t offset, std::uint8_t value) {
    TestGlb glb = edgebreakerGlb();
    glb.bin[offset] = static_cast<std::byte>(value);
    return refusal(glb);
  };
  EXPECT_EQ(broken(0, 'X'), kAt + ": the data are not Draco's; export the file again");
  EXPECT_EQ(broken(6, 1), kAt + ": Draco version 2.1 instead of 2.2; export the file again");
  EXPECT_EQ(broken(7, 0), kAt + ": the Draco data are no triangle mesh; export the file again");
  EXPECT_EQ(broken(8, 9), kAt + ": unknown Draco method 9; export the file again");
  EXPECT_EQ(broken(10, 0x80), kAt + ": Draco metadata are not supported; export without metadata");
  // The first number after the header and the traversal byte: how many vertices.
  EXPECT_EQ(broken(12, 0x7f),
            kAt +
                ": the Draco data announce 128 faces and 127 vertices, the accessors 128 and "
                "81; export the file again");
  TestGlb glb = edgebreakerGlb();
  glb.json["bufferViews"][0]["byteLength"] = 9;
  EXPECT_EQ(refusal(glb), kAt + ": the Draco data end in their header; export the file again");
  glb.json["bufferViews"][0]["byteLength"] = 60;
  EXPECT_EQ(refusal(glb), kAt + ": the Draco data are damaged; export the file again");
}

TEST(GltfDraco, RefusesCountsThatDisagree) {
  TestGlb glb = edgebreakerGlb();
  glb.json["accessors"][3]["count"] = 3;
  EXPECT_EQ(refusal(glb), kAt +
                              ": the Draco data announce 128 faces and 81 vertices, the accessors 1 and 81; "
                              "export the file again");
  glb = edgebreakerGlb();
  for (std::size_t i = 0; i < 3; ++i) glb.json["accessors"][i]["count"] = 90;
  EXPECT_EQ(refusal(glb), kAt + ": the Draco data hold 81 vertices, the accessors 90; export the file again");
  glb = edgebreakerGlb();
  glb.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
          ["POSITION"] = 77;
  EXPECT_EQ(refusal(glb), kAt +
                              "/attributes/POSITION: the Draco data have no attribute 77; "
                              "export the file again");
  glb = edgebreakerGlb();
  glb.json["accessors"][1]["count"] = 80;
  EXPECT_EQ(refusal(glb),
            "x.glb: /meshes/0/primitives/0/attributes/JOINTS_0: 80 JOINTS_0 for 81 positions; "
            "export the file again");
  GltfReadOptions options;
  options.max_faces = 100;
  EXPECT_EQ(refusal(edgebreakerGlb(), options),
            "x.glb: /meshes/0/primitives/0: 384 indices are more than the 300 "
            "still allowed in this file; split the file");
}

TEST(GltfDraco, SurvivesRandomDamage) {
  GlbWriteOptions sequential;
  sequential.draco = true;
  std::uint64_t state = 7;
  const auto random = [&state](std::uint64_t below) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (state >> 33) % below;
  };
  int refused = 0;
  const std::vector<std::vector<std::byte>> sound = {edgebreakerGlb().bytes(),
                                                     writeGlb(makeAsset(), sequential)};
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes = sound[static_cast<std::size_t>(round % 2)];
    // Only the binary chunk: the JSON has its own sweep.
    std::uint32_t json_bytes = 0;
    std::memcpy(&json_bytes, bytes.data() + 12, 4);
    const std::size_t start = 28 + json_bytes;
    for (int i = 0; i < 3; ++i)
      bytes[start + random(bytes.size() - start)] = static_cast<std::byte>(random(256));
    try {
      readGlb(bytes, "x.glb");
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace ensemble
