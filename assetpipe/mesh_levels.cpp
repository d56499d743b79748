#include "assetpipe/mesh_levels.h"

#include <algorithm>

#include "assetpipe/body_motion.h"
#include "assetpipe/collapse_order.h"
#include "core/collapse.h"

namespace ensemble {
namespace {

/// A garment's parts as one mesh, one part after the other.
CollapseMesh meshOf(const Garment& garment, std::span<const std::vector<Mat4>> poses) {
  std::vector<RawVertex> vertices;
  std::vector<Triangle> faces;
  for (const ItemPart& part : garment.parts) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& face : part.faces)
      faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  }
  return makeCollapseMesh(vertices, faces, poses);
}

/// The vertices that faces show, in their order; faces are renumbered.
void dropUnusedVertices(ItemPart& part) {
  std::vector<std::uint32_t> number(part.vertices.size(), kGone);
  for (const Triangle& face : part.faces) {
    for (const std::uint32_t corner : face) number[corner] = 0;
  }
  std::vector<RawVertex> left;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kGone) continue;
    number[v] = static_cast<std::uint32_t>(left.size());
    left.push_back(part.vertices[v]);
  }
  part.vertices = std::move(left);
  for (Triangle& face : part.faces) {
    for (std::uint32_t& corner : face) corner = number[corner];
  }
}

}  // namespace

void findLevels(TemplateBody& body) {
  const std::vector<std::vector<Mat4>> poses = matricesInClips(body);
  body.collapses = PerVertex<VertexCollapse>(
      findCollapseOrder(makeCollapseMesh(body.vertices.raw(), body.faces.raw(), poses), {}));
}

void findLevels(Garment& garment, std::span<const std::vector<Mat4>> poses) {
  const std::vector<VertexCollapse> order = findCollapseOrder(meshOf(garment, poses), {});
  std::uint32_t first = 0;
  for (ItemPart& part : garment.parts) {
    part.collapses.clear();
    for (std::uint32_t v = first; v < first + part.vertices.size(); ++v)
      part.collapses.push_back({order[v].target - first, order[v].level});
    first += static_cast<std::uint32_t>(part.vertices.size());
  }
}

std::uint32_t reduceFaces(Garment& garment, std::uint32_t most, std::span<const std::vector<Mat4>> poses) {
  const CollapseMesh mesh = meshOf(garment, poses);
  auto left = static_cast<std::uint32_t>(mesh.faces.size());
  if (left <= most) return left;
  // Small steps, so that little more goes than must.
  constexpr std::uint32_t kSteps = 64;
  const float share = 0.9f * static_cast<float>(most) / static_cast<float>(left);
  const std::vector<VertexCollapse> order =
      findCollapseOrder(mesh, {.levels = kSteps + 1, .coarsest_share = share});
  const auto position_of = [&](std::uint32_t vertex) { return mesh.position_of_vertex[vertex]; };
  std::vector<std::uint32_t> shown;
  for (std::uint32_t level = 1; level < levelCount(order) && left > most; ++level) {
    shown = verticesAtLevel(order, level);
    left = static_cast<std::uint32_t>(facesAtLevel(mesh.faces, shown, position_of).size());
  }
  if (shown.empty()) return left;  // nothing can go
  std::uint32_t first = 0;
  for (ItemPart& part : garment.parts) {
    for (Triangle& face : part.faces) face = {face[0] + first, face[1] + first, face[2] + first};
    part.faces = facesAtLevel(part.faces, shown, position_of);
    for (Triangle& face : part.faces) face = {face[0] - first, face[1] - first, face[2] - first};
    first += static_cast<std::uint32_t>(part.vertices.size());
    dropUnusedVertices(part);
    part.collapses.clear();
  }
  std::erase_if(garment.parts, [](const ItemPart& part) { return part.faces.empty(); });
  return left;
}

}  // namespace ensemble
