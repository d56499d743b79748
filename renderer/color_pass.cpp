#include "renderer/color_pass.h"

#include "renderer/environment_pass.h"
#include "spirv/crowd.frag.h"
#include "spirv/crowd.vert.h"
#include "spirv/ground.frag.h"
#include "spirv/ground.vert.h"
#include "spirv/sky.frag.h"
#include "spirv/sky.vert.h"

namespace ensemble {

ColorPass::ColorPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets)
    : device_(device), layout_(layout), assets_(assets) {}

void ColorPass::prepare(std::uint32_t samples) {
  Pipelines& pipelines = pipelines_[samples > 1 ? 1 : 0];
  if (*pipelines.sky) return;
  const auto make = [&](std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                        PipelineOptions options) {
    const vk::raii::ShaderModule vertex_shader = gpu::makeShader(device_, vertex);
    const vk::raii::ShaderModule fragment_shader = gpu::makeShader(device_, fragment);
    options.vertex_shader = *vertex_shader;
    options.fragment_shader = *fragment_shader;
    options.color_formats = std::span(&kColorFormat, 1);
    options.samples = samples;
    return makePipeline(device_, layout_.pipelineLayout(), options);
  };
  for (const DrawItem& item : assets_.items()) {
    makeIfMissing(pipelines.people, variantFor(item.state),
                  [&](ShaderVariant variant) { return make(kCrowdVert, kCrowdFrag, {.variant = variant}); });
  }
  pipelines.ground = make(kGroundVert, kGroundFrag, {.draws_people = false});
  // Where nothing was drawn depth is still 0, that of the sky.
  pipelines.sky =
      make(kSkyVert, kSkyFrag,
           {.draws_people = false, .depth_compare = vk::CompareOp::eEqual, .writes_depth = false});
}

void ColorPass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                       const ViewTargets& targets, const View& view, VertexCounter& counter,
                       std::uint32_t counted_pass, bool keep) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  using Layout = vk::ImageLayout;
  const gpu::ImageBarrier to_color{
      .from_stage = Stage::eColorAttachmentOutput | Stage::eComputeShader | Stage::eTransfer,
      .to_stage = Stage::eColorAttachmentOutput,
      .from_access = Access::eColorAttachmentWrite,
      .to_access = Access::eColorAttachmentWrite | Access::eColorAttachmentRead,
      .to = Layout::eColorAttachmentOptimal};
  const bool multisampled = static_cast<bool>(targets.samples);
  gpu::recordBarrier(commands, targets.linear, to_color);
  if (multisampled) gpu::recordBarrier(commands, targets.samples, to_color);
  vk::RenderingAttachmentInfo color{
      .imageView = multisampled ? targets.samples.view() : targets.linear.view(),
      .imageLayout = Layout::eColorAttachmentOptimal,
      .loadOp = vk::AttachmentLoadOp::eClear,
      .storeOp = multisampled && !keep ? vk::AttachmentStoreOp::eDontCare : vk::AttachmentStoreOp::eStore};
  if (multisampled) {
    color.resolveMode = vk::ResolveModeFlagBits::eAverage;
    color.resolveImageView = targets.linear.view();
    color.resolveImageLayout = Layout::eColorAttachmentOptimal;
  }
  const vk::RenderingAttachmentInfo depth = recordClearedDepth(commands, targets.depth, keep);
  commands.beginRendering({.renderArea = {.extent = {targets.size.width, targets.size.height}},
                           .layerCount = 1,
                           .colorAttachmentCount = 1,
                           .pColorAttachments = &color,
                           .pDepthAttachment = &depth});
  recordTileViewport(commands, view, targets.tile);
  const Pipelines& pipelines = pipelinesFor(targets.size.samples);
  recordCrowd(commands, draw, &counter, counted_pass,
              [&](const DrawState& state) -> const vk::raii::Pipeline& {
                return pipelines.people[variantIndex(variantFor(state))];
              });
  if (draw.environment.pass)
    draw.environment.pass->recordColor(commands, draw, targets.size.samples, counter);
  recordBackground(commands, draw, view);
  commands.endRendering();
  if (keep) recordReadableDepth(commands, targets.depth);
  const gpu::ImageBarrier to_readable{.from_stage = Stage::eColorAttachmentOutput,
                                      .to_stage = Stage::eComputeShader,
                                      .from_access = Access::eColorAttachmentWrite,
                                      .to_access = Access::eShaderSampledRead,
                                      .from = Layout::eColorAttachmentOptimal,
                                      .to = Layout::eShaderReadOnlyOptimal};
  gpu::recordBarrier(commands, targets.linear, to_readable);
  if (keep && multisampled) gpu::recordBarrier(commands, targets.samples, to_readable);
}

void ColorPass::recordBackground(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                                 const View& view) const {
  if (view.background == BackgroundKind::kTransparent) return;
  const Pipelines& pipelines = pipelinesFor(view.samples);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_.pipelineLayout(), ENSEMBLE_SET_VIEW,
                              draw.view_set, nullptr);
  commands.setCullMode(vk::CullModeFlagBits::eNone);
  if (view.drawsGround()) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipelines.ground);
    commands.draw(12, 1, 0, 0);
  }
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipelines.sky);
  commands.draw(3, 1, 0, 0);
}

}  // namespace ensemble
