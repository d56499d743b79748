// Graphics pipelines of this renderer: what they share, and what differs from pass to pass.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

inline constexpr float kShadowSlopeBias = -1.5f;  ///< away from the sun, whose depth is 1

/// What a pipeline's fragment shader does with a draw state; specialisation constants.
struct ShaderVariant {
  bool textured = false, cut_out = false, hides_faces = false;
  auto operator<=>(const ShaderVariant&) const = default;
};

/// Where only the shape matters: a texture is read as far as it cuts out.
inline ShaderVariant shapeVariant(const DrawState& state) {
  return {.textured = state.textured && state.cut_out, .cut_out = state.cut_out, .hides_faces = false};
}

struct PipelineOptions {
  vk::ShaderModule vertex_shader = {};
  vk::ShaderModule fragment_shader = {};  ///< null: depth only
  ShaderVariant variant = {};
  bool draws_people = true;        ///< vertices are GpuVertex; else the shader makes its own
  bool draws_environment = false;  ///< vertices are GpuStaticVertex, whatever draws_people says
  std::span<const vk::Format> color_formats = {};
  bool adds = false;  ///< to the colours that are there, instead of replacing them
  std::uint32_t samples = 1;
  vk::CompareOp depth_compare = vk::CompareOp::eGreater;  ///< reversed depth
  bool writes_depth = true;
  bool is_shadow = false;  ///< depth is clamped and biased
};

/// Viewport, scissor and cull mode are dynamic. Depth is D32.
vk::raii::Pipeline makePipeline(const gpu::Device& device, const vk::raii::PipelineLayout& layout,
                                const PipelineOptions& options);

/// The pipelines of a pass by variant; those that nothing needs are null.
using VariantPipelines = std::array<vk::raii::Pipeline, 8>;
VariantPipelines noPipelines();
std::size_t variantIndex(ShaderVariant variant);

template <class Make>
void makeIfMissing(VariantPipelines& pipelines, ShaderVariant variant, const Make& make) {
  vk::raii::Pipeline& pipeline = pipelines[variantIndex(variant)];
  if (!*pipeline) pipeline = make(variant);
}

}  // namespace ensemble
