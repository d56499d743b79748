#include "renderer/posed_extents.h"

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

/// Vertices of a run of triangles, each once.
using Run = std::vector<std::uint32_t>;

std::vector<Run> runsOf(const IndexList& list, std::uint32_t triangles_per_run) {
  std::vector<Run> runs;
  const std::size_t step = std::size_t{3} * triangles_per_run;
  for (std::size_t first = 0; first < list.indices.size(); first += step) {
    const auto begin = list.indices.begin() + static_cast<std::ptrdiff_t>(first);
    const std::size_t count = std::min(step, list.indices.size() - first);
    Run& run = runs.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(count));
    std::sort(run.begin(), run.end());
    run.erase(std::unique(run.begin(), run.end()), run.end());
  }
  return runs;
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

PosedExtents posedExtents(const SubMeshLists& lists, const Animation& animation, std::uint32_t wardrobe,
                          std::uint32_t triangles_per_run) {
  const std::uint32_t first_clip = animation.first_clip[wardrobe];
  const auto end_clip = static_cast<std::uint32_t>(wardrobe + 1 < animation.first_clip.size()
                                                       ? animation.first_clip[wardrobe + 1]
                                                       : animation.clips.size());
  PosedExtents extents;
  const std::size_t clip_count = extents.clip_count = end_clip - first_clip;
  extents.longest_edges.resize(lists.meshes.size() * clip_count, 0.0f);
  const std::vector<std::vector<Edge>> edges = edgesOfMeshes(lists);
  std::vector<std::vector<Run>> runs;  // per index list
  std::vector<std::vector<std::size_t>> lists_of_mesh(lists.meshes.size());
  for (const IndexList& list : lists.index_lists) {
    lists_of_mesh[list.mesh.value].push_back(runs.size());
    runs.push_back(runsOf(list, triangles_per_run));
    extents.run_boxes.emplace_back(runs.back().size() * clip_count);
  }
  const auto measure = [&](std::size_t number, unsigned) {
    const std::size_t mesh = number / clip_count, clip_number = number % clip_count;
    const GpuClip& clip = animation.clips[first_clip + clip_number];
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
      for (const std::size_t list : lists_of_mesh[mesh]) {
        for (std::size_t run = 0; run < runs[list].size(); ++run) {
          Box& box = extents.run_boxes[list][run * clip_count + clip_number];
          for (const std::uint32_t v : runs[list][run]) box.add(posed[v]);
        }
      }
    }
    extents.longest_edges[number] = std::sqrt(most);
  };
  forEachOnThreads(threadCount(0), extents.longest_edges.size(), measure);
  return extents;
}

}  // namespace ensemble
