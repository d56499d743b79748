// Descriptor sets made in one go: a layout, a pool that fits, and writes.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "renderer/vk/memory.h"

namespace ensemble::gpu {

/// Bindings 0, 1, 2, ... of the given types, one descriptor each.
vk::raii::DescriptorSetLayout makeSetLayout(const Device& device,
                                            std::initializer_list<vk::DescriptorType> types,
                                            vk::ShaderStageFlags stages);

/// @param push_bytes of push constants, for these stages; 0: none
vk::raii::PipelineLayout makePipelineLayout(const Device& device,
                                            std::span<const vk::DescriptorSetLayout> sets,
                                            std::uint32_t push_bytes = 0,
                                            vk::ShaderStageFlags stages = vk::ShaderStageFlagBits::eCompute);

/// `count` sets of one layout, with the pool that they live in.
class DescriptorSets {
 public:
  DescriptorSets() = default;
  DescriptorSets(const Device& device, const vk::raii::DescriptorSetLayout& layout,
                 std::initializer_list<vk::DescriptorType> types, std::uint32_t count);
  ~DescriptorSets() = default;
  DescriptorSets(DescriptorSets&&) noexcept = default;
  /// The old sets go before their pool does.
  DescriptorSets& operator=(DescriptorSets&& other) noexcept {
    sets_ = std::move(other.sets_);
    pool_ = std::move(other.pool_);
    return *this;
  }

  vk::DescriptorSet operator[](std::size_t i) const { return *sets_[i]; }
  std::size_t size() const { return sets_.size(); }

 private:
  vk::raii::DescriptorPool pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;
};

void writeBuffer(const Device& device, vk::DescriptorSet set, std::uint32_t binding, const Buffer& buffer,
                 vk::DescriptorType type = vk::DescriptorType::eStorageBuffer);
void writeTexelBuffer(const Device& device, vk::DescriptorSet set, std::uint32_t binding,
                      const vk::raii::BufferView& view);
/// @param sampler null for a storage image
void writeImage(const Device& device, vk::DescriptorSet set, std::uint32_t binding, const Image& image,
                const vk::raii::Sampler* sampler, vk::ImageLayout layout);

/// A shader module of embedded SPIR-V.
vk::raii::ShaderModule makeShader(const Device& device, std::span<const std::uint32_t> spirv);

/// @param constants null: the shader's defaults
vk::raii::Pipeline makeComputePipeline(const Device& device, const vk::raii::PipelineLayout& layout,
                                       std::span<const std::uint32_t> spirv,
                                       const vk::SpecializationInfo* constants = nullptr);

/// Dispatches groups in as few rows along y as a device can have; shaders/group_number.glsl counts them, and
/// the shader leaves what is beyond the count.
void recordDispatch(const vk::raii::CommandBuffer& commands, std::uint32_t group_count);

}  // namespace ensemble::gpu
