// Graphics pipelines of this renderer: what they share, and what differs from pass to pass.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

/// What a pipeline's fragment shader does with a draw state; specialisation constants.
struct ShaderVariant {
  bool textured = false, cut_out = false, hides_faces = false;
  auto operator<=>(const ShaderVariant&) const = default;
};

struct PipelineOptions {
  vk::ShaderModule vertex_shader;
  vk::ShaderModule fragment_shader;  ///< null: depth only
  ShaderVariant variant;
  bool draws_people = true;          ///< vertices as in vertex.h; else the shader makes its own
  std::span<const vk::Format> color_formats;
  std::uint32_t samples = 1;
  vk::CompareOp depth_compare = vk::CompareOp::eGreater;  ///< reversed depth
  bool writes_depth = true;
  bool is_shadow = false;            ///< depth is clamped and biased
};

/// Viewport, scissor and cull mode are dynamic. Depth is D32.
vk::raii::Pipeline makePipeline(const gpu::Device& device, const vk::raii::PipelineLayout& layout,
                                const PipelineOptions& options);

/// A pipeline for each variant that a pass may need; made when first asked for.
template <class Make>
const vk::raii::Pipeline& variantOf(std::array<vk::raii::Pipeline, 8>& pipelines, ShaderVariant variant,
                                    const Make& make) {
  const std::size_t index = (variant.textured ? 1u : 0u) + (variant.cut_out ? 2u : 0u) + (variant.hides_faces ? 4u : 0u);
  if (!*pipelines[index]) pipelines[index] = make(variant);
  return pipelines[index];
}

}  // namespace ensemble
