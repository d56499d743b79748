// The descriptor sets and the pipeline layout that all shaders that draw people share.
#pragma once

#include <cstdint>

#include "renderer/crowd_assets.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

class CrowdLayout {
 public:
  CrowdLayout(gpu::Device& device, const CrowdAssets& assets);

  const vk::raii::DescriptorSetLayout& viewLayout() const { return view_; }
  const vk::raii::PipelineLayout& pipelineLayout() const { return pipeline_layout_; }
  gpu::DescriptorSets makeViewSets(const gpu::Device& device, std::uint32_t count) const;
  gpu::DescriptorSets makeCrowdSets(const gpu::Device& device, std::uint32_t count) const;
  const vk::raii::DescriptorSetLayout& assetLayout() const { return assets_; }
  /// Materials and the source faces of an index chunk.
  vk::DescriptorSet assetSet(std::uint32_t index_chunk) const { return asset_sets_[index_chunk]; }

 private:
  vk::raii::DescriptorSetLayout view_ = nullptr, crowd_ = nullptr, assets_ = nullptr;
  vk::raii::PipelineLayout pipeline_layout_ = nullptr;
  gpu::DescriptorSets asset_sets_;
};

}  // namespace ensemble
