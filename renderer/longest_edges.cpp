#include "renderer/longest_edges.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/parallel.h"
#include "shaders/shared/vertex.h"

namespace ensemble {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<std::vector<Edge>> edgesOfMeshes(const SubMeshLists& lists) {
  std::vector<std::vector<Edge>> edges(lists.meshes.size());
  for (const IndexList& list : lists.index_lists) {
    std::vector<Edge>& own = edges[list.mesh.value];
    for (std::size_t i = 0; i < list.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k)
        own.push_back(std::minmax({list.indices[i + k], list.indices[i + (k + 1) % 3]}));
    }
  }
  for (std::vector<Edge>& own : edges) {
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
  return edges;
}

/// As the device blends them. @param matrices three rows a joint
Vec3 posedPosition(const GpuVertex& vertex, std::span<const vec4> matrices) {
  const Vec4 position(vertex.position[0], vertex.position[1], vertex.position[2], 1.0f);
  Vec3 posed(0.0f);
  float sum = 0.0f;
  for (std::size_t i = 0; i < 4; ++i) {
    if (vertex.weights[i] == 0) continue;
    const float weight = static_cast<float>(vertex.weights[i]) / 65535.0f;
    const vec4* rows = matrices.data() + std::size_t{3} * vertex.joints[i];
    posed +=
        weight * Vec3(glm::dot(rows[0], position), glm::dot(rows[1], position), glm::dot(rows[2], position));
    sum += weight;
  }
  return sum > 0.0f ? posed : Vec3(position);
}

}  // namespace

std::vector<float> longestEdges(const SubMeshLists& lists, const Animation& animation,
                                std::uint32_t wardrobe) {
  const std::uint32_t first_clip = animation.first_clip[wardrobe];
  const auto end_clip = static_cast<std::uint32_t>(wardrobe + 1 < animation.first_clip.size()
                                                       ? animation.first_clip[wardrobe + 1]
                                                       : animation.clips.size());
  const std::size_t clip_count = end_clip - first_clip;
  const std::vector<std::vector<Edge>> edges = edgesOfMeshes(lists);
  std::vector<float> longest(lists.meshes.size() * clip_count, 0.0f);
  const auto measure = [&](std::size_t number, unsigned) {
    const std::size_t mesh = number / clip_count;
    const GpuClip& clip = animation.clips[first_clip + number % clip_count];
    const std::vector<GpuVertex>& vertices = lists.meshes[MeshId(mesh)].vertices;
    std::vector<Vec3> posed(vertices.size());
    float most = 0.0f;
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      const std::span<const vec4> matrices =
          std::span(animation.texels)
              .subspan(std::size_t{3} * (clip.first_matrix + key * clip.joint_count),
                       std::size_t{3} * clip.joint_count);
      for (std::size_t v = 0; v < vertices.size(); ++v) posed[v] = posedPosition(vertices[v], matrices);
      for (const auto& [a, b] : edges[mesh]) {
        const Vec3 edge = posed[a] - posed[b];
        most = std::max(most, glm::dot(edge, edge));
      }
    }
    longest[number] = std::sqrt(most);
  };
  forEachOnThreads(threadCount(0), longest.size(), measure);
  return longest;
}

}  // namespace ensemble
