// tinygltf as an independent reader: what we read is what it reads, bit for bit, and it accepts what
// we write. (It is no parser for hostile files, so the program itself does without it; see
// core/gltf_document.h.)
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <filesystem>

#include "core/atomic_file.h"
#include "core/gltf_file.h"

namespace ensemble {
namespace {

const std::filesystem::path kPeople = "../shared/people";

tinygltf::Model readByTinygltf(const std::vector<std::byte>& bytes) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  EXPECT_TRUE(loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          static_cast<unsigned int>(bytes.size())))
      << error;
  return model;
}

// Element `index` of an accessor of floats, as a plain consumer would fetch it.
std::vector<float> fetch(const tinygltf::Model& model, int accessor_index, std::size_t index) {
  const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_index)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  const auto stride = static_cast<std::size_t>(accessor.ByteStride(view));
  const unsigned char* data = model.buffers[static_cast<std::size_t>(view.buffer)].data.data() +
                              view.byteOffset + accessor.byteOffset + index * stride;
  std::vector<float> values(
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type))));
  std::memcpy(values.data(), data, values.size() * sizeof(float));
  return values;
}

std::uint32_t fetchIndex(const tinygltf::Model& model, int accessor_index, std::size_t index) {
  const auto& accessor = model.accessors[static_cast<std::size_t>(accessor_index)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
  EXPECT_EQ(accessor.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  std::uint16_t value = 0;
  std::memcpy(&value,
              model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
                  accessor.byteOffset + index * 2,
              2);
  return value;
}

// Every corner of every face has the position, normal and UV that the file gives it.
void expectSameCorners(const tinygltf::Model& model, const tinygltf::Primitive& theirs,
                       const RawPrimitive& ours) {
  const std::size_t corners = model.accessors[static_cast<std::size_t>(theirs.indices)].count;
  ASSERT_EQ(ours.faces.size() * 3, corners);
  std::size_t different = 0;
  for (std::size_t corner = 0; corner < corners; ++corner) {
    const RawVertex& vertex = ours.vertices[ours.faces[corner / 3][corner % 3]];
    const std::uint32_t index = fetchIndex(model, theirs.indices, corner);
    const auto position = fetch(model, theirs.attributes.at("POSITION"), index);
    const auto normal = fetch(model, theirs.attributes.at("NORMAL"), index);
    const auto uv = fetch(model, theirs.attributes.at("TEXCOORD_0"), index);
    if (vertex.position != Vec3(position[0], position[1], position[2]) ||
        vertex.normal != Vec3(normal[0], normal[1], normal[2]) || vertex.uv != Vec2(uv[0], uv[1])) {
      ++different;
    }
  }
  EXPECT_EQ(different, 0u);
}

void expectSameMeshes(const tinygltf::Model& model, const RawAsset& asset) {
  std::size_t mesh_number = 0;
  for (const auto& node : model.nodes) {
    if (node.mesh < 0) continue;
    ASSERT_LT(mesh_number, asset.meshes.size());
    const RawMeshNode& ours = asset.meshes[mesh_number++];
    const auto& theirs = model.meshes[static_cast<std::size_t>(node.mesh)];
    EXPECT_EQ(ours.name, node.name);
    ASSERT_EQ(ours.primitives.size(), theirs.primitives.size());
    for (std::size_t p = 0; p < ours.primitives.size(); ++p) {
      expectSameCorners(model, theirs.primitives[p], ours.primitives[p]);
      EXPECT_EQ(asset.materials[ours.primitives[p].material].name,
                model.materials[static_cast<std::size_t>(theirs.primitives[p].material)].name);
    }
  }
  EXPECT_EQ(mesh_number, asset.meshes.size());
}

TEST(GltfOracle, PeopleAsTinygltfReadsThem) {
  if (!std::filesystem::exists(kPeople))
    GTEST_SKIP() << kPeople << " is not there: the real people are not tested";
  for (const char* name : {"female/template.glb", "male/template.glb", "male/outfits/casualsuit03_fedora.glb",
                           "female/unfitted/sportsuit01.glb"}) {
    SCOPED_TRACE(name);
    const std::vector<std::byte> bytes = readFile(kPeople / name);
    const RawAsset asset = readGlb(bytes, name);
    expectSameMeshes(readByTinygltf(bytes), asset);
    // And the other way round: it reads what we write as we do.
    const tinygltf::Model rewritten = readByTinygltf(writeGlb(asset));
    expectSameMeshes(rewritten, asset);
    ASSERT_EQ(rewritten.skins.size(), 1u);
    EXPECT_EQ(rewritten.skins[0].joints.size(), asset.skeleton.joints.size());
    EXPECT_EQ(rewritten.animations.size(), asset.clips.size());
  }
}

}  // namespace
}  // namespace ensemble
