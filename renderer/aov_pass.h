// Numbers, depth and normals of what shows at each pixel's centre.
#pragma once

#include <functional>

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

class AovPass {
 public:
  AovPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Draws all AOVs and copies those that the view asks for. @pre targets.addAovs()
  /// @param more records what else is drawn, into images in layout eGeneral by compute shaders; null: nothing
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              const View& view, const std::function<void()>& more) const;

 private:
  void recordDraws(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const View& view) const;

  const CrowdLayout& layout_;
  VariantPipelines people_ = noPipelines();
  vk::raii::Pipeline ground_ = nullptr;
};

}  // namespace ensemble
