// Draws the environment into the targets of the other passes: shadow map, picture, AOVs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/crowd_draw.h"
#include "renderer/environment_assets.h"
#include "renderer/view_setup.h"

namespace ensemble {

/// What a pass draws of the environment.
struct EnvironmentQueue {
  std::vector<std::uint32_t> items;
  DrawCounts counts;
};

class EnvironmentPass {
 public:
  EnvironmentPass(const gpu::Device& device, const CrowdLayout& layout, const EnvironmentAssets& assets);

  /// Make the pipelines of a number of samples, and of the AOVs, once.
  void prepare(std::uint32_t samples);
  void prepareAovs();

  /// A queue that fill() never lets grow.
  EnvironmentQueue makeQueue() const;
  /// The pieces for which shows(box) holds, in draw order.
  template <class Shows>
  void fill(const Shows& shows, EnvironmentQueue& queue) const {
    queue.items.clear();
    queue.counts = {};
    for (std::uint32_t i = 0; i < assets_.items().size(); ++i) {
      const EnvironmentItem& item = assets_.items()[i];
      if (!shows(item.bounds)) continue;
      queue.items.push_back(i);
      queue.counts.triangles += item.index_count / 3;
    }
    queue.counts.draw_calls = queue.items.size();
  }

  /// Inside rendering, with the viewport set. Both sides of every face cast shadows: sets are often
  /// open where no camera looks.
  void recordShadow(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw,
                    VertexCounter& counter) const;
  void recordColor(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, std::uint32_t samples,
                   VertexCounter& counter) const;
  void recordAovs(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw) const;

 private:
  struct Recording {
    VertexCounter* counter = nullptr;  ///< null: count nothing
    bool both_sides = false;           ///< also of single-sided materials
  };
  template <class PipelineOf>
  void record(const vk::raii::CommandBuffer& commands, const CrowdDraw& draw, const Recording& recording,
              const PipelineOf& pipeline_of) const;
  vk::raii::Pipeline make(std::span<const std::uint32_t> vertex, std::span<const std::uint32_t> fragment,
                          PipelineOptions options) const;

  const gpu::Device& device_;
  const EnvironmentAssets& assets_;
  vk::raii::PipelineLayout layout_ = nullptr;
  VariantPipelines shadow_ = noPipelines(), aovs_ = noPipelines();
  std::array<VariantPipelines, 2> color_ = {noPipelines(), noPipelines()};
};

}  // namespace ensemble
