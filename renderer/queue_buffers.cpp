// Lister, Laycock, Day, section 4: a queue of character numbers for each sub-mesh, one instanced
// draw each. The paper uploads queue after queue; here all lie in one buffer and an instance's
// number counts on from where its queue begins.
#include "renderer/queue_buffers.h"

#include <fmt/format.h>

#include <algorithm>

namespace ensemble {

QueueBuffers::QueueBuffers(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets,
                           const CrowdState& state)
    : chunks_(state.chunks().size()) {
  using Usage = vk::BufferUsageFlagBits;
  constexpr auto kind = gpu::Buffer::Kind::kUpload;
  const std::size_t item_count = assets.items().size();
  sets_ = layout.makeCrowdSets(device, static_cast<std::uint32_t>(chunks_.size()));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = chunks_[i];
    const CrowdChunk& people = state.chunks()[i];
    std::uint64_t entry_count = 0;
    for (const std::uint32_t combination : state.combinations().subspan(people.first, people.count)) {
      entry_count += assets.shown()[combination].size();
    }
    chunk.entries = gpu::Buffer(device, entry_count * sizeof(std::uint32_t), Usage::eStorageBuffer, kind,
                                fmt::format("the render queues of {} people", people.count));
    chunk.draws =
        gpu::Buffer(device, item_count * sizeof(GpuDraw), Usage::eStorageBuffer, kind, "the table of draws");
    chunk.commands = gpu::Buffer(device, item_count * sizeof(vk::DrawIndexedIndirectCommand),
                                 Usage::eIndirectBuffer, kind, "the indirect draws");
    chunk.queues.setShown(assets.shown(), item_count);
    chunk.visible.reserve(people.count);
    chunk.batches.reserve(item_count);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_CHARACTERS, people.characters);
    gpu::writeTexelBuffer(device, sets_[i], ENSEMBLE_BINDING_PALETTE, people.palette_view);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_QUEUE, chunk.entries);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_DRAWS, chunk.draws);
  }
}

void QueueBuffers::build(const CrowdAssets& assets, const CrowdState& state,
                         std::span<const std::uint32_t> visible) {
  counts_ = {};
  auto next = visible.begin();
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = chunks_[i];
    const CrowdChunk& people = state.chunks()[i];
    chunk.visible.clear();
    for (; next != visible.end() && *next < people.first + people.count; ++next) {
      chunk.visible.push_back(*next - people.first);
    }
    const auto combinations = state.combinations().subspan(people.first, people.count);
    chunk.queues.count(combinations, chunk.visible);
    chunk.queues.fill(chunk.entries.mapped<std::uint32_t>().first(chunk.queues.entryCount()));
    buildDraws(chunk, assets);
  }
}

void QueueBuffers::buildDraws(Chunk& chunk, const CrowdAssets& assets) {
  const std::span commands = chunk.commands.mapped<vk::DrawIndexedIndirectCommand>();
  const std::span draws = chunk.draws.mapped<GpuDraw>();
  chunk.batches.clear();
  std::uint32_t draw_count = 0;
  for (std::size_t i = 0; i < assets.items().size(); ++i) {
    const std::uint32_t length = chunk.queues.lengths()[i];
    if (length == 0) continue;
    const DrawItem& item = assets.items()[i];
    commands[draw_count] = vk::DrawIndexedIndirectCommand{.indexCount = item.index_count,
                                                          .instanceCount = length,
                                                          .firstIndex = item.first_index,
                                                          .vertexOffset = item.vertex_offset,
                                                          .firstInstance = chunk.queues.offsets()[i]};
    draws[draw_count] = item.gpu;
    if (chunk.batches.empty() || chunk.batches.back().state != item.state) {
      chunk.batches.push_back({.state = item.state, .first_draw = draw_count, .draw_count = 0});
    }
    ++chunk.batches.back().draw_count;
    ++draw_count;
    counts_.triangles += std::uint64_t{length} * (item.index_count / 3);
  }
  counts_.draw_calls += draw_count;
}

}  // namespace ensemble
