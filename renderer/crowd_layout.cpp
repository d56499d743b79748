#include "renderer/crowd_layout.h"

#include <array>

namespace ensemble {
namespace {

constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
constexpr std::initializer_list<vk::DescriptorType> kViewBindings = {
    vk::DescriptorType::eUniformBuffer, vk::DescriptorType::eCombinedImageSampler};
constexpr std::initializer_list<vk::DescriptorType> kCrowdBindings = {
    kStorage, vk::DescriptorType::eUniformTexelBuffer, kStorage, kStorage};
constexpr std::initializer_list<vk::DescriptorType> kAssetBindings = {kStorage, kStorage, kStorage, kStorage,
                                                                      kStorage};
constexpr auto kStages =
    vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eCompute;

}  // namespace

CrowdLayout::CrowdLayout(gpu::Device& device, const CrowdAssets& assets)
    : view_(gpu::makeSetLayout(device, kViewBindings, kStages)),
      crowd_(gpu::makeSetLayout(device, kCrowdBindings, kStages)),
      assets_(gpu::makeSetLayout(device, kAssetBindings, kStages)) {
  // In the order of ENSEMBLE_SET_...
  const std::array<vk::DescriptorSetLayout, 4> layouts = {*view_, *crowd_, *assets_,
                                                          *assets.textures().layout()};
  pipeline_layout_ =
      gpu::makePipelineLayout(device, layouts, sizeof(std::uint32_t), vk::ShaderStageFlagBits::eVertex);
  asset_sets_ = gpu::DescriptorSets(device, assets_, kAssetBindings,
                                    static_cast<std::uint32_t>(assets.indexChunkCount()));
  for (std::uint32_t i = 0; i < assets.indexChunkCount(); ++i) {
    gpu::writeBuffer(device, asset_sets_[i], ENSEMBLE_BINDING_MATERIALS, assets.materials());
    gpu::writeBuffer(device, asset_sets_[i], ENSEMBLE_BINDING_TINTS, assets.tints());
    gpu::writeBuffer(device, asset_sets_[i], ENSEMBLE_BINDING_HIDDEN_FIRST, assets.hiddenFirst());
    gpu::writeBuffer(device, asset_sets_[i], ENSEMBLE_BINDING_HIDDEN_WORDS, assets.hiddenWords());
    gpu::writeBuffer(device, asset_sets_[i], ENSEMBLE_BINDING_SOURCE_FACES,
                     assets.indexChunk(i).source_faces);
  }
}

gpu::DescriptorSets CrowdLayout::makeViewSets(const gpu::Device& device, std::uint32_t count) const {
  return {device, view_, kViewBindings, count};
}

gpu::DescriptorSets CrowdLayout::makeCrowdSets(const gpu::Device& device, std::uint32_t count) const {
  return {device, crowd_, kCrowdBindings, count};
}

}  // namespace ensemble
