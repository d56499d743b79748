// One pass's render queues on the device, and the indirect draws that they become (design 5).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_layout.h"
#include "renderer/crowd_state.h"
#include "renderer/queues.h"

namespace ensemble {

/// Draws of one state: they go to the device in one call.
struct DrawBatch {
  DrawState state;
  std::uint32_t first_draw = 0, draw_count = 0;
};

/// What a pass draws; exact.
struct DrawCounts {
  std::uint64_t draw_calls = 0;  ///< instanced draws: one per sub-mesh with people in its queue
  std::uint64_t triangles = 0;   ///< of all instances
};

class QueueBuffers {
 public:
  /// @throws SystemError if the queues of the whole crowd don't fit
  QueueBuffers(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets,
               const CrowdState& state);

  /// Fills queues and draws for some people. Allocates nothing. The device must not be drawing with
  /// them. @param visible their numbers, ascending
  void build(const CrowdAssets& assets, const CrowdState& state, std::span<const std::uint32_t> visible);
  const DrawCounts& counts() const { return counts_; }

  /// What one chunk of the crowd draws, in draw order.
  struct Chunk {
    gpu::Buffer entries, draws, commands;
    RenderQueues queues;
    std::vector<std::uint32_t> visible;  ///< numbers within the chunk
    std::vector<DrawBatch> batches;
  };
  const std::vector<Chunk>& chunks() const { return chunks_; }
  vk::DescriptorSet set(std::size_t chunk) const { return sets_[chunk]; }

 private:
  void buildDraws(Chunk& chunk, const CrowdAssets& assets);

  std::vector<Chunk> chunks_;
  gpu::DescriptorSets sets_;
  DrawCounts counts_;
};

}  // namespace ensemble
