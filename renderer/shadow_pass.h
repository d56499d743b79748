// The shadow map: people and the environment as the sun sees them.
#pragma once

#include <functional>

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

class ShadowPass {
 public:
  ShadowPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Draws the queues' people and environment into the shadow map and makes it readable by shaders.
  /// @param fill records what is in it already, with the map in layout eTransferDstOptimal; null: nothing is
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              VertexCounter& counter, std::uint32_t counted_pass, const std::function<void()>& fill) const;

 private:
  static ShaderVariant variantFor(const DrawState& state);
  VariantPipelines pipelines_ = noPipelines();
};

}  // namespace ensemble
