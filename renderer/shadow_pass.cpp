#include "renderer/shadow_pass.h"

#include "renderer/environment_pass.h"
#include "spirv/shadow.vert.h"
#include "spirv/shadow_discard.frag.h"
#include "spirv/shadow_discard.vert.h"

namespace ensemble {

ShaderVariant ShadowPass::variantFor(const DrawState& state) {
  return {.textured = state.textured && state.cut_out,
          .cut_out = state.cut_out,
          .hides_faces = state.hides_faces};
}

ShadowPass::ShadowPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets) {
  const vk::raii::ShaderModule plain = gpu::makeShader(device, kShadowVert);
  const vk::raii::ShaderModule discard_vertex = gpu::makeShader(device, kShadowDiscardVert);
  const vk::raii::ShaderModule discard_fragment = gpu::makeShader(device, kShadowDiscardFrag);
  for (const DrawItem& item : assets.items()) {
    makeIfMissing(pipelines_, variantFor(item.state), [&](ShaderVariant variant) {
      const bool discards = variant.cut_out || variant.hides_faces;
      return makePipeline(device, layout.pipelineLayout(),
                          {.vertex_shader = discards ? *discard_vertex : *plain,
                           .fragment_shader = discards ? *discard_fragment : vk::ShaderModule{},
                           .variant = variant,
                           .is_shadow = true});
    });
  }
}

void ShadowPass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                        const ViewTargets& targets, VertexCounter& counter, std::uint32_t counted_pass,
                        const std::function<void()>& fill) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  constexpr auto readers = Stage::eFragmentShader | Stage::eComputeShader;
  if (fill) {
    gpu::recordBarrier(commands, targets.shadow_map,
                       {.from_stage = readers,
                        .to_stage = Stage::eTransfer,
                        .to_access = Access::eTransferWrite,
                        .to = Layout::eTransferDstOptimal});
    fill();
  }
  gpu::recordBarrier(commands, targets.shadow_map,
                     {.from_stage = fill ? vk::PipelineStageFlags2(Stage::eTransfer) : readers,
                      .to_stage = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                      .from_access = fill ? Access::eTransferWrite : Access{},
                      .to_access = Access::eDepthStencilAttachmentWrite | Access::eDepthStencilAttachmentRead,
                      .from = fill ? Layout::eTransferDstOptimal : Layout::eUndefined,
                      .to = Layout::eDepthAttachmentOptimal});
  const vk::RenderingAttachmentInfo depth{
      .imageView = targets.shadow_map.view(),
      .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
      .loadOp = fill ? vk::AttachmentLoadOp::eLoad : vk::AttachmentLoadOp::eClear,
      .storeOp = vk::AttachmentStoreOp::eStore,
      .clearValue = vk::ClearDepthStencilValue{.depth = 0.0f}};
  const std::uint32_t size = targets.size.shadow_size;
  commands.beginRendering(
      {.renderArea = {.extent = {size, size}}, .layerCount = 1, .pDepthAttachment = &depth});
  recordFullViewport(commands, size, size);
  recordCrowd(commands, draw, &counter, counted_pass,
              [&](const DrawState& state) -> const vk::raii::Pipeline& {
                return pipelines_[variantIndex(variantFor(state))];
              });
  if (draw.environment.pass) draw.environment.pass->recordShadow(commands, draw, counter);
  commands.endRendering();
  gpu::recordBarrier(commands, targets.shadow_map,
                     {.from_stage = Stage::eLateFragmentTests,
                      .to_stage = readers,
                      .from_access = Access::eDepthStencilAttachmentWrite,
                      .to_access = Access::eShaderSampledRead,
                      .from = vk::ImageLayout::eDepthAttachmentOptimal,
                      .to = vk::ImageLayout::eShaderReadOnlyOptimal});
}

}  // namespace ensemble
