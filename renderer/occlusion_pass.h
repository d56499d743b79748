// Occlusion culling in the compute rasteriser: the nearest people are drawn first, a pyramid of the least
// depths is made of what they and the graphics pipeline left, and of the others those runs of triangles are
// left out that lie behind it. A pixel keeps the greatest depth, in whatever order: this changes no pixel.
//
// After Greene, Kass and Miller, "Hierarchical Z-Buffer Visibility" (SIGGRAPH 1993), section 3.2. Departure:
// instead of an octree, boxes of runs of triangles that hold over a clip; and occluders are the nearest
// people, not what the frame before showed, so that a frame is a function of its time.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/raster_plan.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

class OcclusionPass {
 public:
  explicit OcclusionPass(gpu::Device& device);

  /// With a target of the rasteriser.
  struct Target {
    std::uint32_t width = 0, height = 0, samples = 1;
    gpu::Buffer pyramid;
    gpu::DescriptorSets set;
  };
  Target makeTarget(std::uint32_t width, std::uint32_t height, std::uint32_t samples) const;

  /// What the passes read and write, by ENSEMBLE_BINDING_OCCLUSION_...
  struct Buffers {
    const vk::raii::BufferView &seen, &occludees, &boxes;
    const gpu::Image& depth;
    const gpu::Buffer &entries, &work, &groups, &batches;
  };
  void writeSet(const Target& target, const Buffers& buffers) const;

  struct Round {
    const RasterPlan& plan;
    std::uint32_t triangles_per_group = 0;
    float near_plane = 0.0f;
    bool hides = true;        ///< false: everything is drawn
    bool drawn_hides = true;  ///< what the graphics pipeline drew hides people, too
  };
  /// Between the two rounds: from the samples of the first to the groups and the indirect dispatches of the
  /// second. @pre where the batches say is room for these groups, which holds ENSEMBLE_NO_WORK
  void record(const vk::raii::CommandBuffer& commands, const Target& target, const Round& round) const;

 private:
  gpu::Device& device_;
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  std::array<vk::raii::Pipeline, 4> tiles_ = {nullptr, nullptr, nullptr, nullptr};  ///< samples: 1, drawn: 2
  vk::raii::Pipeline reduce_ = nullptr, pick_ = nullptr, dispatch_ = nullptr;
};

}  // namespace ensemble
