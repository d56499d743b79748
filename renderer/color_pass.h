// The picture: garments, bodies, environment, ground and sky, in linear light, resolved.
#pragma once

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

class ColorPass {
 public:
  ColorPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Makes the pipelines of a number of samples, once.
  void prepare(std::uint32_t samples);
  /// Draws a view and leaves `targets.linear` readable by compute shaders, and if `keep` is set
  /// `targets.depth` and `targets.samples` too. @pre prepared
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              const View& view, VertexCounter& counter, std::uint32_t counted_pass, bool keep) const;

 private:
  struct Pipelines {
    VariantPipelines people = noPipelines();
    vk::raii::Pipeline ground = nullptr, sky = nullptr;
  };
  const Pipelines& pipelinesFor(std::uint32_t samples) const { return pipelines_[samples > 1 ? 1 : 0]; }
  static ShaderVariant variantFor(const DrawState& state) {
    return {.textured = state.textured, .cut_out = state.cut_out, .hides_faces = false};
  }
  void recordBackground(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                        const View& view) const;

  const gpu::Device& device_;
  const CrowdLayout& layout_;
  const CrowdAssets& assets_;
  std::array<Pipelines, 2> pipelines_;
};

}  // namespace ensemble
