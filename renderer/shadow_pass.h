// The shadow map: people and the environment as the sun sees them.
#pragma once

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

class ShadowPass {
 public:
  ShadowPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Draws the queues' people and environment into the shadow map and makes it readable by fragment shaders.
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              VertexCounter& counter, std::uint32_t counted_pass) const;

 private:
  static ShaderVariant variantFor(const DrawState& state);
  VariantPipelines pipelines_ = noPipelines();
};

}  // namespace ensemble
