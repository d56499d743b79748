#include "renderer/overdraw_pass.h"

#include <cstring>

#include <glm/gtc/packing.hpp>

#include "spirv/crowd.vert.h"
#include "spirv/overdraw.frag.h"

namespace ensemble {

OverdrawPass::OverdrawPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets) {
  const vk::raii::ShaderModule vertex = gpu::makeShader(device, kCrowdVert);
  const vk::raii::ShaderModule fragment = gpu::makeShader(device, kOverdrawFrag);
  for (const DrawItem& item : assets.items()) {
    makeIfMissing(pipelines_, shapeVariant(item.state), [&](ShaderVariant variant) {
      return makePipeline(device, layout.pipelineLayout(),
                          {.vertex_shader = *vertex,
                           .fragment_shader = *fragment,
                           .variant = variant,
                           .color_formats = std::span(&kOverdrawFormat, 1),
                           .adds = true,
                           .depth_compare = vk::CompareOp::eAlways,
                           .writes_depth = false});
    });
  }
}

void OverdrawPass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                          const ViewTargets& targets, const View& view) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  gpu::recordBarrier(commands, targets.overdraw,
                     {.from_stage = Stage::eTransfer,
                      .to_stage = Stage::eColorAttachmentOutput,
                      .to_access = Access::eColorAttachmentWrite | Access::eColorAttachmentRead,
                      .to = Layout::eColorAttachmentOptimal});
  const vk::RenderingAttachmentInfo color{.imageView = targets.overdraw.view(),
                                          .imageLayout = Layout::eColorAttachmentOptimal,
                                          .loadOp = vk::AttachmentLoadOp::eClear,
                                          .storeOp = vk::AttachmentStoreOp::eStore};
  const vk::RenderingAttachmentInfo depth = recordClearedDepth(commands, targets.aov_depth);
  commands.beginRendering({.renderArea = {.extent = {targets.size.width, targets.size.height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  recordTileViewport(commands, view, targets.tile);
  recordCrowd(commands, draw, nullptr, 0, [&](const DrawState& state) -> const vk::raii::Pipeline& {
    return pipelines_[variantIndex(shapeVariant(state))];
  });
  commands.endRendering();
  gpu::recordBarrier(commands, targets.overdraw,
                     {.from_stage = Stage::eColorAttachmentOutput,
                      .to_stage = Stage::eTransfer,
                      .from_access = Access::eColorAttachmentWrite,
                      .to_access = Access::eTransferRead,
                      .from = Layout::eColorAttachmentOptimal,
                      .to = Layout::eTransferSrcOptimal});
  targets.overdraw_readback.record(commands, targets.overdraw);
}

void OverdrawPass::collect(const ViewTargets& targets, const View& view,
                           std::span<const std::uint32_t> computed, std::span<std::uint32_t> counts) {
  const Tile& tile = targets.tile;
  targets.overdraw_readback.forEachRow([&](std::uint32_t row, std::span<const std::byte> bytes) {
    if (row >= tile.height) return;
    const std::size_t from = std::size_t{row} * targets.size.width;
    const std::size_t to = std::size_t{tile.y + row} * view.width + tile.x;
    for (std::size_t x = 0; x < tile.width; ++x) {
      std::uint16_t half = 0;
      std::memcpy(&half, bytes.data() + x * sizeof half, sizeof half);
      counts[to + x] =
          static_cast<std::uint32_t>(glm::unpackHalf1x16(half)) + (computed.empty() ? 0 : computed[from + x]);
    }
  });
}

}  // namespace ensemble
