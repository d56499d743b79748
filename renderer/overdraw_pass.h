// How often the graphics pipeline's triangles of people cover each pixel, hidden ones as well.
#pragma once

#include "renderer/crowd_draw.h"
#include "renderer/view_targets.h"

namespace ensemble {

class OverdrawPass {
 public:
  OverdrawPass(const gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets);

  /// Counts the people in the queues, one sample a pixel, into targets.overdraw and its readback: half
  /// floats, exact up to 2,048. @pre targets.addOverdraw()
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const ViewTargets& targets,
              const View& view) const;

  /// Once it is drawn: what was counted of targets.tile.
  /// @param computed what the compute rasteriser has counted, per pixel of the target; empty: nothing
  /// @param counts of the picture, per pixel
  static void collect(const ViewTargets& targets, const View& view, std::span<const std::uint32_t> computed,
                      std::span<std::uint32_t> counts);

 private:
  VariantPipelines pipelines_ = noPipelines();
};

}  // namespace ensemble
