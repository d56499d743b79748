#include "renderer/device_queues.h"

#include <fmt/format.h>

#include <algorithm>

namespace ensemble {
namespace {

/// Per combination, range after range: where its sub-meshes of that range begin in the list of all.
std::vector<std::uint32_t> rangesOf(const CrowdAssets& assets) {
  const std::uint32_t range_count = queueRanges(static_cast<std::uint32_t>(assets.items().size()));
  std::vector<std::uint32_t> ranges;
  std::uint32_t first = 0;
  for (const std::vector<SubMeshId>& sub_meshes : assets.shown()) {
    auto next = sub_meshes.begin();
    for (std::uint32_t range = 0; range < range_count; ++range) {
      const std::size_t begin = std::size_t{range} * ENSEMBLE_QUEUE_RANGE;
      next = std::find_if(next, sub_meshes.end(), [&](SubMeshId id) { return id.value >= begin; });
      ranges.push_back(first + static_cast<std::uint32_t>(next - sub_meshes.begin()));
    }
    first += static_cast<std::uint32_t>(sub_meshes.size());
  }
  ranges.push_back(first);
  return ranges;
}

std::vector<std::uint32_t> shownOf(const CrowdAssets& assets) {
  std::vector<std::uint32_t> shown;
  for (const std::vector<SubMeshId>& sub_meshes : assets.shown()) {
    for (const SubMeshId id : sub_meshes) shown.push_back(static_cast<std::uint32_t>(id.value));
  }
  return shown;
}

std::vector<DrawBatch> batchesOf(const CrowdAssets& assets) {
  std::vector<DrawBatch> batches;
  for (std::uint32_t i = 0; i < assets.items().size(); ++i) {
    const DrawState& state = assets.items()[i].state;
    if (batches.empty() || batches.back().state != state) batches.push_back({state, i, 0});
    ++batches.back().draw_count;
  }
  return batches;
}

std::vector<GpuQueueItem> itemsOf(const CrowdAssets& assets, std::span<const DrawBatch> batches) {
  std::vector<GpuQueueItem> items;
  for (std::uint32_t b = 0; b < batches.size(); ++b) {
    for (std::uint32_t i = 0; i < batches[b].draw_count; ++i) {
      const DrawItem& item = assets.items()[batches[b].first_draw + i];
      items.push_back({.index_count = item.index_count,
                       .first_index = item.first_index,
                       .vertex_offset = item.vertex_offset,
                       .batch = b,
                       .first_of_batch = batches[b].first_draw,
                       .draw = item.gpu});
    }
  }
  return items;
}

}  // namespace

QueueTables::QueueTables(gpu::Device& device, const CrowdAssets& assets) : batches(batchesOf(assets)) {
  const auto upload = [&](const auto& values, const char* what) {
    return gpu::uploadBuffer(device, std::as_bytes(std::span(values)),
                             vk::BufferUsageFlagBits::eStorageBuffer, what);
  };
  ranges = upload(rangesOf(assets), "the table of combinations");
  shown = upload(shownOf(assets), "the table of shown sub-meshes");
  items = upload(itemsOf(assets, batches), "the table of sub-meshes");
}

std::uint64_t QueueTables::bytesOf(const CrowdAssets& assets) {
  const std::uint64_t item_count = assets.items().size();
  std::uint64_t shown_count = 0;
  for (const std::vector<SubMeshId>& sub_meshes : assets.shown()) shown_count += sub_meshes.size();
  const std::uint64_t ranges =
      queueRanges(static_cast<std::uint32_t>(item_count)) * assets.shown().size() + 1;
  return std::max({ranges * sizeof(std::uint32_t), shown_count * sizeof(std::uint32_t),
                   item_count * sizeof(GpuQueueItem)});
}

DeviceQueues::DeviceQueues(gpu::Device& device, const QueueKernels& kernels, const QueueTables& tables,
                           const CrowdLayout& layout, const CrowdAssets& assets, const CrowdState& state,
                           std::span<const gpu::Buffer> verdicts, std::uint32_t verdict)
    : tables_(tables),
      assets_(assets),
      scan_(device, kernels, state, verdicts,
            {.kind = QueueKernels::Kind::kSubMeshes,
             .queue_count = static_cast<std::uint32_t>(assets.items().size()),
             .verdict = verdict}),
      chunks_(state.chunks().size()),
      sets_(layout.makeCrowdSets(device, static_cast<std::uint32_t>(chunks_.size()))) {
  using Usage = vk::BufferUsageFlagBits;
  const std::size_t item_count = assets.items().size();
  const auto make = [&](std::uint64_t bytes, vk::BufferUsageFlags usage, const std::string& what) {
    // A test reads them back.
    return gpu::Buffer(device, bytes, Usage::eStorageBuffer | Usage::eTransferSrc | usage,
                       gpu::Buffer::Kind::kDevice, what);
  };
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = chunks_[i];
    const CrowdChunk& people = state.chunks()[i];
    std::uint64_t entry_count = 0;
    for (const std::uint32_t combination : state.combinations().subspan(people.first, people.count))
      entry_count += assets.shown()[combination].size();
    chunk.entries = make(entry_count * sizeof(std::uint32_t), {},
                         fmt::format("the render queues of {} people", people.count));
    chunk.draws = make(item_count * sizeof(GpuDraw), {}, "the table of draws");
    chunk.commands = make(item_count * sizeof(GpuQueueCommand), Usage::eIndirectBuffer, "the indirect draws");
    chunk.draw_counts = make(tables.batches.size() * sizeof(std::uint32_t), Usage::eIndirectBuffer,
                             "the numbers of indirect draws");
    const vk::DescriptorSet built = scan_.set(i);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_RANGES, tables.ranges);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_SHOWN, tables.shown);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_ITEMS, tables.items);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_ENTRIES, chunk.entries);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_COMMANDS, chunk.commands);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_DRAWS, chunk.draws);
    gpu::writeBuffer(device, built, ENSEMBLE_BINDING_QUEUE_DRAW_COUNTS, chunk.draw_counts);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_CHARACTERS, people.characters);
    gpu::writeTexelBuffer(device, sets_[i], ENSEMBLE_BINDING_PALETTE, people.palette_view);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_QUEUE, chunk.entries);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_DRAWS, chunk.draws);
  }
}

DrawCounts DeviceQueues::counts() const {
  DrawCounts counts;
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const std::span<const GpuQueueTotal> totals = scan_.totals(i);
    for (std::size_t s = 0; s < totals.size(); ++s) {
      if (totals[s].count == 0) continue;
      ++counts.draw_calls;
      counts.triangles += std::uint64_t{totals[s].count} * (assets_.items()[s].index_count / 3);
    }
  }
  return counts;
}

}  // namespace ensemble
