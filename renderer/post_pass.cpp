#include "renderer/post_pass.h"

#include "shaders/shared/crowd_types.h"
#include "spirv/post.comp.h"

namespace ensemble {
namespace {

constexpr std::initializer_list<vk::DescriptorType> kBindings = {vk::DescriptorType::eCombinedImageSampler,
                                                                 vk::DescriptorType::eStorageImage};

}  // namespace

PostPass::PostPass(const gpu::Device& device) {
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device, kBindings, vk::ShaderStageFlagBits::eCompute);
  layout_ = gpu::makePipelineLayout(device, std::array{*set_layout_});
  pipeline_ = gpu::makeComputePipeline(device, layout_, kPostComp);
}

gpu::DescriptorSets PostPass::makeSet(const gpu::Device& device, const ViewTargets& targets) const {
  gpu::DescriptorSets sets(device, set_layout_, kBindings, 1);
  gpu::writeImage(device, sets[0], ENSEMBLE_BINDING_POST_LINEAR, targets.linear, &sampler_,
                  vk::ImageLayout::eShaderReadOnlyOptimal);
  gpu::writeImage(device, sets[0], ENSEMBLE_BINDING_POST_SRGB, targets.srgb, nullptr,
                  vk::ImageLayout::eGeneral);
  return sets;
}

void PostPass::record(const vk::raii::CommandBuffer& commands, const ViewTargets& targets,
                      vk::DescriptorSet set, bool reads_linear) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  gpu::recordBarrier(commands, targets.srgb,
                     {.from_stage = Stage::eTransfer,
                      .to_stage = Stage::eComputeShader,
                      .to_access = Access::eShaderStorageWrite,
                      .to = vk::ImageLayout::eGeneral});
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, set, nullptr);
  commands.dispatch((targets.size.width + ENSEMBLE_POST_GROUP - 1) / ENSEMBLE_POST_GROUP,
                    (targets.size.height + ENSEMBLE_POST_ROWS - 1) / ENSEMBLE_POST_ROWS, 1);
  gpu::recordBarrier(commands, targets.srgb,
                     {.from_stage = Stage::eComputeShader,
                      .to_stage = Stage::eTransfer,
                      .from_access = Access::eShaderStorageWrite,
                      .to_access = Access::eTransferRead,
                      .from = vk::ImageLayout::eGeneral,
                      .to = vk::ImageLayout::eTransferSrcOptimal});
  targets.readback.record(commands, targets.srgb);
  if (!reads_linear) return;
  gpu::recordBarrier(commands, targets.linear,
                     {.from_stage = Stage::eComputeShader | Stage::eColorAttachmentOutput,
                      .to_stage = Stage::eTransfer,
                      .from_access = Access::eColorAttachmentWrite,
                      .to_access = Access::eTransferRead,
                      .from = vk::ImageLayout::eShaderReadOnlyOptimal,
                      .to = vk::ImageLayout::eTransferSrcOptimal});
  targets.linear_readback.record(commands, targets.linear);
}

}  // namespace ensemble
