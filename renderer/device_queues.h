// One pass's render queues as shaders build them, and the indirect draws that they become: those of
// QueueBuffers, which the host builds, bit by bit. A batch's draws lie from where its first sub-mesh stands,
// and how many they are stands in a buffer.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/crowd_assets.h"
#include "renderer/crowd_layout.h"
#include "renderer/queue_buffers.h"
#include "renderer/queue_scan.h"

namespace ensemble {

/// What combinations show and how it is drawn, for the shaders; one for all passes.
struct QueueTables {
  QueueTables(gpu::Device& device, const CrowdAssets& assets);

  gpu::Buffer
      ranges;  ///< per combination, range after range: where its sub-meshes begin; one more at the end
  gpu::Buffer shown;
  gpu::Buffer items;               ///< GpuQueueItem
  std::vector<DrawBatch> batches;  ///< each with all its sub-meshes
  /// Bytes that the largest of them takes.
  static std::uint64_t bytesOf(const CrowdAssets& assets);
};

class DeviceQueues {
 public:
  /// What it refers to must outlive it. @param verdict the bit of those who are queued
  DeviceQueues(gpu::Device& device, const QueueKernels& kernels, const QueueTables& tables,
               const CrowdLayout& layout, const CrowdAssets& assets, const CrowdState& state,
               std::span<const gpu::Buffer> verdicts, std::uint32_t verdict);

  const QueueScan& scan() const { return scan_; }

  /// What one chunk of the crowd draws.
  struct Chunk {
    gpu::Buffer entries, draws, commands;
    gpu::Buffer draw_counts;  ///< per batch
  };
  const std::vector<Chunk>& chunks() const { return chunks_; }
  const std::vector<DrawBatch>& batches() const { return tables_.batches; }
  vk::DescriptorSet set(std::size_t chunk) const { return sets_[chunk]; }
  /// After the frame.
  DrawCounts counts() const;

 private:
  const QueueTables& tables_;
  const CrowdAssets& assets_;
  QueueScan scan_;
  std::vector<Chunk> chunks_;
  gpu::DescriptorSets sets_;
};

}  // namespace ensemble
