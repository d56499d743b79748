// The renderer: a crowd in, pictures out. This header, view.h and frame_stats.h are its public face.
//
// The *state* at a time (people, poses) is shared by all views of a call; a *view* has a camera, a
// size, queues and targets of its own (design 6). A picture is a function of the scene, the time
// and the kind of device: not of what was rendered before, nor of the other views.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/environment_mesh.h"
#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/crowd.h"
#include "renderer/memory_budget.h"
#include "renderer/tile_grid.h"
#include "renderer/view.h"

namespace ensemble {

struct RendererOptions {
  bool validate = false;                      ///< collect what the validation layer says
  std::uint64_t memory_limit = 0;             ///< bytes on the device; 0: what it has
  std::shared_ptr<MemoryBudget> memory = {};  ///< given to several renderers: they keep the limit together
  std::uint64_t max_buffer_bytes = 128ull << 20;  ///< no buffer of a crowd grows beyond; more are made
  /// A buffer of the compute rasteriser's work: people whose work needs more are all the graphics pipeline's,
  /// or refused. How much work people are depends on the lanes of a subgroup, hence on the kind of device.
  std::uint64_t raster_work_bytes = 128ull << 20;
  /// Larger pictures are drawn tile by tile. These limits, not the device's, belong to what a picture is:
  /// where a tile begins decides how coordinates round, so that others move its last bits.
  TileLimits tiles = {};
};

/// How AOVs number garments. Regions of a template are 1, 2, ...
struct AovNumbers {
  std::uint32_t first_garment = 1;               ///< number of the first garment
  std::vector<std::string> garments;             ///< names, the wardrobes' one after the other
  std::vector<std::uint32_t> garment_wardrobes;  ///< per garment: index into Scene::wardrobes
};

class Renderer {
 public:
  /// Opens the best Vulkan device. @throws SystemError if there is none that will do.
  explicit Renderer(const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Makes the scene's crowd and brings all it wears onto the device; replaces what was loaded.
  /// Wardrobes and environment are not needed afterwards.
  /// @param wardrobes one for each of scene.wardrobes
  /// @param environment that of the scene; null where it names none
  /// @throws InputError as populateCrowd, or for a damaged texture; SystemError for what does not fit
  void load(const Scene& scene, std::span<const Wardrobe> wardrobes,
            const EnvironmentMesh* environment = nullptr);
  /// The same of a crowd that populateCrowd has made of the scene.
  void load(const Scene& scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
            Crowd crowd);

  /// Draws each view at a time in seconds. Two views in one call give exactly the pictures of two
  /// calls. Equal depths go to what is drawn first: garments, then body, in the lists' order.
  /// After the first call with the same views it allocates nothing on this thread.
  /// @param pictures one for each view @pre load() came before
  /// A picture larger than RendererOptions::tiles is drawn tile by tile, with the shadow map of the whole;
  /// its statistics are sums over the tiles.
  /// @throws SystemError if the device fails or a view does not fit
  void render(std::span<const View> views, double seconds, std::span<Picture> pictures);

  const Crowd& crowd() const;
  const AovNumbers& aovNumbers() const;
  std::string deviceName() const;
  bool isOnCpu() const;               ///< the device is software on the processor
  std::uint64_t memoryInUse() const;  ///< bytes on the device, of all renderers that share a MemoryBudget
  std::uint64_t memoryLimit() const;
  bool countsVertexInvocations() const;  ///< the device has pipeline statistics
  /// Messages of the validation layer so far; empty without `validate`.
  std::vector<std::string> validationMessages() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The name of the device that a Renderer would open, or "none". Never throws.
std::string deviceName() noexcept;

}  // namespace ensemble
