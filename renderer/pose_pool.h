// Skinned vertices of meshes at key frames, on the device: made when first asked for and kept (pose cache).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/key_frames.h"
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
  };

  /// What it refers to must outlive it. @param budget_bytes kept from frame to frame
  PosePool(gpu::Device& device, const CrowdAssets& assets, const KeyFrames& frames,
           const gpu::Image& animation_texture, std::uint64_t budget_bytes, std::uint64_t max_buffer_bytes);

  void beginFrame();
  /// Where a mesh's vertices at a key are, or will be after the next record().
  PlanPose require(std::uint32_t mesh, std::uint32_t key);
  /// Makes buffers for what was required; returns whether there are new ones. @throws SystemError if they
  /// don't fit
  bool prepare();
  /// Skins what is new. Readable by compute shaders afterwards. The device must be done with the last.
  void record(const vk::raii::CommandBuffer& commands);

  const std::vector<PoseBuffer>& buffers() const { return buffers_; }
  /// Where each pose is: buffer << ENSEMBLE_POSE_OFFSET_BITS | first vertex, at firstPose(mesh) + key.
  const vk::raii::BufferView& table() const { return table_view_; }
  std::uint32_t firstPose(std::uint32_t mesh) const { return first_pose_[mesh]; }
  const PoseCacheStats& stats() const { return cache_.stats(); }
  std::uint64_t skinnedVertices() const { return skinned_vertices_; }  ///< since beginFrame

 private:
  struct Job {
    std::uint32_t vertex_chunk = 0, buffer = 0;
    GpuSkinJob gpu{};
  };
  static PoseCacheLimits limitsFor(const CrowdAssets& assets, const KeyFrames& frames,
                                   std::uint64_t budget_bytes, std::uint64_t max_buffer_bytes);
  void createPipeline();
  void makeRoomForJobs();

  gpu::Device& device_;
  const CrowdAssets& assets_;
  const KeyFrames& frames_;
  const gpu::Image& animation_texture_;
  PoseCacheLimits limits_;
  PoseCache cache_;
  std::vector<std::uint32_t> first_pose_;  // per mesh; wraps around
  gpu::Buffer table_;
  vk::raii::BufferView table_view_ = nullptr;
  std::vector<PoseBuffer> buffers_;
  std::vector<Job> jobs_;
  std::uint64_t group_count_ = 0, skinned_vertices_ = 0;
  gpu::Buffer gpu_jobs_, gpu_groups_;
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace ensemble
