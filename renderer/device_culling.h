// Culling, queues and draws of a view by shaders: for frames in which nobody is drawn by the compute
// rasteriser, whose work the host plans. What comes out is what the host's way (view_setup, view_people,
// queue_buffers, CrowdState::queuePoses) would have given, to the last bit.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/device_queues.h"
#include "renderer/view_setup.h"

namespace ensemble {

class DeviceCulling {
 public:
  /// What it refers to must outlive it. @pre isPossible()
  DeviceCulling(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets, CrowdState& state);

  /// Whether the device has what it takes, and no buffer would grow beyond the limit.
  static bool isPossible(const gpu::Device& device, const CrowdAssets& assets, const CrowdState& state,
                         std::uint64_t max_buffer_bytes);

  /// Prepares for a tile; its picture's shadow map is drawn with the first. The device must be idle.
  void aim(const View& view, const Tile& tile, const ShadowFit& fit, bool draws_shadows);
  /// Records what aim() prepared: queues, draws, and the poses that CrowdState::recordPoses() is to compute.
  void record(const vk::raii::CommandBuffer& commands);

  const DeviceQueues& main() const { return main_; }
  const DeviceQueues& shadow() const { return shadow_; }  ///< as the first tile left it
  // After the frame.
  std::uint32_t peopleInPicture() const;
  std::uint32_t peoplePosed() const;

 private:
  /// Of a chunk of people.
  struct Chunk {
    gpu::Buffer bounds, heights;  // mapped
    gpu::Buffer poses;            // GpuPoseJob::key_matrix of whom shaders have posed
  };
  void createPipeline();
  void makeChunks();
  void recordCulling(const vk::raii::CommandBuffer& commands);
  std::uint32_t sumOf(std::initializer_list<std::size_t> pose_queues) const;

  gpu::Device& device_;
  CrowdState& state_;
  gpu::Buffer view_;  // GpuCulling, mapped
  std::vector<Chunk> chunks_;
  std::vector<gpu::Buffer> verdicts_;  // per chunk
  QueueKernels kernels_;
  QueueTables tables_;
  DeviceQueues main_, shadow_;
  QueueScan poses_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  gpu::DescriptorSets sets_;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
  bool draws_shadows_ = false, forgets_poses_ = false;
};

}  // namespace ensemble
