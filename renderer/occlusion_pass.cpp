#include "renderer/occlusion_pass.h"

#include <array>

#include "spirv/occlusion_dispatch.comp.h"
#include "spirv/occlusion_pick.comp.h"
#include "spirv/occlusion_reduce.comp.h"
#include "spirv/occlusion_tiles.comp.h"
#include "spirv/occlusion_tiles_samples.comp.h"

namespace ensemble {
namespace {

constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
/// In the order of ENSEMBLE_BINDING_OCCLUSION_...
constexpr std::initializer_list<vk::DescriptorType> kBindings = {vk::DescriptorType::eUniformTexelBuffer,
                                                                 vk::DescriptorType::eCombinedImageSampler,
                                                                 kStorage,
                                                                 vk::DescriptorType::eUniformTexelBuffer,
                                                                 vk::DescriptorType::eUniformTexelBuffer,
                                                                 kStorage,
                                                                 kStorage,
                                                                 kStorage,
                                                                 kStorage};

/// As occlusion_sets.glsl has it.
struct Push {
  std::uint32_t width = 0, height = 0, level = 0;
  std::uint32_t first_group = 0, group_count = 0, face_bits = 0, batch_count = 0, triangles_per_group = 0;
  float near_plane = 0.0f;
  std::uint32_t hides = 0;
};

std::uint32_t texelsOf(const OcclusionPass::Target& target, std::uint32_t level) {
  const std::uint32_t side = ENSEMBLE_PYRAMID_TILE << level;
  return ((target.width + side - 1) / side) * ((target.height + side - 1) / side);
}

}  // namespace

OcclusionPass::OcclusionPass(gpu::Device& device) : device_(device) {
  constexpr auto kCompute = vk::ShaderStageFlagBits::eCompute;
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device, kBindings, kCompute);
  layout_ = gpu::makePipelineLayout(device, std::array{*set_layout_}, sizeof(Push));
  struct Constants {
    std::int32_t samples;
    vk::Bool32 drawn;
  };
  constexpr std::array<vk::SpecializationMapEntry, 2> kEntries = {{
      {ENSEMBLE_CONSTANT_SAMPLES, offsetof(Constants, samples), sizeof(std::int32_t)},
      {ENSEMBLE_CONSTANT_DRAWN, offsetof(Constants, drawn), sizeof(vk::Bool32)},
  }};
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
    const bool several = (i & 1u) != 0;
    const Constants constants{.samples = several ? 4 : 1, .drawn = i >> 1};
    const vk::SpecializationInfo info{.mapEntryCount = kEntries.size(),
                                      .pMapEntries = kEntries.data(),
                                      .dataSize = sizeof constants,
                                      .pData = &constants};
    tiles_[i] = several ? gpu::makeComputePipeline(device, layout_, kOcclusionTilesSamplesComp, &info)
                        : gpu::makeComputePipeline(device, layout_, kOcclusionTilesComp, &info);
  }
  reduce_ = gpu::makeComputePipeline(device, layout_, kOcclusionReduceComp);
  pick_ = gpu::makeComputePipeline(device, layout_, kOcclusionPickComp);
  dispatch_ = gpu::makeComputePipeline(device, layout_, kOcclusionDispatchComp);
}

OcclusionPass::Target OcclusionPass::makeTarget(std::uint32_t width, std::uint32_t height,
                                                std::uint32_t samples) const {
  Target target{.width = width, .height = height, .samples = samples, .pyramid = {}, .set = {}};
  std::uint64_t texels = 0;
  for (std::uint32_t level = 0; level < ENSEMBLE_PYRAMID_LEVELS; ++level) texels += texelsOf(target, level);
  target.pyramid = gpu::Buffer(device_, texels * sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer,
                               gpu::Buffer::Kind::kDevice, "the depth pyramid");
  target.set = gpu::DescriptorSets(device_, set_layout_, kBindings, 1);
  return target;
}

void OcclusionPass::writeSet(const Target& target, const Buffers& buffers) const {
  const vk::DescriptorSet set = target.set[0];
  gpu::writeTexelBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_SEEN, buffers.seen);
  gpu::writeImage(device_, set, ENSEMBLE_BINDING_OCCLUSION_DEPTH, buffers.depth, &sampler_,
                  vk::ImageLayout::eShaderReadOnlyOptimal);
  gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_PYRAMID, target.pyramid);
  gpu::writeTexelBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_OCCLUDEES, buffers.occludees);
  gpu::writeTexelBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_BOXES, buffers.boxes);
  gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_ENTRIES, buffers.entries);
  gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_WORK, buffers.work);
  gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_GROUPS, buffers.groups);
  gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_OCCLUSION_BATCHES, buffers.batches);
}

void OcclusionPass::record(const vk::raii::CommandBuffer& commands, const Target& target,
                           const Round& round) const {
  const RasterPlan& plan = round.plan;
  const auto groups = static_cast<std::uint32_t>(plan.groups().size());
  Push push{.width = target.width,
            .height = target.height,
            .first_group = plan.firstLateGroup(),
            .group_count = groups - plan.firstLateGroup(),
            .face_bits = plan.faceBits(),
            .batch_count = static_cast<std::uint32_t>(plan.batches().size()),
            .triangles_per_group = round.triangles_per_group,
            .near_plane = round.near_plane,
            .hides = round.hides ? 1u : 0u};
  const auto dispatch = [&](const vk::raii::Pipeline& pipeline, std::uint32_t invocations) {
    gpu::recordComputeBarrier(commands);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
    commands.pushConstants<Push>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
    gpu::recordDispatch(commands, (invocations + ENSEMBLE_OCCLUSION_GROUP - 1) / ENSEMBLE_OCCLUSION_GROUP);
  };
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, target.set[0], nullptr);
  if (round.hides) {
    dispatch(tiles_[(target.samples > 1 ? 1u : 0u) + (round.drawn_hides ? 2u : 0u)], texelsOf(target, 0));
    for (push.level = 1; push.level < ENSEMBLE_PYRAMID_LEVELS; ++push.level)
      dispatch(reduce_, texelsOf(target, push.level));
  }
  dispatch(pick_, push.group_count);
  dispatch(dispatch_, push.batch_count);
  gpu::recordComputeBarrier(commands);
}

}  // namespace ensemble
