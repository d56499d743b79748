#include "renderer/crowd_pipeline.h"

#include "shaders/shared/vertex.h"

namespace ensemble {
namespace {

constexpr vk::VertexInputBindingDescription kVertexBinding{
    .binding = 0, .stride = sizeof(GpuVertex), .inputRate = vk::VertexInputRate::eVertex};
constexpr std::array<vk::VertexInputAttributeDescription, 5> kVertexAttributes = {{
    {.location = ENSEMBLE_ATTRIBUTE_POSITION,
     .binding = 0,
     .format = vk::Format::eR32G32B32Sfloat,
     .offset = offsetof(GpuVertex, position)},
    {.location = ENSEMBLE_ATTRIBUTE_JOINTS,
     .binding = 0,
     .format = vk::Format::eR16G16B16A16Uint,
     .offset = offsetof(GpuVertex, joints)},
    {.location = ENSEMBLE_ATTRIBUTE_WEIGHTS,
     .binding = 0,
     .format = vk::Format::eR16G16B16A16Unorm,
     .offset = offsetof(GpuVertex, weights)},
    {.location = ENSEMBLE_ATTRIBUTE_UV,
     .binding = 0,
     .format = vk::Format::eR32G32Sfloat,
     .offset = offsetof(GpuVertex, uv)},
    {.location = ENSEMBLE_ATTRIBUTE_NORMAL,
     .binding = 0,
     .format = vk::Format::eR16G16Snorm,
     .offset = offsetof(GpuVertex, normal_oct)},
}};
constexpr vk::VertexInputBindingDescription kStaticBinding{
    .binding = 0, .stride = sizeof(GpuStaticVertex), .inputRate = vk::VertexInputRate::eVertex};
constexpr std::array<vk::VertexInputAttributeDescription, 3> kStaticAttributes = {{
    {.location = ENSEMBLE_ATTRIBUTE_POSITION,
     .binding = 0,
     .format = vk::Format::eR32G32B32Sfloat,
     .offset = offsetof(GpuStaticVertex, position)},
    {.location = ENSEMBLE_ATTRIBUTE_UV,
     .binding = 0,
     .format = vk::Format::eR32G32Sfloat,
     .offset = offsetof(GpuStaticVertex, uv)},
    {.location = ENSEMBLE_ATTRIBUTE_NORMAL,
     .binding = 0,
     .format = vk::Format::eR16G16Snorm,
     .offset = offsetof(GpuStaticVertex, normal_oct)},
}};
constexpr std::array<vk::DynamicState, 3> kDynamic = {vk::DynamicState::eViewport, vk::DynamicState::eScissor,
                                                      vk::DynamicState::eCullMode};

struct VariantData {
  vk::Bool32 textured, cut_out, hides_faces;
};
constexpr std::array<vk::SpecializationMapEntry, 3> kVariantEntries = {{
    {ENSEMBLE_CONSTANT_TEXTURED, offsetof(VariantData, textured), sizeof(vk::Bool32)},
    {ENSEMBLE_CONSTANT_CUT_OUT, offsetof(VariantData, cut_out), sizeof(vk::Bool32)},
    {ENSEMBLE_CONSTANT_HIDE_FACES, offsetof(VariantData, hides_faces), sizeof(vk::Bool32)},
}};

/// Shadows need position and skin alone, or the texture coordinates too where they discard.
vk::PipelineVertexInputStateCreateInfo vertexInputOf(const PipelineOptions& options) {
  if (!options.draws_people && !options.draws_environment) return {};
  const bool is_static = options.draws_environment;
  const std::uint32_t least = is_static ? 1 : 3, all = is_static ? 3 : 5;
  return {.vertexBindingDescriptionCount = 1,
          .pVertexBindingDescriptions = is_static ? &kStaticBinding : &kVertexBinding,
          .vertexAttributeDescriptionCount = !options.is_shadow        ? all
                                             : options.fragment_shader ? least + 1
                                                                       : least,
          .pVertexAttributeDescriptions = is_static ? kStaticAttributes.data() : kVertexAttributes.data()};
}

}  // namespace

VariantPipelines noPipelines() {
  return {nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr};
}

std::size_t variantIndex(ShaderVariant variant) {
  return (variant.textured ? 1u : 0u) + (variant.cut_out ? 2u : 0u) + (variant.hides_faces ? 4u : 0u);
}

vk::raii::Pipeline makePipeline(const gpu::Device& device, const vk::raii::PipelineLayout& layout,
                                const PipelineOptions& options) {
  const VariantData variant{options.variant.textured, options.variant.cut_out, options.variant.hides_faces};
  const vk::SpecializationInfo constants{.mapEntryCount = kVariantEntries.size(),
                                         .pMapEntries = kVariantEntries.data(),
                                         .dataSize = sizeof variant,
                                         .pData = &variant};
  const std::array<vk::PipelineShaderStageCreateInfo, 2> stages = {{
      {.stage = vk::ShaderStageFlagBits::eVertex, .module = options.vertex_shader, .pName = "main"},
      {.stage = vk::ShaderStageFlagBits::eFragment,
       .module = options.fragment_shader,
       .pName = "main",
       .pSpecializationInfo = &constants},
  }};
  const vk::PipelineVertexInputStateCreateInfo vertex_input = vertexInputOf(options);
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::PipelineViewportStateCreateInfo viewport{.viewportCount = 1, .scissorCount = 1};
  const vk::PipelineRasterizationStateCreateInfo raster{
      .depthClampEnable = options.is_shadow,
      .polygonMode = vk::PolygonMode::eFill,
      .frontFace = vk::FrontFace::eCounterClockwise,
      .depthBiasEnable = options.is_shadow,
      .depthBiasSlopeFactor = options.is_shadow ? kShadowSlopeBias : 0.0f,
      .lineWidth = 1.0f};
  const vk::PipelineMultisampleStateCreateInfo multisample{
      .rasterizationSamples = static_cast<vk::SampleCountFlagBits>(options.samples)};
  const vk::PipelineDepthStencilStateCreateInfo depth{.depthTestEnable = true,
                                                      .depthWriteEnable = options.writes_depth,
                                                      .depthCompareOp = options.depth_compare};
  using Component = vk::ColorComponentFlagBits;
  const std::vector<vk::PipelineColorBlendAttachmentState> blends(
      options.color_formats.size(),
      {.blendEnable = options.adds,
       .srcColorBlendFactor = vk::BlendFactor::eOne,
       .dstColorBlendFactor = vk::BlendFactor::eOne,
       .srcAlphaBlendFactor = vk::BlendFactor::eOne,
       .dstAlphaBlendFactor = vk::BlendFactor::eOne,
       .colorWriteMask = Component::eR | Component::eG | Component::eB | Component::eA});
  const vk::PipelineColorBlendStateCreateInfo blend{
      .attachmentCount = static_cast<std::uint32_t>(blends.size()), .pAttachments = blends.data()};
  const vk::PipelineDynamicStateCreateInfo dynamic{.dynamicStateCount = kDynamic.size(),
                                                   .pDynamicStates = kDynamic.data()};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = static_cast<std::uint32_t>(options.color_formats.size()),
      .pColorAttachmentFormats = options.color_formats.data(),
      .depthAttachmentFormat = vk::Format::eD32Sfloat};
  return ENSEMBLE_VK(
      vk::raii::Pipeline(device.handle(), nullptr,
                         vk::GraphicsPipelineCreateInfo{.pNext = &rendering,
                                                        .stageCount = options.fragment_shader ? 2u : 1u,
                                                        .pStages = stages.data(),
                                                        .pVertexInputState = &vertex_input,
                                                        .pInputAssemblyState = &assembly,
                                                        .pViewportState = &viewport,
                                                        .pRasterizationState = &raster,
                                                        .pMultisampleState = &multisample,
                                                        .pDepthStencilState = &depth,
                                                        .pColorBlendState = &blend,
                                                        .pDynamicState = &dynamic,
                                                        .layout = *layout}));
}

}  // namespace ensemble
