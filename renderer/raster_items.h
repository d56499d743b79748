// What people show as the compute rasteriser has it: tables that stay as long as the scene.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_extents.h"
#include "renderer/pose_pool.h"
#include "renderer/raster_plan.h"

namespace ensemble {

class RasterItems {
 public:
  /// Chunks of indices and vertices that items are in.
  struct Pair {
    std::uint32_t index_chunk = 0, vertex_chunk = 0;
    auto operator<=>(const Pair&) const = default;
  };
  /// Items of a bin are shaded with the same buffers and textures bound.
  struct Bin {
    std::uint32_t pair = 0, texture_set = 0;
    bool textured = false;
    auto operator<=>(const Bin&) const = default;
  };
  /// What is bound to rasterise items.
  struct State {
    std::uint32_t pair = 0;
    bool cut_out = false;
    bool hides_faces = false;       ///< naive: hidden faces cast no shadow
    std::uint32_t texture_set = 0;  ///< of cut-outs, else 0
    auto operator<=>(const State&) const = default;
  };

  RasterItems(gpu::Device& device, const CrowdAssets& assets, const PosePool& poses);

  const std::vector<Pair>& pairs() const { return pairs_; }
  const std::vector<Bin>& bins() const { return bins_; }
  const std::vector<State>& states() const { return states_; }
  /// Items as the camera sees them, or the sun. Their states become known.
  std::vector<PlanItem> planItems(const CrowdExtents& extents, bool to_sun);
  /// Per combination.
  const std::vector<std::vector<ShownItem>>& shown(bool to_sun) const { return to_sun ? casting_ : shown_; }
  const vk::raii::BufferView& view() const { return items_view_; }       ///< GpuRasterItem
  const vk::raii::BufferView& shownView() const { return shown_view_; }  ///< as raster_pixels.glsl has it

 private:
  void makeItems(gpu::Device& device, const PosePool& poses);
  void makeShown(gpu::Device& device, const PosePool& poses);
  std::uint32_t pairOf(const DrawItem& item);

  const CrowdAssets& assets_;
  std::vector<Pair> pairs_;
  std::vector<Bin> bins_;
  std::vector<State> states_;
  std::vector<std::vector<ShownItem>> shown_, casting_;
  gpu::Buffer items_, shown_buffer_;
  vk::raii::BufferView items_view_ = nullptr, shown_view_ = nullptr;
};

}  // namespace ensemble
