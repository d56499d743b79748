#include "renderer/environment_pass.h"

#include "renderer/view_targets.h"
#include "spirv/environment.frag.h"
#include "spirv/environment.vert.h"
#include "spirv/environment_aov.frag.h"
#include "spirv/environment_discard.frag.h"
#include "spirv/environment_discard.vert.h"
#include "spirv/environment_shadow.vert.h"

namespace ensemble {
namespace {

constexpr auto kPushStage = vk::ShaderStageFlagBits::eFragment;

ShaderVariant colorVariant(const DrawState& state) {
  return {.textured = state.textured, .cut_out = state.cut_out, .hides_faces = false};
}

std::size_t slotOf(std::uint32_t samples) { return samples > 1 ? 1 : 0; }

}  // namespace

EnvironmentPass::EnvironmentPass(const gpu::Device& device, const CrowdLayout& layout,
                                 const EnvironmentAssets& assets)
    : device_(device), assets_(assets) {
  // In the order of ENSEMBLE_SET_VIEW, ENSEMBLE_SET_ENVIRONMENT_TEXTURE.
  const std::array<vk::DescriptorSetLayout, 2> sets = {*layout.viewLayout(), *assets.textures().layout()};
  layout_ = gpu::makePipelineLayout(device, sets, sizeof(GpuStaticMaterial), kPushStage);
  for (const EnvironmentItem& item : assets.items()) {
    makeIfMissing(shadow_, shapeVariant(item.state), [&](ShaderVariant variant) {
      return variant.cut_out ? make(kEnvironmentDiscardVert, kEnvironmentDiscardFrag,
                                    {.variant = variant, .is_shadow = true})
                             : make(kEnvironmentShadowVert, {}, {.variant = variant, .is_shadow = true});
    });
  }
}

vk::raii::Pipeline EnvironmentPass::make(std::span<const std::uint32_t> vertex,
                                         std::span<const std::uint32_t> fragment,
                                         PipelineOptions options) const {
  const vk::raii::ShaderModule vertex_shader = gpu::makeShader(device_, vertex);
  vk::raii::ShaderModule fragment_shader = nullptr;
  if (!fragment.empty()) fragment_shader = gpu::makeShader(device_, fragment);
  options.vertex_shader = *vertex_shader;
  options.fragment_shader = *fragment_shader;
  options.draws_environment = true;
  return makePipeline(device_, layout_, options);
}

void EnvironmentPass::prepare(std::uint32_t samples) {
  for (const EnvironmentItem& item : assets_.items()) {
    makeIfMissing(color_[slotOf(samples)], colorVariant(item.state), [&](ShaderVariant variant) {
      return make(kEnvironmentVert, kEnvironmentFrag,
                  {.variant = variant, .color_formats = std::span(&kColorFormat, 1), .samples = samples});
    });
  }
}

void EnvironmentPass::prepareAovs() {
  for (const EnvironmentItem& item : assets_.items()) {
    makeIfMissing(aovs_, shapeVariant(item.state), [&](ShaderVariant variant) {
      return make(kEnvironmentVert, kEnvironmentAovFrag, {.variant = variant, .color_formats = kAovFormats});
    });
  }
}

EnvironmentQueue EnvironmentPass::makeQueue() const {
  EnvironmentQueue queue;
  queue.items.reserve(assets_.items().size());
  return queue;
}

template <class PipelineOf>
void EnvironmentPass::record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                             const Recording& recording, const PipelineOf& pipeline_of) const {
  const EnvironmentQueue& queue = *draw.environment.queue;
  if (queue.items.empty()) return;
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_, ENSEMBLE_SET_VIEW, draw.view_set,
                              nullptr);
  const DrawState* last = nullptr;
  for (const std::uint32_t number : queue.items) {
    const EnvironmentItem& item = assets_.items()[number];
    const DrawState& state = item.state;
    if (!last || state != *last) {
      const bool culls = !recording.both_sides && !state.double_sided;
      commands.setCullMode(culls ? vk::CullModeFlagBits::eBack : vk::CullModeFlagBits::eNone);
      commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline_of(state));
      commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout_,
                                  ENSEMBLE_SET_ENVIRONMENT_TEXTURE, assets_.textures().set(state.texture_set),
                                  nullptr);
      commands.bindVertexBuffers(0, assets_.vertexChunk(state.vertex_chunk).handle(), vk::DeviceSize{0});
      commands.bindIndexBuffer(assets_.indexChunk(state.index_chunk).handle(), 0, vk::IndexType::eUint16);
    }
    if (!last && recording.counter) recording.counter->begin(commands, draw.environment.counted_pass);
    last = &state;
    commands.pushConstants<GpuStaticMaterial>(*layout_, kPushStage, 0, item.material);
    commands.drawIndexed(item.index_count, 1, item.first_index, item.vertex_offset, 0);
  }
  if (recording.counter) recording.counter->end(commands, draw.environment.counted_pass);
}

void EnvironmentPass::recordShadow(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                                   VertexCounter& counter) const {
  const Recording recording{.counter = &counter, .both_sides = true};
  record(commands, draw, recording, [&](const DrawState& state) -> const vk::raii::Pipeline& {
    return shadow_[variantIndex(shapeVariant(state))];
  });
}

void EnvironmentPass::recordColor(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                                  std::uint32_t samples, VertexCounter& counter) const {
  record(commands, draw, {.counter = &counter}, [&](const DrawState& state) -> const vk::raii::Pipeline& {
    return color_[slotOf(samples)][variantIndex(colorVariant(state))];
  });
}

void EnvironmentPass::recordAovs(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw) const {
  record(commands, draw, {}, [&](const DrawState& state) -> const vk::raii::Pipeline& {
    return aovs_[variantIndex(shapeVariant(state))];
  });
}

}  // namespace ensemble
