// From the linear picture to sRGB, and to the host.
#pragma once

#include "renderer/view_targets.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

class PostPass {
 public:
  explicit PostPass(const gpu::Device& device);

  /// A descriptor set for some targets.
  gpu::DescriptorSets makeSet(const gpu::Device& device, const ViewTargets& targets) const;
  /// @param reads_linear the linear picture too goes to the host. @pre targets.addLinearReadback() then
  void record(const vk::raii::CommandBuffer& commands, const ViewTargets& targets, vk::DescriptorSet set,
              bool reads_linear) const;

 private:
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace ensemble
