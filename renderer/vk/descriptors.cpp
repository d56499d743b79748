#include "renderer/vk/descriptors.h"

#include "shaders/shared/crowd_types.h"

namespace ensemble::gpu {

vk::raii::DescriptorSetLayout makeSetLayout(const Device& device,
                                            std::initializer_list<vk::DescriptorType> types,
                                            vk::ShaderStageFlags stages) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (const vk::DescriptorType type : types) {
    bindings.push_back({.binding = static_cast<std::uint32_t>(bindings.size()),
                        .descriptorType = type,
                        .descriptorCount = 1,
                        .stageFlags = stages});
  }
  return ENSEMBLE_VK(vk::raii::DescriptorSetLayout(
      device.handle(),
      vk::DescriptorSetLayoutCreateInfo{.bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                        .pBindings = bindings.data()}));
}

DescriptorSets::DescriptorSets(const Device& device, const vk::raii::DescriptorSetLayout& layout,
                               std::initializer_list<vk::DescriptorType> types, std::uint32_t count) {
  if (count == 0) return;
  std::vector<vk::DescriptorPoolSize> sizes;
  for (const vk::DescriptorType type : types) sizes.push_back({.type = type, .descriptorCount = count});
  pool_ = ENSEMBLE_VK(vk::raii::DescriptorPool(
      device.handle(),
      vk::DescriptorPoolCreateInfo{.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                   .maxSets = count,
                                   .poolSizeCount = static_cast<std::uint32_t>(sizes.size()),
                                   .pPoolSizes = sizes.data()}));
  const std::vector<vk::DescriptorSetLayout> layouts(count, *layout);
  sets_ = ENSEMBLE_VK(vk::raii::DescriptorSets(
      device.handle(),
      vk::DescriptorSetAllocateInfo{
          .descriptorPool = *pool_, .descriptorSetCount = count, .pSetLayouts = layouts.data()}));
}

void writeBuffer(const Device& device, vk::DescriptorSet set, std::uint32_t binding, const Buffer& buffer,
                 vk::DescriptorType type) {
  const vk::DescriptorBufferInfo info = buffer.descriptor();
  device.handle().updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = set,
                                                              .dstBinding = binding,
                                                              .descriptorCount = 1,
                                                              .descriptorType = type,
                                                              .pBufferInfo = &info},
                                       nullptr);
}

void writeTexelBuffer(const Device& device, vk::DescriptorSet set, std::uint32_t binding,
                      const vk::raii::BufferView& view) {
  const vk::BufferView handle = *view;
  device.handle().updateDescriptorSets(
      vk::WriteDescriptorSet{.dstSet = set,
                             .dstBinding = binding,
                             .descriptorCount = 1,
                             .descriptorType = vk::DescriptorType::eUniformTexelBuffer,
                             .pTexelBufferView = &handle},
      nullptr);
}

void writeImage(const Device& device, vk::DescriptorSet set, std::uint32_t binding, const Image& image,
                const vk::raii::Sampler* sampler, vk::ImageLayout layout) {
  const vk::DescriptorImageInfo info{
      .sampler = sampler ? **sampler : vk::Sampler{}, .imageView = image.view(), .imageLayout = layout};
  device.handle().updateDescriptorSets(
      vk::WriteDescriptorSet{.dstSet = set,
                             .dstBinding = binding,
                             .descriptorCount = 1,
                             .descriptorType = sampler ? vk::DescriptorType::eCombinedImageSampler
                                                       : vk::DescriptorType::eStorageImage,
                             .pImageInfo = &info},
      nullptr);
}

vk::raii::PipelineLayout makePipelineLayout(const Device& device,
                                            std::span<const vk::DescriptorSetLayout> sets,
                                            std::uint32_t push_bytes, vk::ShaderStageFlags stages) {
  const vk::PushConstantRange push{.stageFlags = stages, .offset = 0, .size = push_bytes};
  return ENSEMBLE_VK(vk::raii::PipelineLayout(
      device.handle(), vk::PipelineLayoutCreateInfo{.setLayoutCount = static_cast<std::uint32_t>(sets.size()),
                                                    .pSetLayouts = sets.data(),
                                                    .pushConstantRangeCount = push_bytes > 0 ? 1u : 0u,
                                                    .pPushConstantRanges = &push}));
}

vk::raii::ShaderModule makeShader(const Device& device, std::span<const std::uint32_t> spirv) {
  return ENSEMBLE_VK(vk::raii::ShaderModule(
      device.handle(), vk::ShaderModuleCreateInfo{.codeSize = spirv.size_bytes(), .pCode = spirv.data()}));
}

vk::raii::Pipeline makeComputePipeline(const Device& device, const vk::raii::PipelineLayout& layout,
                                       std::span<const std::uint32_t> spirv,
                                       const vk::SpecializationInfo* constants) {
  const vk::raii::ShaderModule shader = makeShader(device, spirv);
  return ENSEMBLE_VK(
      vk::raii::Pipeline(device.handle(), nullptr,
                         vk::ComputePipelineCreateInfo{.stage = {.stage = vk::ShaderStageFlagBits::eCompute,
                                                                 .module = *shader,
                                                                 .pName = "main",
                                                                 .pSpecializationInfo = constants},
                                                       .layout = *layout}));
}

void recordDispatch(const vk::raii::CommandBuffer& commands, std::uint32_t group_count) {
  if (group_count == 0) return;
  const std::uint32_t rows = (group_count + ENSEMBLE_MOST_GROUPS_X - 1) / ENSEMBLE_MOST_GROUPS_X;
  commands.dispatch((group_count + rows - 1) / rows, rows, 1);
}

}  // namespace ensemble::gpu
