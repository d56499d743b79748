#include "renderer/device_culling.h"

#include <fmt/format.h>

#include <algorithm>

#include "spirv/cull.comp.h"

namespace ensemble {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Usage = vk::BufferUsageFlagBits;

constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
/// In the order of ENSEMBLE_BINDING_CULL_...
constexpr std::initializer_list<vk::DescriptorType> kBindings = {
    vk::DescriptorType::eUniformBuffer, kStorage, kStorage, kStorage, kStorage, kStorage, kStorage};

static_assert(sizeof(Sphere) == sizeof(vec4) && offsetof(Sphere, radius) == 12);

std::vector<gpu::Buffer> makeVerdicts(gpu::Device& device, const CrowdState& state) {
  std::vector<gpu::Buffer> verdicts;
  for (const CrowdChunk& people : state.chunks()) {
    verdicts.emplace_back(device, people.count * sizeof(std::uint32_t), Usage::eStorageBuffer,
                          gpu::Buffer::Kind::kDevice, fmt::format("the verdicts on {} people", people.count));
  }
  return verdicts;
}

}  // namespace

bool DeviceCulling::isPossible(const gpu::Device& device, const CrowdAssets& assets, const CrowdState& state,
                               std::uint64_t max_buffer_bytes) {
  const auto queues = static_cast<std::uint32_t>(assets.items().size());
  if (!device.canCountDraws() || queues == 0 || state.chunks().empty()) return false;
  if (device.limits().maxPerStageDescriptorStorageBuffers < QueueKernels::bufferCount()) return false;
  if (assets.shown().size() > ENSEMBLE_MOST_COMBINATIONS) return false;
  if (QueueTables::bytesOf(assets) > max_buffer_bytes) return false;
  const auto& most_groups = device.limits().maxComputeWorkGroupCount;
  return std::all_of(state.chunks().begin(), state.chunks().end(), [&](const CrowdChunk& people) {
    return QueueScan::bytesOf(people.count, queues) <= max_buffer_bytes &&
           queueGroups(people.count) <= most_groups[0] && queueRanges(queues) <= most_groups[1];
  });
}

DeviceCulling::DeviceCulling(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets,
                             CrowdState& state)
    : device_(device),
      state_(state),
      view_(device, sizeof(GpuCulling), Usage::eUniformBuffer, gpu::Buffer::Kind::kUpload,
            "what people are culled by"),
      verdicts_(makeVerdicts(device, state)),
      kernels_(device),
      tables_(device, assets),
      main_(device, kernels_, tables_, layout, assets, state, verdicts_, ENSEMBLE_VERDICT_SEEN),
      shadow_(device, kernels_, tables_, layout, assets, state, verdicts_, ENSEMBLE_VERDICT_CASTS),
      poses_(device, kernels_, state, verdicts_,
             {.kind = QueueKernels::Kind::kPoses, .queue_count = ENSEMBLE_POSE_QUEUES}) {
  createPipeline();
  makeChunks();
}

void DeviceCulling::createPipeline() {
  constexpr auto kCompute = vk::ShaderStageFlagBits::eCompute;
  set_layout_ = gpu::makeSetLayout(device_, kBindings, kCompute);
  sets_ = gpu::DescriptorSets(device_, set_layout_, kBindings,
                              static_cast<std::uint32_t>(state_.chunks().size()));
  layout_ = gpu::makePipelineLayout(device_, std::array{*set_layout_}, sizeof(GpuQueuePush));
  pipeline_ = gpu::makeComputePipeline(device_, layout_, kCullComp);
}

void DeviceCulling::makeChunks() {
  for (std::size_t i = 0; i < state_.chunks().size(); ++i) {
    const CrowdChunk& people = state_.chunks()[i];
    Chunk& chunk = chunks_.emplace_back();
    const auto make = [&](std::uint64_t bytes, vk::BufferUsageFlags usage, gpu::Buffer::Kind kind,
                          const char* what) {
      return gpu::Buffer(device_, people.count * bytes, Usage::eStorageBuffer | usage, kind,
                         fmt::format("the {} of {} people", what, people.count));
    };
    chunk.bounds = make(sizeof(Sphere), {}, gpu::Buffer::Kind::kUpload, "bounds");
    chunk.heights = make(sizeof(float), {}, gpu::Buffer::Kind::kUpload, "heights");
    chunk.poses =
        make(sizeof(std::uint32_t), Usage::eTransferDst, gpu::Buffer::Kind::kDevice, "kinds of pose");
    std::ranges::copy(state_.heights().subspan(people.first, people.count),
                      chunk.heights.mapped<float>().begin());
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_VIEW, view_,
                     vk::DescriptorType::eUniformBuffer);
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_CHARACTERS, people.characters);
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_CLIPS, state_.clips());
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_BOUNDS, chunk.bounds);
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_HEIGHTS, chunk.heights);
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_POSES, chunk.poses);
    gpu::writeBuffer(device_, sets_[i], ENSEMBLE_BINDING_CULL_VERDICTS, verdicts_[i]);
    const vk::DescriptorSet posed = poses_.set(i);
    gpu::writeBuffer(device_, posed, ENSEMBLE_BINDING_QUEUE_ENTRIES, people.pose_queue);
    gpu::writeBuffer(device_, posed, ENSEMBLE_BINDING_QUEUE_POSES, chunk.poses);
    gpu::writeBuffer(device_, posed, ENSEMBLE_BINDING_QUEUE_POSE_HEAD, people.pose_head);
  }
}

void DeviceCulling::aim(const View& view, const Tile& tile, const ShadowFit& fit, bool draws_shadows) {
  draws_shadows_ = draws_shadows;
  if (state_.letDeviceQueue()) {  // a new time: walkers have moved
    forgets_poses_ = true;
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
      const CrowdChunk& people = state_.chunks()[i];
      std::copy_n(state_.bounds().begin() + people.first, people.count,
                  chunks_[i].bounds.mapped<Sphere>().begin());
    }
  }
  const Frustum in_picture = frustumOf(view), in_tile = frustumOf(view, tile);
  const CasterRule casters = casterRuleOf(fit);
  const SmallPeople small_people = smallPeopleOf(view);
  GpuCulling culling{};
  std::ranges::copy(in_picture.planes, culling.picture);
  std::ranges::copy(in_tile.planes, culling.tile);
  culling.shadow_x = casters.across_x;
  culling.shadow_y = casters.across_y;
  culling.shadow_scale = casters.scale;
  culling.eye = small_people.eye;
  culling.pixels = small_people.pixels;
  culling.snap_squared = small_people.below_squared;
  culling.has_shadows = view.light.shadows ? 1 : 0;
  culling.poses_casters = draws_shadows ? 1 : 0;
  view_.mapped<GpuCulling>()[0] = culling;
}

void DeviceCulling::recordCulling(const vk::raii::CommandBuffer& commands) {
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const std::uint32_t people = state_.chunks()[i].count;
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, sets_[i], nullptr);
    commands.pushConstants<GpuQueuePush>(*layout_, vk::ShaderStageFlagBits::eCompute, 0,
                                         GpuQueuePush{people, 0, 0, 0});
    commands.dispatch(queueGroups(people), 1, 1);
  }
}

void DeviceCulling::record(const vk::raii::CommandBuffer& commands) {
  constexpr auto readers = Stage::eDrawIndirect | Stage::eVertexShader | Stage::eFragmentShader |
                           Stage::eComputeShader | Stage::eTransfer;
  // What read the last frame's queues is done before they are written anew.
  gpu::recordBarrier(commands, readers, Access::eShaderStorageWrite, Stage::eComputeShader | Stage::eTransfer,
                     Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eTransferWrite);
  if (std::exchange(forgets_poses_, false)) {
    for (const Chunk& chunk : chunks_) commands.fillBuffer(chunk.poses.handle(), 0, VK_WHOLE_SIZE, kNoPose);
    gpu::recordBarrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader,
                       Access::eShaderStorageRead | Access::eShaderStorageWrite);
  }
  recordCulling(commands);
  for (const QueueStep step : kAllQueueSteps) {
    gpu::recordComputeBarrier(commands);
    main_.scan().recordStep(commands, step);
    if (draws_shadows_) shadow_.scan().recordStep(commands, step);
    poses_.recordStep(commands, step);
  }
  gpu::recordBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, readers,
                     Access::eIndirectCommandRead | Access::eShaderStorageRead | Access::eTransferRead);
  main_.scan().recordReadback(commands);
  if (draws_shadows_) shadow_.scan().recordReadback(commands);
  poses_.recordReadback(commands);
  gpu::recordBarrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eHost, Access::eHostRead);
}

std::uint32_t DeviceCulling::sumOf(std::initializer_list<std::size_t> pose_queues) const {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    for (const std::size_t queue : pose_queues) sum += poses_.totals(i)[queue].count;
  }
  return sum;
}

std::uint32_t DeviceCulling::peopleInPicture() const { return sumOf({ENSEMBLE_COUNTED_POSE_QUEUE}); }

std::uint32_t DeviceCulling::peoplePosed() const { return sumOf({0, 1}); }

}  // namespace ensemble
