#include "core/environment_mesh.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/gltf_file.h"
#include "core/input_error.h"
#include "core/sub_mesh_lists.h"

namespace ensemble {
namespace {

constexpr std::size_t kPieceFaces = 8192;  // Their corners have 16-bit numbers whatever they are.
constexpr std::uint32_t kNone = ~0u;
constexpr float kFarthest = 1e6f;  // metres, as positions in a scene

GpuStaticVertex packStatic(const RawVertex& vertex) {
  const GpuVertex packed = packVertex(vertex);
  GpuStaticVertex result{};
  std::copy(std::begin(packed.position), std::end(packed.position), result.position);
  std::copy(std::begin(packed.normal_oct), std::end(packed.normal_oct), result.normal_oct);
  std::copy(std::begin(packed.uv), std::end(packed.uv), result.uv);
  return result;
}

Vec3 positionOf(const GpuStaticVertex& vertex) {
  return {vertex.position[0], vertex.position[1], vertex.position[2]};
}

/// All faces of one material.
struct Soup {
  std::vector<GpuStaticVertex> vertices;
  std::vector<std::uint32_t> indices;
};

void checkReach(const RawMeshNode& node, const std::string& file) {
  for (const RawPrimitive& primitive : node.primitives) {
    for (const RawVertex& vertex : primitive.vertices) {
      const Vec3 size = glm::abs(vertex.position);
      if (std::max({size.x, size.y, size.z}) <= kFarthest) continue;
      throw InputError({file, node.json_pointer,
                        fmt::format("a vertex of the node is more than {:.0f} metres from the origin",
                                    static_cast<double>(kFarthest)),
                        "scale the set to metres and export it again"});
    }
  }
}

/// Empties the asset's meshes on the way: a set may be large.
std::vector<Soup> collectByMaterial(RawAsset& asset) {
  std::vector<Soup> soups(asset.materials.size());
  for (RawMeshNode& node : asset.meshes) {
    for (RawPrimitive& primitive : node.primitives) {
      Soup& soup = soups[primitive.material];
      const auto first = static_cast<std::uint32_t>(soup.vertices.size());
      for (const RawVertex& vertex : primitive.vertices) soup.vertices.push_back(packStatic(vertex));
      for (const Triangle& face : primitive.faces) {
        for (const std::uint32_t corner : face) soup.indices.push_back(first + corner);
      }
      primitive = {};
    }
  }
  return soups;
}

void weldSoup(Soup& soup) {
  std::vector<std::uint32_t> number(soup.vertices.size());
  const std::size_t count =
      meshopt_generateVertexRemap(number.data(), soup.indices.data(), soup.indices.size(),
                                  soup.vertices.data(), soup.vertices.size(), sizeof(GpuStaticVertex));
  for (std::uint32_t& index : soup.indices) index = number[index];
  std::vector<GpuStaticVertex> welded(count);
  meshopt_remapVertexBuffer(welded.data(), soup.vertices.data(), soup.vertices.size(),
                            sizeof(GpuStaticVertex), number.data());
  soup.vertices = std::move(welded);
}

void sortByPlace(Soup& soup) {
  std::vector<std::uint32_t> sorted(soup.indices.size());
  meshopt_spatialSortTriangles(sorted.data(), soup.indices.data(), soup.indices.size(),
                               soup.vertices.front().position, soup.vertices.size(), sizeof(GpuStaticVertex));
  soup.indices = std::move(sorted);
}

/// @param numbers per vertex of the soup a word of scratch, all of them kNone before and after
EnvironmentPiece cutPiece(const Soup& soup, std::span<const std::uint32_t> indices,
                          std::vector<std::uint32_t>& numbers) {
  EnvironmentPiece piece;
  std::vector<GpuStaticVertex> vertices;
  std::vector<std::uint32_t> local;
  local.reserve(indices.size());
  for (const std::uint32_t index : indices) {
    if (numbers[index] == kNone) {
      numbers[index] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(soup.vertices[index]);
      piece.bounds.add(positionOf(vertices.back()));
    }
    local.push_back(numbers[index]);
  }
  for (const std::uint32_t index : indices) numbers[index] = kNone;
  meshopt_optimizeVertexCache(local.data(), local.data(), local.size(), vertices.size());
  piece.vertices.resize(vertices.size());
  meshopt_optimizeVertexFetch(piece.vertices.data(), local.data(), local.size(), vertices.data(),
                              vertices.size(), sizeof(GpuStaticVertex));
  piece.indices.assign(local.begin(), local.end());
  return piece;
}

void cutIntoPieces(Soup soup, std::uint32_t material, EnvironmentMesh& mesh) {
  if (soup.indices.empty()) return;
  weldSoup(soup);
  if (soup.indices.size() > 3 * kPieceFaces) sortByPlace(soup);
  std::vector<std::uint32_t> numbers(soup.vertices.size(), kNone);
  for (std::size_t at = 0; at < soup.indices.size(); at += 3 * kPieceFaces) {
    const std::size_t count = std::min(3 * kPieceFaces, soup.indices.size() - at);
    mesh.pieces.push_back(cutPiece(soup, std::span(soup.indices).subspan(at, count), numbers));
    mesh.pieces.back().material = material;
    mesh.bounds.add(mesh.pieces.back().bounds.low);
    mesh.bounds.add(mesh.pieces.back().bounds.high);
  }
}

}  // namespace

EnvironmentMesh buildEnvironmentMesh(RawAsset asset, const std::string& file) {
  EnvironmentMesh mesh;
  mesh.file = file;
  mesh.dropped = asset.dropped;
  mesh.warnings = asset.warnings;
  if (!asset.skeleton.joints.empty()) mesh.dropped.emplace_back("skins");
  if (!asset.clips.empty()) mesh.dropped.emplace_back("animations");
  for (const RawMeshNode& node : asset.meshes) checkReach(node, file);
  std::vector<Soup> soups = collectByMaterial(asset);
  for (std::uint32_t m = 0; m < soups.size(); ++m) cutIntoPieces(std::move(soups[m]), m, mesh);
  if (mesh.pieces.empty()) {
    throw InputError(
        {file, "", "the environment has no triangles", "export its meshes in the default scene"});
  }
  mesh.materials = std::move(asset.materials);
  mesh.images = std::move(asset.images);
  return mesh;
}

EnvironmentMesh loadEnvironmentMesh(const Scene& scene) {
  const std::string file = scene.environment.value.string();
  try {
    // Vertices are welded here, when they have been packed: that is quicker.
    return buildEnvironmentMesh(readGltf(file, {.weld = false}), file);
  } catch (const InputError& error) {
    if (!error.text().where.empty()) throw;  // A place in the glTF file says more.
    throw InputError({scene.file.string(), scene.environment.mark.toString(),
                      fmt::format("the environment {}: {}", file, error.text().what), error.text().mend});
  }
}

}  // namespace ensemble
