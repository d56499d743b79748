// Sengupta, Harris, Zhang, Owens, "Scan Primitives for GPU Computing": counts of groups, their sums, places.
//
// Departure: who comes before whom within a group is read from a mask of bits, one for each person, which
// atomics may set in any order.
#include "renderer/queue_scan.h"

#include <fmt/format.h>

#include "core/check.h"
#include "spirv/pose_count.comp.h"
#include "spirv/pose_dispatch.comp.h"
#include "spirv/pose_fill.comp.h"
#include "spirv/queue_count.comp.h"
#include "spirv/queue_draws.comp.h"
#include "spirv/queue_fill.comp.h"
#include "spirv/queue_scan.comp.h"

namespace ensemble {
namespace {

constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
/// In the order of ENSEMBLE_BINDING_QUEUE_...; each kind leaves those of the other empty.
constexpr std::initializer_list<vk::DescriptorType> kBindings = {kStorage, kStorage, kStorage, kStorage,
                                                                 kStorage, kStorage, kStorage, kStorage,
                                                                 kStorage, kStorage, kStorage, kStorage};

}  // namespace

QueueKernels::QueueKernels(const gpu::Device& device) {
  constexpr auto kCompute = vk::ShaderStageFlagBits::eCompute;
  set_layout_ = gpu::makeSetLayout(device, kBindings, kCompute);
  layout_ = gpu::makePipelineLayout(device, std::array{*set_layout_}, sizeof(GpuQueuePush));
  const auto make = [&](std::span<const std::uint32_t> spirv) {
    return gpu::makeComputePipeline(device, layout_, spirv);
  };
  sub_meshes_ = {make(kQueueCountComp), make(kQueueScanComp), make(kQueueDrawsComp), make(kQueueFillComp)};
  poses_ = {make(kPoseCountComp), make(kQueueScanComp), make(kPoseDispatchComp), make(kPoseFillComp)};
}

gpu::DescriptorSets QueueKernels::makeSets(const gpu::Device& device, std::uint32_t count) const {
  return {device, set_layout_, kBindings, count};
}

vk::Pipeline QueueKernels::pipeline(Kind kind, QueueStep step) const {
  return *(kind == Kind::kSubMeshes ? sub_meshes_ : poses_)[static_cast<std::size_t>(step)];
}

std::uint32_t QueueKernels::bufferCount() { return static_cast<std::uint32_t>(kBindings.size()); }

QueueScan::QueueScan(gpu::Device& device, const QueueKernels& kernels, const CrowdState& state,
                     std::span<const gpu::Buffer> verdicts, const QueueScanOptions& options)
    : kernels_(kernels), options_(options), chunks_(state.chunks().size()) {
  using Usage = vk::BufferUsageFlagBits;
  ENSEMBLE_CHECK(verdicts.size() == chunks_.size());
  sets_ = kernels.makeSets(device, static_cast<std::uint32_t>(chunks_.size()));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    Chunk& chunk = chunks_[i];
    const std::uint32_t people = state.chunks()[i].count;
    const std::uint64_t total_bytes = options.queue_count * sizeof(GpuQueueTotal);
    chunk.push = {.person_count = people,
                  .group_count = queueGroups(people),
                  .queue_count = options.queue_count,
                  .verdict = options.verdict};
    chunk.counts = gpu::Buffer(device, bytesOf(people, options.queue_count), Usage::eStorageBuffer,
                               gpu::Buffer::Kind::kDevice,
                               fmt::format("the queues' lengths by group of {} people", people));
    chunk.totals = gpu::Buffer(device, total_bytes, Usage::eStorageBuffer | Usage::eTransferSrc,
                               gpu::Buffer::Kind::kDevice, "the queues' lengths");
    chunk.readback = gpu::Buffer(device, total_bytes, Usage::eTransferDst, gpu::Buffer::Kind::kReadback,
                                 "the queues' lengths");
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_QUEUE_VERDICTS, verdicts[i]);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_QUEUE_COUNTS, chunk.counts);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_QUEUE_TOTALS, chunk.totals);
  }
}

std::uint64_t QueueScan::bytesOf(std::uint32_t person_count, std::uint32_t queue_count) {
  return std::uint64_t{queueGroups(person_count)} * queue_count * sizeof(std::uint32_t);
}

void QueueScan::recordStep(const vk::raii::CommandBuffer& commands, QueueStep step) const {
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, kernels_.pipeline(options_.kind, step));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const GpuQueuePush& push = chunks_[i].push;
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, kernels_.layout(), 0, sets_[i], nullptr);
    commands.pushConstants<GpuQueuePush>(kernels_.layout(), vk::ShaderStageFlagBits::eCompute, 0, push);
    switch (step) {
      case QueueStep::kCount:
      case QueueStep::kFill:
        commands.dispatch(push.group_count, queueRanges(push.queue_count), 1);
        break;
      case QueueStep::kScan:
        commands.dispatch((push.queue_count + ENSEMBLE_SCAN_QUEUES - 1) / ENSEMBLE_SCAN_QUEUES, 1, 1);
        break;
      case QueueStep::kPlace:
        commands.dispatch(1, 1, 1);
        break;
    }
  }
}

void QueueScan::recordReadback(const vk::raii::CommandBuffer& commands) const {
  for (const Chunk& chunk : chunks_) {
    commands.copyBuffer(chunk.totals.handle(), chunk.readback.handle(),
                        vk::BufferCopy{.srcOffset = 0, .dstOffset = 0, .size = chunk.totals.size()});
  }
}

std::span<const GpuQueueTotal> QueueScan::totals(std::size_t chunk) const {
  return chunks_[chunk].readback.mapped<GpuQueueTotal>().first(options_.queue_count);
}

}  // namespace ensemble
