// Queues of people that shaders build: how many are in each, and who stands where, without an atomic that
// would decide an order (design 8).
//
// In four steps, each over all chunks of people and with a barrier behind it:
//
//     count   people in groups: how many of a group are in each queue, by a bit for each person
//     scan    for each queue: how many the groups before have; the length of all
//     place   where each queue begins, and what is made of its length: a draw, or a dispatch
//     fill    each person's number to its place: by group, and by the bits below its own
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/crowd_state.h"
#include "shaders/shared/queue_types.h"

namespace ensemble {

enum class QueueStep : std::uint8_t { kCount, kScan, kPlace, kFill };
inline constexpr QueueStep kAllQueueSteps[] = {QueueStep::kCount, QueueStep::kScan, QueueStep::kPlace,
                                               QueueStep::kFill};

/// The shaders of the steps: for queues of sub-meshes, and for those of poses.
class QueueKernels {
 public:
  enum class Kind : std::uint8_t { kSubMeshes, kPoses };

  explicit QueueKernels(const gpu::Device& device);

  gpu::DescriptorSets makeSets(const gpu::Device& device, std::uint32_t count) const;
  vk::PipelineLayout layout() const { return *layout_; }
  vk::Pipeline pipeline(Kind kind, QueueStep step) const;
  /// Storage buffers that a set has.
  static std::uint32_t bufferCount();

 private:
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  std::array<vk::raii::Pipeline, 4> sub_meshes_ = {nullptr, nullptr, nullptr, nullptr},
                                    poses_ = {nullptr, nullptr, nullptr, nullptr};
};

struct QueueScanOptions {
  QueueKernels::Kind kind = QueueKernels::Kind::kSubMeshes;
  std::uint32_t queue_count = 0;
  std::uint32_t verdict = 0;  ///< the bit of those who are queued; poses: 0
};

/// Counts and places of some queues, for each chunk of people.
class QueueScan {
 public:
  /// @param verdicts per chunk (cull.comp) @param kernels must outlive it
  QueueScan(gpu::Device& device, const QueueKernels& kernels, const CrowdState& state,
            std::span<const gpu::Buffer> verdicts, const QueueScanOptions& options);

  /// Bytes that the largest of its buffers takes for a number of people.
  static std::uint64_t bytesOf(std::uint32_t person_count, std::uint32_t queue_count);

  /// For what the kind has besides.
  vk::DescriptorSet set(std::size_t chunk) const { return sets_[chunk]; }
  void recordStep(const vk::raii::CommandBuffer& commands, QueueStep step) const;
  /// After all steps: brings totals to the host.
  void recordReadback(const vk::raii::CommandBuffer& commands) const;
  /// After the frame, of a chunk: #queues.
  std::span<const GpuQueueTotal> totals(std::size_t chunk) const;

 private:
  struct Chunk {
    gpu::Buffer counts, totals, readback;
    GpuQueuePush push{};
  };
  const QueueKernels& kernels_;
  QueueScanOptions options_;
  std::vector<Chunk> chunks_;
  gpu::DescriptorSets sets_;
};

/// Groups of people.
constexpr std::uint32_t queueGroups(std::uint32_t person_count) {
  return (person_count + ENSEMBLE_QUEUE_GROUP - 1) / ENSEMBLE_QUEUE_GROUP;
}
/// Ranges of queues that groups do one at a time.
constexpr std::uint32_t queueRanges(std::uint32_t queue_count) {
  return (queue_count + ENSEMBLE_QUEUE_RANGE - 1) / ENSEMBLE_QUEUE_RANGE;
}

}  // namespace ensemble
