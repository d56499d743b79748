#include "renderer/coverage_pass.h"

#include <algorithm>
#include <tuple>

#include "core/input_error.h"
#include "spirv/coverage.frag.h"
#include "spirv/crowd.vert.h"

namespace ensemble {

CoveragePass::CoveragePass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets) {
  if (!device.features().occlusionQueryPrecise) {
    throw SystemError({.file = {},
                       .where = "Vulkan device " + device.name(),
                       .what = "its occlusion queries don't count pixels, which --annotations needs",
                       .mend = "use another device, or leave --annotations out"});
  }
  const vk::raii::ShaderModule vertex = gpu::makeShader(device, kCrowdVert);
  const vk::raii::ShaderModule fragment = gpu::makeShader(device, kCoverageFrag);
  for (const DrawItem& item : assets.items()) {
    makeIfMissing(pipelines_, shapeVariant(item.state), [&](ShaderVariant variant) {
      return makePipeline(device, layout.pipelineLayout(),
                          {.vertex_shader = *vertex, .fragment_shader = *fragment, .variant = variant});
    });
  }
  queries_ = ENSEMBLE_VK(vk::raii::QueryPool(
      device.handle(),
      vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eOcclusion, .queryCount = kGroup}));
}

void CoveragePass::plan(const QueueBuffers& queues) {
  draws_.clear();
  people_.clear();
  for (std::uint32_t c = 0; c < queues.chunks().size(); ++c) {
    const QueueBuffers::Chunk& chunk = queues.chunks()[c];
    const std::span commands = chunk.commands.mapped<vk::DrawIndexedIndirectCommand>();
    const std::span entries = chunk.entries.mapped<std::uint32_t>();
    const std::size_t first = draws_.size();
    for (std::uint32_t b = 0; b < chunk.batches.size(); ++b) {
      const DrawBatch& batch = chunk.batches[b];
      for (std::uint32_t d = batch.first_draw; d < batch.first_draw + batch.draw_count; ++d) {
        for (std::uint32_t i = 0; i < commands[d].instanceCount; ++i) {
          const std::uint32_t instance = commands[d].firstInstance + i;
          draws_.push_back({.person = entries[instance], .instance = instance, .draw = d, .batch = b});
        }
      }
    }
    std::sort(draws_.begin() + static_cast<std::ptrdiff_t>(first), draws_.end(),
              [](const PersonDraw& a, const PersonDraw& b) {
                return std::tie(a.person, a.draw) < std::tie(b.person, b.draw);
              });
    for (std::size_t i = first; i < draws_.size(); ++i) {
      if (i == first || draws_[i].person != draws_[i - 1].person) {
        people_.push_back({.chunk = c, .number = draws_[i].person, .first_draw = i, .draw_count = 0});
      }
      ++people_.back().draw_count;
    }
  }
}

void CoveragePass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                          const ViewTargets& targets, const View& view, std::size_t group) const {
  const vk::RenderingAttachmentInfo depth = recordClearedDepth(commands, targets.aov_depth);
  commands.resetQueryPool(*queries_, 0, kGroup);
  commands.beginRendering({.renderArea = {.extent = {targets.size.width, targets.size.height}},
                           .layerCount = 1,
                           .pDepthAttachment = &depth});
  recordTileViewport(commands, view, targets.tile);
  vk::Pipeline bound;
  const std::size_t first = group * kGroup, end = std::min(first + kGroup, people_.size());
  for (std::size_t i = first; i < end; ++i) {
    const Person& person = people_[i];
    if (i == first || person.chunk != people_[i - 1].chunk) {
      const std::array<vk::DescriptorSet, 2> sets = {draw.view_set, draw.queues->set(person.chunk)};
      commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *draw.layout->pipelineLayout(),
                                  ENSEMBLE_SET_VIEW, sets, nullptr);
    }
    const QueueBuffers::Chunk& chunk = draw.queues->chunks()[person.chunk];
    if (!bound) {  // A query may begin only with a pipeline bound (VertexCounter).
      const DrawState& state = chunk.batches[draws_[person.first_draw].batch].state;
      bound = *pipelines_[variantIndex(shapeVariant(state))];
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics, bound);
    }
    commands.beginQuery(*queries_, static_cast<std::uint32_t>(i - first), vk::QueryControlFlagBits::ePrecise);
    recordPerson(commands, draw, person, bound);
    commands.endQuery(*queries_, static_cast<std::uint32_t>(i - first));
  }
  commands.endRendering();
}

void CoveragePass::recordPerson(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                                const Person& person, vk::Pipeline& bound) const {
  const QueueBuffers::Chunk& chunk = draw.queues->chunks()[person.chunk];
  const std::span indirect = chunk.commands.mapped<vk::DrawIndexedIndirectCommand>();
  for (std::size_t i = person.first_draw; i < person.first_draw + person.draw_count; ++i) {
    const PersonDraw& own = draws_[i];
    const DrawState& state = chunk.batches[own.batch].state;
    const vk::Pipeline pipeline = *pipelines_[variantIndex(shapeVariant(state))];
    if (pipeline != bound) commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipeline);
    bound = pipeline;
    if (i == person.first_draw || own.batch != draws_[i - 1].batch) bindBatch(commands, draw, state);
    commands.pushConstants<std::uint32_t>(*draw.layout->pipelineLayout(), vk::ShaderStageFlagBits::eVertex, 0,
                                          own.draw);
    const vk::DrawIndexedIndirectCommand& all = indirect[own.draw];
    commands.drawIndexed(all.indexCount, 1, all.firstIndex, all.vertexOffset, own.instance);
  }
}

void CoveragePass::collect(const gpu::Device& device, std::span<const std::uint32_t> first_of_chunk,
                           std::size_t group, std::span<std::uint32_t> pixels) const {
  const std::size_t first = group * kGroup, count = std::min(kGroup, people_.size() - first);
  std::array<std::uint64_t, kGroup> results{};
  const vk::Device handle = *device.handle();
  const vk::Result result = ENSEMBLE_VK(handle.getQueryPoolResults(
      *queries_, 0, static_cast<std::uint32_t>(count), count * sizeof(std::uint64_t), results.data(),
      sizeof(std::uint64_t), vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait,
      *device.handle().getDispatcher()));
  if (result != vk::Result::eSuccess)
    gpu::throwVulkanError(result, "getQueryPoolResults", __FILE__, __LINE__);
  for (std::size_t i = 0; i < count; ++i) {
    const Person& person = people_[first + i];
    pixels[first_of_chunk[person.chunk] + person.number] += static_cast<std::uint32_t>(results[i]);
  }
}

}  // namespace ensemble
