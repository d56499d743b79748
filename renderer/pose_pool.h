// Skinned vertices on the device, for the compute rasteriser: of meshes at key frames, made when first asked
// for and kept (pose cache), and of people between key frames, for one frame: mixed from two kept poses where
// that is all that their pose takes, else skinned by their palette.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_state.h"
#include "renderer/own_poses.h"
#include "renderer/pose_cache.h"
#include "renderer/raster_plan.h"
#include "renderer/vk/descriptors.h"

namespace ensemble {

class PosePool {
 public:
  struct PoseBuffer {
    gpu::Buffer vertices;  ///< two 32-bit words each (raster_types.h)
    vk::raii::BufferView texels = nullptr;
    gpu::DescriptorSets skin_sets;  ///< per chunk of vertices
    gpu::DescriptorSets mix_set;    ///< to read it when poses are mixed
  };

  /// What it refers to must outlive it. @param budget_bytes kept from frame to frame
  PosePool(gpu::Device& device, const CrowdAssets& assets, const CrowdState& state,
           std::uint64_t budget_bytes, std::uint64_t max_buffer_bytes);

  void beginFrame();
  /// Where a mesh's vertices at a key are, or will be after the next record().
  PlanPose require(std::uint32_t mesh, std::uint32_t key);
  /// Where somebody's own vertices are, or will be: those of all meshes that it wears, one behind the other.
  PlanPose requireOwn(std::uint32_t person);
  /// Whether the device must have somebody's palette by then, from CrowdState.
  static bool needsPalette(const CrowdState& state, std::uint32_t person) {
    return !betweenKeys(state.keyFrames(), state.characters()[person]);
  }
  /// Where a mesh begins among the own vertices of who wears a combination. @pre the combination shows it
  std::uint32_t firstOwnVertex(std::uint32_t combination, std::uint32_t mesh) const;
  /// The box that somebody's own vertices are kept in, and rows from there to the world.
  struct OwnPlace {
    KeptBox box;
    vec4 world_from_box[3];
  };
  OwnPlace ownPlace(std::uint32_t person) const;

  /// Makes buffers for what was required; returns whether there are new ones. @throws SystemError if they
  /// don't fit
  bool prepare();
  /// Skins what is new. Readable by compute shaders afterwards. The device must be done with the last.
  void record(const vk::raii::CommandBuffer& commands);

  const std::vector<PoseBuffer>& buffers() const { return buffers_; }
  /// Where each kept pose is: buffer << ENSEMBLE_POSE_OFFSET_BITS | first vertex, at firstPose(mesh) + key.
  const vk::raii::BufferView& table() const { return table_view_; }
  std::uint32_t firstPose(std::uint32_t mesh) const { return first_pose_[mesh]; }
  const PoseCacheStats& stats() const { return cache_.stats(); }
  const OwnPoses& own() const { return own_; }
  std::uint64_t skinnedVertices() const { return skinned_vertices_; }  ///< since beginFrame

 private:
  enum class JobKind : std::uint8_t { kKey, kMix, kPalette };  ///< in the order in which they are done
  struct Job {
    JobKind kind = JobKind::kKey;
    std::uint32_t buffer = 0;
    std::uint32_t from = 0, and_from = 0;  ///< chunk of vertices, and of people; mixed: buffers of both poses
    GpuSkinJob gpu{};
    auto place() const { return std::tie(kind, buffer, from, and_from); }
  };
  /// A mesh among the own vertices of who wears a combination.
  struct WornMesh {
    std::uint32_t mesh = 0, first_vertex = 0;
  };
  static std::vector<std::vector<WornMesh>> findWorn(const CrowdAssets& assets);
  std::uint32_t ownVertexCount(std::uint32_t combination) const;
  std::uint32_t chooseBufferVertices(std::uint64_t max_buffer_bytes) const;
  void numberPoses();
  void createPipelines();
  void addJob(const Job& job);
  void mixOwn(const BetweenKeys& keys, std::uint32_t mesh, std::uint32_t buffer, std::uint32_t first_vertex);
  void skinOwn(std::uint32_t person, std::uint32_t mesh, std::uint32_t buffer, std::uint32_t first_vertex);
  static std::uint32_t numberOf(std::vector<std::uint32_t>& numbers, std::uint32_t own_number,
                                std::uint32_t& count);
  void makeRoomForJobs();
  void recordJobs(const vk::raii::CommandBuffer& commands, std::size_t first, std::size_t end,
                  std::uint32_t& group);

  gpu::Device& device_;
  const CrowdAssets& assets_;
  const CrowdState& state_;
  std::vector<std::vector<WornMesh>> worn_;  // per combination
  std::uint32_t buffer_vertices_;
  PoseCache cache_;
  OwnPoses own_;
  std::vector<std::uint32_t> first_pose_;  // per mesh; wraps around
  gpu::Buffer table_;
  vk::raii::BufferView table_view_ = nullptr;
  // The cache's buffers and those of own poses have one numbering, in the order in which they became needed.
  std::vector<std::uint32_t> numbers_of_kept_, numbers_of_own_;
  std::uint32_t buffer_count_ = 0;
  std::vector<PoseBuffer> buffers_;
  std::vector<Job> jobs_;
  std::uint64_t group_count_ = 0, skinned_vertices_ = 0;
  gpu::Buffer gpu_jobs_, gpu_groups_;
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr, matrices_layout_ = nullptr, mix_layout_ = nullptr;
  gpu::DescriptorSets matrices_sets_;  // per chunk of people
  vk::raii::PipelineLayout layout_ = nullptr, mix_pipeline_layout_ = nullptr;
  vk::raii::Pipeline key_pipeline_ = nullptr, own_pipeline_ = nullptr, mix_pipeline_ = nullptr;
};

}  // namespace ensemble
