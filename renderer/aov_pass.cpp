#include "renderer/aov_pass.h"

#include "renderer/environment_pass.h"
#include "spirv/aov.frag.h"
#include "spirv/crowd.vert.h"
#include "spirv/ground.vert.h"
#include "spirv/ground_aov.frag.h"

namespace ensemble {

AovPass::AovPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets)
    : layout_(layout) {
  const auto make = [&](std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                        PipelineOptions options) {
    const vk::raii::ShaderModule vertex_shader = gpu::makeShader(device, vertex);
    const vk::raii::ShaderModule fragment_shader = gpu::makeShader(device, fragment);
    options.vertex_shader = *vertex_shader;
    options.fragment_shader = *fragment_shader;
    options.color_formats = kAovFormats;
    return makePipeline(device, layout.pipelineLayout(), options);
  };
  for (const DrawItem& item : assets.items()) {
    makeIfMissing(people_, shapeVariant(item.state),
                  [&](ShaderVariant variant) { return make(kCrowdVert, kAovFrag, {.variant = variant}); });
  }
  ground_ = make(kGroundVert, kGroundAovFrag, {.draws_people = false});
}

void AovPass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                     const ViewTargets& targets, const View& view, const std::function<void()>& more) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  std::array<vk::RenderingAttachmentInfo, 5> colors;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    gpu::recordBarrier(commands, targets.aovs[i],
                       {.from_stage = Stage::eTransfer | Stage::eColorAttachmentOutput,
                        .to_stage = Stage::eColorAttachmentOutput,
                        .from_access = Access::eColorAttachmentWrite,
                        .to_access = Access::eColorAttachmentWrite,
                        .to = Layout::eColorAttachmentOptimal});
    colors[i] = vk::RenderingAttachmentInfo{.imageView = targets.aovs[i].view(),
                                            .imageLayout = Layout::eColorAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eStore};
  }
  const vk::RenderingAttachmentInfo depth =
      recordClearedDepth(commands, targets.aov_depth, static_cast<bool>(more));
  commands.beginRendering({.renderArea = {.extent = {targets.size.width, targets.size.height}},
                           .layerCount = 1,
                           .colorAttachmentCount = colors.size(),
                           .pColorAttachments = colors.data(),
                           .pDepthAttachment = &depth});
  recordTileViewport(commands, view, targets.tile);
  recordDraws(commands, draw, view);
  commands.endRendering();
  if (more) {
    recordReadableDepth(commands, targets.aov_depth);
    for (const gpu::Image& image : targets.aovs) {
      gpu::recordBarrier(commands, image,
                         {.from_stage = Stage::eColorAttachmentOutput,
                          .to_stage = Stage::eComputeShader,
                          .from_access = Access::eColorAttachmentWrite,
                          .to_access = Access::eShaderStorageWrite,
                          .from = Layout::eColorAttachmentOptimal,
                          .to = Layout::eGeneral});
    }
    more();
  }
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (!view.aovs.has(static_cast<Aov>(i))) continue;
    gpu::recordBarrier(commands, targets.aovs[i],
                       {.from_stage = Stage::eColorAttachmentOutput | Stage::eComputeShader,
                        .to_stage = Stage::eTransfer,
                        .from_access = Access::eColorAttachmentWrite | Access::eShaderStorageWrite,
                        .to_access = Access::eTransferRead,
                        .from = more ? Layout::eGeneral : Layout::eColorAttachmentOptimal,
                        .to = Layout::eTransferSrcOptimal});
    targets.aov_readbacks[i].record(commands, targets.aovs[i]);
  }
}

void AovPass::recordDraws(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                          const View& view) const {
  recordCrowd(commands, draw, nullptr, 0, [&](const DrawState& state) -> const vk::raii::Pipeline& {
    return people_[variantIndex(shapeVariant(state))];
  });
  if (draw.environment.pass) draw.environment.pass->recordAovs(commands, draw);
  if (!view.drawsGround()) return;
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_.pipelineLayout(), ENSEMBLE_SET_VIEW,
                              draw.view_set, nullptr);
  commands.setCullMode(vk::CullModeFlagBits::eNone);
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *ground_);
  commands.draw(12, 1, 0, 0);
}

}  // namespace ensemble
