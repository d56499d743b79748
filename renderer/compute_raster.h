// Our own rasteriser of small triangles, in compute shaders: into a buffer of (depth, id) for each pixel,
// from which the pixels where somebody is in front are listed, sorted by the buffers and textures that they
// need, and shaded. The shadow map gets its depths by the same rasteriser.
//
// It draws the people that ViewPeople gives it; all others the graphics pipeline does, and the two meet by
// depth.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_extents.h"
#include "renderer/crowd_layout.h"
#include "renderer/crowd_state.h"
#include "renderer/occlusion_bounds.h"
#include "renderer/occlusion_pass.h"
#include "renderer/pose_pool.h"
#include "renderer/raster_items.h"
#include "renderer/raster_people.h"
#include "renderer/raster_plan.h"
#include "renderer/view_targets.h"

namespace ensemble {

struct ComputeRasterOptions {
  std::uint64_t pose_cache_bytes = 0;
  std::uint64_t work_bytes = 0;  ///< of a buffer of an eye's work, at most
  std::uint64_t max_buffer_bytes = 0;
};

class ComputeRaster {
 public:
  /// What to see people from: the camera or the sun.
  enum class Eye : std::uint8_t { kCamera, kSun };
  /// What is drawn: the picture, AOVs (from the camera, one sample), the shadow map, or how often triangles
  /// cover each pixel (from the camera, one sample).
  enum class Pass : std::uint8_t { kPicture, kAovs, kShadow, kOverdraw };

  /// Somebody with a pose of its own.
  struct OwnPerson {
    std::uint32_t number = 0, combination = 0;
    PlanPose pose;
  };

  /// One eye's people and work, and the buffers they go through.
  struct Work {
    Eye eye = Eye::kCamera;
    std::unique_ptr<RasterPlan> plan;
    std::vector<PlanPerson> people;  ///< who is between key frames has a key beyond them all, of its own
    std::vector<OwnPerson> own;      ///< those, in this order
    bool drawn_hides = false;        ///< what the graphics pipeline draws may hide people
    std::uint32_t number = 0;        ///< changes when a buffer is another one
    gpu::Buffer rows, who, entries, work, groups;
    /// Of the second round: per person GpuOccludee; per batch GpuRasterBatch.
    gpu::Buffer occludees, batches;
    vk::raii::BufferView rows_view = nullptr, who_view = nullptr, occludees_view = nullptr;
  };

  /// What a pass draws into, with a view's slot.
  struct Target {
    Pass pass = Pass::kPicture;
    std::uint32_t width = 0, height = 0, samples = 1;
    /// From the camera: depth and id of each sample; from the sun: depth of a texel. Overdraw: counts,
    /// mapped.
    gpu::Buffer visible;
    gpu::Buffer pixels, shaded, bins;
    vk::raii::BufferView seen_view = nullptr, listed_view = nullptr;  ///< of `visible` and `pixels`
    gpu::DescriptorSets sets;  ///< per pair of buffers and buffer of poses
    gpu::DescriptorSets aov_set;
    OcclusionPass::Target occlusion;
    std::uint32_t work_number = 0, pose_buffers = 0;
  };

  /// What it refers to must outlive it. @pre device.canRasterise()
  ComputeRaster(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets,
                const CrowdState& state, const CrowdExtents& extents, const ComputeRasterOptions& options);

  /// People whom ids can tell apart.
  std::size_t mostPeople() const { return std::size_t{1} << (32 - camera_.plan->faceBits()); }

  /// Whether triangles that nearer people hide are to be left out.
  struct Occlusion {
    bool is_on = false;
    bool drawn_hides = false;  ///< the graphics pipeline draws what may hide people
  };

  void beginFrame() { poses_.beginFrame(); }
  /// Arranges an eye's work; asks for no pose yet. @param numbers of people in the crowd, ascending
  /// @return whether the work fits the device's buffers; if not, there is none
  [[nodiscard]] bool arrange(Eye eye, const ScreenRows& rows, const CrowdState& state,
                             const ViewPeople& shown, std::span<const std::uint32_t> numbers,
                             const Occlusion& occlusion);
  /// Plans what was arranged, of the same people: asks for their poses, and tells the device. Who is between
  /// key frames has its palette queued.
  void plan(Eye eye, const ScreenRows& rows, const CrowdState& state, const ViewPeople& shown,
            std::span<const std::uint32_t> numbers);
  /// @throws SystemError always: what to do where work doesn't fit
  [[noreturn]] void refuseWork() const;
  bool hasWork(Eye eye) const { return !workOf(eye).people.empty(); }
  /// What was drawn of the plan; once the device is done with it.
  std::uint64_t triangleCount(Eye eye) const;
  /// What was left out of it; likewise.
  std::uint64_t hiddenTriangleCount(Eye eye) const;
  /// That rasterise.
  std::uint64_t dispatchCount(Eye eye) const { return hasWork(eye) ? workOf(eye).plan->batches().size() : 0; }
  const PosePool& poses() const { return poses_; }

  Target makeTarget(Pass pass, const ViewTargets& targets);
  /// Makes sets right for the work that was planned. @pre the device is idle
  void prepare(const ViewTargets& targets, Target& target);

  /// Skins what poses are new; before the first of the others.
  void recordPoses(const vk::raii::CommandBuffer& commands) { poses_.record(commands); }
  /// Clears the target and rasterises.
  void record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set, const Target& target,
              float near_plane);
  /// Fills the shadow map with what record() left, in layout eTransferDstOptimal, and leaves it there.
  static void recordShadowMap(const vk::raii::CommandBuffer& commands, const ViewTargets& targets,
                              const Target& target);
  /// Shades into `targets.linear` where people are in front of `targets.depth`; these, and `targets.samples`
  /// if there is one, as ColorPass leaves them for shaders.
  void recordColor(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                   const ViewTargets& targets, const Target& target, const View& view) const;
  /// The same into the images of the AOVs, in layout eGeneral, against `targets.aov_depth`.
  void recordAovs(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set, const Target& target,
                  float near_plane) const;

 private:
  struct Push;

  static Eye eyeOf(Pass pass) { return pass == Pass::kShadow ? Eye::kSun : Eye::kCamera; }
  Work& workOf(Eye eye) { return eye == Eye::kCamera ? camera_ : sun_work_; }
  const Work& workOf(Eye eye) const { return eye == Eye::kCamera ? camera_ : sun_work_; }
  const vk::raii::Pipeline& rasterPipeline(const Target& target, const RasterItems::State& state) const;
  void createPipelines();
  void placeWork(Work& work, const CrowdState& state);
  /// Who is far away is left to the second round.
  void chooseRounds(Work& work, const ScreenRows& rows, const CrowdState& state,
                    std::span<const std::uint32_t> numbers);
  /// Of the largest buffer that the work needs.
  std::uint64_t workBytes(const Work& work) const;
  /// Makes room for as many bytes; true if the buffer is another one now.
  bool grow(Work& work, gpu::Buffer& buffer, std::uint64_t bytes, vk::BufferUsageFlags usage);
  void upload(Work& work, const ScreenRows& rows, const CrowdState& state,
              std::span<const std::uint32_t> numbers);
  void uploadOccludees(Work& work, const ScreenRows& rows, const CrowdState& state, const ViewPeople& shown,
                       std::span<const std::uint32_t> numbers);
  void writeSets(const Work& work, const ViewTargets& targets, Target& target) const;
  std::uint32_t binCount() const;
  /// @throws SystemError if the entries of listed pixels have no room for them
  void refuseTooManyBins() const;
  Push pushFor(const Target& target, float near_plane) const;
  std::uint32_t hasWideIndices(std::uint32_t pair) const;
  /// Lists and shades, band by band: `bind` binds all for one bin's pixels, `finish` ends a band.
  void recordBatch(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set, const Target& target,
                   const PlanBatch& batch, Push& push) const;
  void recordOcclusion(const vk::raii::CommandBuffer& commands, const Target& target, float near_plane,
                       Work& work) const;
  template <class Bind, class Finish>
  void recordBands(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set, const Target& target,
                   float near_plane, const Bind& bind, const Finish& finish) const;
  void recordList(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set, const Target& target,
                  const Push& push) const;

  gpu::Device& device_;
  const CrowdLayout& layout_;
  const CrowdAssets& assets_;
  ComputeRasterOptions options_;
  PosePool poses_;
  RasterItems items_;
  vk::raii::BufferView materials_view_ = nullptr, tints_view_ = nullptr;
  Work camera_, sun_work_;
  OcclusionPass occlusion_;
  gpu::Buffer boxes_;  // of CrowdExtents
  vk::raii::BufferView boxes_view_ = nullptr;
  std::vector<float> distances_, sorted_distances_;  // of the work at hand
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr, aov_layout_ = nullptr;
  vk::raii::PipelineLayout pipeline_layout_ = nullptr, aov_pipeline_layout_ = nullptr;
  /// Pipelines that depend on the number of samples: of one, of four.
  struct Sampled {
    vk::raii::Pipeline raster = nullptr, cut_out_raster = nullptr, list = nullptr;
    std::array<vk::raii::Pipeline, 4> color = {nullptr, nullptr, nullptr,
                                               nullptr};  ///< textured: 1, shadows: 2
  };
  const Sampled& sampled(const Target& target) const { return sampled_[target.samples > 1 ? 1 : 0]; }
  std::array<Sampled, 2> sampled_;
  std::array<vk::raii::Pipeline, 2> overdraw_ = {nullptr, nullptr};  // cut out: 1
  std::array<vk::raii::Pipeline, 4> sun_ = {nullptr, nullptr, nullptr,
                                            nullptr};  // cut out: 1, hides faces: 2
  vk::raii::Pipeline count_bins_ = nullptr, sort_ = nullptr, resolve_ = nullptr, aov_ = nullptr;
};

}  // namespace ensemble
