#include "renderer/raster_items.h"

#include <algorithm>
#include <array>

#include "core/check.h"

namespace ensemble {
namespace {

/// The number of a value among those known; it becomes known.
template <class T>
std::uint32_t numberOf(std::vector<T>& known, const T& value) {
  const auto found = std::find(known.begin(), known.end(), value);
  const auto number = static_cast<std::uint32_t>(found - known.begin());
  if (found == known.end()) known.push_back(value);
  return number;
}

}  // namespace

RasterItems::RasterItems(gpu::Device& device, const CrowdAssets& assets, const PosePool& poses)
    : assets_(assets) {
  makeItems(device, poses);
  makeShown(device, poses);
}

std::uint32_t RasterItems::pairOf(const DrawItem& item) {
  return numberOf(pairs_, Pair{item.state.index_chunk, item.state.vertex_chunk});
}

void RasterItems::makeItems(gpu::Device& device, const PosePool& poses) {
  std::vector<GpuRasterItem> gpu;
  for (const DrawItem& item : assets_.items()) {
    const std::uint32_t pair = pairOf(item);
    const std::uint32_t bin = numberOf(bins_, Bin{pair, item.state.texture_set, item.state.textured});
    gpu.push_back({.first_index = item.first_index,
                   .first_vertex = static_cast<std::uint32_t>(item.vertex_offset),
                   .first_pose = poses.firstPose(item.mesh),
                   .bin = bin,
                   .material = item.gpu.material,
                   .region = item.gpu.region,
                   .first_face = item.gpu.first_face,
                   .face_offset = item.gpu.face_offset});
  }
  ENSEMBLE_CHECK(gpu.size() < (1u << ENSEMBLE_LISTED_ITEM_BITS));
  using Usage = vk::BufferUsageFlagBits;
  items_ = gpu::uploadBuffer(device, std::as_bytes(std::span(gpu)), Usage::eUniformTexelBuffer, "the items");
  items_view_ = items_.makeTexelView(device, vk::Format::eR32G32B32A32Uint);
}

std::vector<PlanItem> RasterItems::planItems(const CrowdExtents& extents, bool to_sun) {
  std::vector<PlanItem> items;
  for (const DrawItem& item : assets_.items()) {
    const std::uint32_t pair = pairOf(item);
    const State state{.pair = pair,
                      .cut_out = item.state.cut_out,
                      .hides_faces = to_sun && item.state.hides_faces,
                      .texture_set = item.state.cut_out ? item.state.texture_set : 0};
    items.push_back({.mesh = item.mesh,
                     .state = numberOf(states_, state),
                     .work = {.first_index = item.first_index,
                              .triangle_count = item.index_count / 3,
                              .pose = 0,
                              .first_entry = 0,
                              .entry_count = 0,
                              .is_double_sided = item.state.double_sided ? 1u : 0u,
                              .first_face = item.gpu.first_face,
                              .first_vertex = static_cast<std::uint32_t>(item.vertex_offset),
                              .material = item.gpu.material,
                              .batch = 0,
                              .first_box = extents.first_box[assets_.meshes()[item.mesh].wardrobe][item.list],
                              .first_picked = 0}});
  }
  return items;
}

void RasterItems::makeShown(gpu::Device& device, const PosePool& poses) {
  const auto combination_count = static_cast<std::uint32_t>(assets_.shown().size());
  std::vector<std::array<std::uint32_t, 4>> table(combination_count);
  for (std::uint32_t c = 0; c < combination_count; ++c) {
    std::vector<ShownItem>&shown = shown_.emplace_back(), &casting = casting_.emplace_back();
    std::uint32_t face = 0;
    const auto first = static_cast<std::uint32_t>(table.size());
    for (const SubMeshId id : assets_.shown()[c]) {
      const DrawItem& item = assets_.items()[id.value];
      if (item.index_count == 0) continue;
      shown.push_back({id.value, face});
      if (item.gpu.is_covered == 0) casting.push_back({id.value, face});
      table.push_back({id.value, face, poses.firstOwnVertex(c, item.mesh), 0});
      face += item.index_count / 3;
    }
    table[c] = {first, static_cast<std::uint32_t>(shown.size()), 0, 0};
  }
  shown_buffer_ = gpu::uploadBuffer(device, std::as_bytes(std::span(table)),
                                    vk::BufferUsageFlagBits::eUniformTexelBuffer, "what combinations show");
  shown_view_ = shown_buffer_.makeTexelView(device, vk::Format::eR32G32B32A32Uint);
}

}  // namespace ensemble
