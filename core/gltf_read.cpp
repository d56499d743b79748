#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/gltf_accessor.h"
#include "core/gltf_clip.h"
#include "core/gltf_document.h"
#include "core/gltf_file.h"
#include "core/gltf_material.h"
#include "core/gltf_mesh.h"
#include "core/gltf_nodes.h"
#include "core/gltf_skeleton.h"
#include "core/gltf_weld.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

// Extensions that are honoured, or whose loss is told in plainer words.
const std::set<std::string> kKnownExtensions = {
    "KHR_draco_mesh_compression", "KHR_lights_punctual",   "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",        "KHR_mesh_quantization", "KHR_texture_transform"};

void noteDropped(const GltfDocument& document, DroppedList& dropped) {
  if (document.count("cameras") > 0) dropped.add("cameras");
  if (const auto extensions = document.root().find("extensions")) {
    if (extensions->has("KHR_lights_punctual")) dropped.add("lights");
  }
  for (std::size_t i = 0; i < document.count("extensionsUsed"); ++i) {
    const std::string& name = document.item("extensionsUsed", i).string();
    if (!kKnownExtensions.contains(name)) dropped.add(fmt::format("extension '{}'", name));
  }
}

std::string extrasOf(const JsonRef& owner) {
  const auto extras = owner.find("extras");
  return extras ? extras->json().dump() : std::string();
}

void readTexts(const GltfDocument& document, RawAsset& asset) {
  asset.copyright = document.root().require("asset").stringOr("copyright", "");
  asset.extras_json = extrasOf(document.root());
  if (document.count("scenes") == 0) return;
  const auto scene = document.findIndex(document.root(), "scene", "scenes");
  asset.scene_extras_json = extrasOf(document.item("scenes", scene.value_or(0)));
}

void checkFinite(const GltfDocument& document, std::uint32_t node, const RawMeshNode& mesh) {
  for (const RawPrimitive& primitive : mesh.primitives) {
    for (const RawVertex& vertex : primitive.vertices) {
      if (!std::isfinite(glm::dot(vertex.position, Vec3(1.0f))) ||
          !std::isfinite(vertex.uv.x + vertex.uv.y)) {
        document.item("nodes", node).fail("a vertex of the node is too far away to be a number");
      }
    }
  }
}

void weldMesh(RawMeshNode& mesh, std::vector<std::string>& warnings) {
  const std::size_t different = unifyWedges(mesh);
  if (different > 0) {
    warnings.push_back(
        fmt::format("node '{}': {} vertices lie where another is that has other weights; they "
                    "take over its weights",
                    mesh.name, different));
  }
  for (RawPrimitive& primitive : mesh.primitives) weld(primitive);
}

RawAsset readDocument(const GltfDocument& document) {
  checkAccessors(document);
  RawAsset asset;
  DroppedList dropped;
  const GltfNodes tree = readNodes(document);
  std::vector<GltfSkin> skins = readSkins(document, tree);
  const std::vector<GltfMaterial> materials = readMaterials(document, dropped, asset.warnings);
  MeshReading reading{document,
                      tree,
                      materials,
                      skins,
                      dropped,
                      asset.warnings,
                      document.options().max_vertices,
                      document.options().max_faces};
  std::vector<std::uint32_t> mesh_nodes;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    if (!tree.nodes[i].mesh) continue;
    if (!tree.nodes[i].in_scene) {
      dropped.add(fmt::format("node '{}', which is not in the default scene", tree.nodes[i].label(i)));
      continue;
    }
    RawMeshNode mesh = reading.readMeshNode(i);
    if (mesh.primitives.empty()) {
      dropped.add(fmt::format("node '{}', which has no triangles", mesh.name));
      continue;
    }
    mesh_nodes.push_back(i);
    asset.meshes.push_back(std::move(mesh));
  }
  const GltfSkeleton skeleton = joinSkins(document, tree, std::move(skins), asset.warnings);
  for (std::size_t m = 0; m < asset.meshes.size(); ++m) {
    moveToModelSpace(skeleton, tree, mesh_nodes[m], asset.meshes[m]);
    checkFinite(document, mesh_nodes[m], asset.meshes[m]);
    settleNormals(asset.meshes[m]);
    if (document.options().weld) weldMesh(asset.meshes[m], asset.warnings);
  }
  asset.skeleton = skeleton.skeleton;
  asset.clips = readClips(document, skeleton, tree, dropped);
  addUsedMaterials(document, materials, asset);
  readTexts(document, asset);
  noteDropped(document, dropped);
  asset.dropped = dropped.list();
  return asset;
}

bool isGlb(std::span<const std::byte> bytes) {
  constexpr std::array magic{std::byte{'g'}, std::byte{'l'}, std::byte{'T'}, std::byte{'F'}};
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

}  // namespace

RawAsset readGltf(const std::filesystem::path& file, const GltfReadOptions& options) {
  const std::vector<std::byte> bytes = readFile(file, options.max_file_bytes);
  const std::filesystem::path folder = file.parent_path();
  if (bytes.empty()) throw InputError({file.string(), "", "the file is empty", kExportAgain});
  if (isGlb(bytes)) return readDocument(GltfDocument::fromGlb(bytes, file.string(), folder, options));
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
  if (text.find('{') == std::string_view::npos) {
    throw InputError({file.string(), "", "this is neither a GLB nor a .gltf", "export as glTF 2.0"});
  }
  return readDocument(GltfDocument::fromText(text, file.string(), folder, options));
}

RawAsset readGlb(std::span<const std::byte> bytes, const std::string& name, const GltfReadOptions& options) {
  return readDocument(GltfDocument::fromGlb(bytes, name, std::nullopt, options));
}

}  // namespace ensemble
