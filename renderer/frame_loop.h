// A frame's stages in order: state, queues, shadow, colour, AOVs, sRGB, host.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/aov_pass.h"
#include "renderer/color_pass.h"
#include "renderer/compute_raster.h"
#include "renderer/coverage_pass.h"
#include "renderer/crowd_assets.h"
#include "renderer/crowd_extents.h"
#include "renderer/crowd_state.h"
#include "renderer/device_culling.h"
#include "renderer/environment_pass.h"
#include "renderer/overdraw_pass.h"
#include "renderer/part_timer.h"
#include "renderer/post_pass.h"
#include "renderer/queue_buffers.h"
#include "renderer/shadow_pass.h"
#include "renderer/view_setup.h"
#include "renderer/view_targets.h"

namespace ensemble {

struct FrameLimits {
  std::uint64_t max_buffer_bytes = 0;
  std::uint64_t pose_cache_bytes = 0;
  std::uint64_t raster_work_bytes = 0;
  TileLimits tiles = {};
};

class FrameLoop {
 public:
  /// @param environment null where there is none
  /// @param extents none: everybody is drawn by the graphics pipeline
  FrameLoop(gpu::Device& device, const CrowdAssets& assets, CrowdState& state,
            const EnvironmentAssets* environment, std::optional<CrowdExtents> extents,
            const FrameLimits& limits);

  /// Draws views at a time, one after the other. @throws SystemError if targets don't fit
  void render(std::span<const View> views, double seconds, std::span<Picture> pictures);

 private:
  /// Targets of one size, kept for the next frame.
  struct Slot {
    ViewTargets targets;
    gpu::Buffer view_buffer;
    gpu::DescriptorSets view_set, post_set;
    ComputeRaster::Target computed, computed_shadow, computed_aovs,
        computed_overdraw;  // made when first needed
  };
  enum Pass : std::uint32_t { kShadow, kMain, kEnvironmentShadow, kEnvironmentMain, kPassCount };

  Slot& slotFor(const View& view, const TileGrid& grid, std::uint32_t shadow_size);
  /// Draws a view at the state's time, tile by tile; `start` is when its turn came.
  void drawView(const View& view, std::chrono::steady_clock::time_point start, Picture& picture);
  /// The same with what View::debug lays over the picture, for which AOVs may be drawn besides.
  void drawDebugged(const View& view, std::chrono::steady_clock::time_point start, Picture& picture);
  /// Finds who is in sight and who casts shadows, and decides how they are drawn.
  void choosePeople(const View& view, const ShadowFit& fit);
  /// @throws SystemError if a view asks for the compute rasteriser and can't have it
  void requireCompute() const;
  std::size_t mostComputed() const { return compute_ ? compute_->mostPeople() : 0; }
  /// Whether a view's people are culled and queued by shaders: where nobody can be the compute rasteriser's,
  /// and nothing else needs to know of them on the host.
  bool cullsOnDevice(const View& view) const;
  /// Finds who is in a tile, and arranges what compute draws of it. @return whether that fits its buffers
  [[nodiscard]] bool arrangeTile(const View& view, const Tile& tile);
  /// Arranges all tiles, before any is drawn.
  /// @return whether they fit; if one does not, the pipeline draws them all
  [[nodiscard]] bool arrangeTiles(const View& view, const TileGrid& grid);
  /// Queues and plans a tile. @pre it is the only one, and arranged, or all fit
  void buildQueues(const View& view, const Tile& tile);
  /// @throws SystemError unless the view lets us choose
  void leaveToPipeline(const View& view, const std::vector<std::uint32_t>& people,
                       std::vector<std::uint32_t>& computed, std::vector<std::uint32_t>& others) const;
  void buildShadowQueues(const View& view, const ShadowFit& fit);
  /// Queues the palettes of those whom the pipeline draws and of those whom compute skins by them.
  std::uint32_t queuePoses(const std::vector<std::uint32_t>& drawn,
                           const std::vector<std::uint32_t>& computed);
  void prepareCompute(const View& view, Slot& slot);
  void record(const View& view, const Slot& slot, bool draws_shadows);
  void recordShadows(const View& view, const Slot& slot);
  void recordAovs(const View& view, const Slot& slot);
  /// Adds what each person would cover of a tile.
  void countCoverage(const View& view, const Slot& slot, std::vector<std::uint32_t>& pixels);
  /// Counts how often people's triangles cover each pixel of a tile.
  void countOverdraw(const View& view, Slot& slot);
  void submitAndWait();
  /// Adds what the last submission drew.
  void addStats(bool drew_shadows, FrameStats& stats) const;
  bool computes(ComputeRaster::Eye eye) const { return compute_ && compute_->hasWork(eye); }

  gpu::Device& device_;
  const CrowdAssets& assets_;
  CrowdState& state_;
  const EnvironmentAssets* environment_;
  FrameLimits limits_;
  CrowdLayout layout_;
  ShadowPass shadow_pass_;
  ColorPass color_pass_;
  PostPass post_pass_;
  std::unique_ptr<AovPass> aov_pass_;            // made when first asked for
  std::unique_ptr<CoveragePass> coverage_pass_;  // likewise
  std::unique_ptr<OverdrawPass> overdraw_pass_;  // likewise
  std::unique_ptr<ComputeRaster> compute_;       // null where it can't be
  std::unique_ptr<DeviceCulling> culling_;       // made when first needed
  bool can_cull_on_device_ = false;
  bool culls_on_device_ = false;  // the view at hand
  std::unique_ptr<EnvironmentPass> environment_pass_;
  EnvironmentQueue main_environment_, shadow_environment_;
  QueueBuffers main_queues_, shadow_queues_;
  VertexCounter counter_;
  PartTimer timer_;
  vk::raii::Sampler shadow_sampler_ = nullptr;
  vk::raii::CommandPool pool_ = nullptr;
  vk::raii::CommandBuffer commands_ = nullptr;
  vk::raii::Fence fence_ = nullptr;
  std::vector<std::unique_ptr<Slot>> slots_;  // oldest first
  std::vector<std::uint32_t> overdraw_;       // of the view at hand, per pixel
  ViewPeople shown_;
  CrowdExtents extents_;                          // of nothing where everybody is the pipeline's
  std::vector<std::uint32_t> visible_, casters_;  // all of them; the rest are parts of these
  std::vector<std::uint32_t> near_, computed_, near_casters_, computed_casters_, skinned_;
  std::vector<std::uint32_t> first_of_chunk_;  // per chunk of people: the number of its first
};

}  // namespace ensemble
