// Draws the people of one pass from its queues. Every pass over the crowd goes through here, so that
// the techniques and the passes differ in nothing but lists and shaders.
#pragma once

#include <optional>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_layout.h"
#include "renderer/crowd_pipeline.h"
#include "renderer/device_queues.h"
#include "renderer/queue_buffers.h"

namespace ensemble {

class EnvironmentPass;
struct EnvironmentQueue;

/// What to draw of the environment; nothing where there is none.
struct EnvironmentDraw {
  const EnvironmentPass* pass = nullptr;
  const EnvironmentQueue* queue = nullptr;
  std::uint32_t counted_pass = 0;
};

/// What to draw with what.
struct CrowdDraw {
  const CrowdAssets* assets = nullptr;
  const CrowdLayout* layout = nullptr;
  const QueueBuffers* queues = nullptr;
  vk::DescriptorSet view_set;
  const DeviceQueues* device_queues = nullptr;  ///< in place of `queues` where shaders have built them
  EnvironmentDraw environment = {};
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

/// Binds what a batch needs. Sets that stay are bound again: a batch is a whole call of many draws.
inline void bindBatch(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                      const DrawState& state) {
  const vk::PipelineLayout layout = *draw.layout->pipelineLayout();
  const VertexChunk& vertices = draw.assets->vertexChunk(state.vertex_chunk);
  const IndexChunk& indices = draw.assets->indexChunk(state.index_chunk);
  commands.setCullMode(state.double_sided ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack);
  commands.bindVertexBuffers(0, vertices.vertices.handle(), vk::DeviceSize{0});
  commands.bindIndexBuffer(indices.indices.handle(), 0, indices.type);
  const std::array<vk::DescriptorSet, 2> sets = {draw.layout->assetSet(state.index_chunk),
                                                 draw.assets->textures().set(state.texture_set)};
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, ENSEMBLE_SET_ASSETS, sets, nullptr);
}

/// @param counter null: count nothing
/// @param pipeline_of the pipeline of a DrawState
template <class PipelineOf>
void recordCrowd(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, VertexCounter* counter,
                 std::uint32_t counted_pass, const PipelineOf& pipeline_of) {
  constexpr std::uint32_t kStride = sizeof(vk::DrawIndexedIndirectCommand);
  const vk::PipelineLayout layout = *draw.layout->pipelineLayout();
  vk::Pipeline bound;
  const auto bind_chunk = [&](vk::DescriptorSet people) {
    const std::array<vk::DescriptorSet, 2> sets = {draw.view_set, people};
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, ENSEMBLE_SET_VIEW, sets, nullptr);
  };
  const auto bind_batch = [&](const DrawBatch& batch) {
    const vk::Pipeline pipeline = *pipeline_of(batch.state);
    if (pipeline != bound) commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
    if (!bound && counter) counter->begin(commands, counted_pass);
    bound = pipeline;
    bindBatch(commands, draw, batch.state);
    commands.pushConstants<std::uint32_t>(layout, vk::ShaderStageFlagBits::eVertex, 0, batch.first_draw);
    return std::uint64_t{batch.first_draw} * kStride;
  };
  if (const DeviceQueues* queues = draw.device_queues) {
    for (std::size_t i = 0; i < queues->chunks().size(); ++i) {
      const DeviceQueues::Chunk& chunk = queues->chunks()[i];
      bind_chunk(queues->set(i));
      for (std::size_t b = 0; b < queues->batches().size(); ++b) {
        const DrawBatch& batch = queues->batches()[b];
        const std::uint64_t first = bind_batch(batch);
        commands.drawIndexedIndirectCount(chunk.commands.handle(), first, chunk.draw_counts.handle(),
                                          b * sizeof(std::uint32_t), batch.draw_count, kStride);
      }
    }
  } else {
    for (std::size_t i = 0; i < draw.queues->chunks().size(); ++i) {
      const QueueBuffers::Chunk& chunk = draw.queues->chunks()[i];
      if (chunk.batches.empty()) continue;
      bind_chunk(draw.queues->set(i));
      for (const DrawBatch& batch : chunk.batches)
        commands.drawIndexedIndirect(chunk.commands.handle(), bind_batch(batch), batch.draw_count, kStride);
    }
  }
  if (bound && counter) counter->end(commands, counted_pass);
}

}  // namespace ensemble
