// Draws the people of one pass from its queues. Every pass over the crowd goes through here, so that
// the techniques and the passes differ in nothing but lists and shaders.
#pragma once

#include <optional>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_layout.h"
#include "renderer/crowd_pipeline.h"
#include "renderer/queue_buffers.h"

namespace ensemble {

/// What to draw with what.
struct CrowdDraw {
  const CrowdAssets* assets = nullptr;
  const CrowdLayout* layout = nullptr;
  const QueueBuffers* queues = nullptr;
  vk::DescriptorSet view_set;
};

/// Counts vertex invocations of one pass at a time. Does nothing where the device can't.
class VertexCounter {
 public:
  VertexCounter() = default;
  VertexCounter(const gpu::Device& device, std::uint32_t pass_count);

  void reset(const vk::raii::CommandBuffer& commands);
  /// Begin only with a pipeline bound, inside rendering: lavapipe of Mesa 22.3 crashes otherwise.
  void begin(const vk::raii::CommandBuffer& commands, std::uint32_t pass);
  void end(const vk::raii::CommandBuffer& commands, std::uint32_t pass);
  /// After the frame: what a pass counted; 0 if it drew nobody, none where the device can't count.
  std::optional<std::uint64_t> result(const gpu::Device& device, std::uint32_t pass) const;

 private:
  vk::raii::QueryPool pool_ = nullptr;
  std::vector<bool> was_used_;
};

/// @param pipeline_of the pipeline of a DrawState
template <class PipelineOf>
void recordCrowd(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, VertexCounter* counter,
                 std::uint32_t counted_pass, const PipelineOf& pipeline_of);

}  // namespace ensemble

#include "renderer/crowd_draw_inl.h"
