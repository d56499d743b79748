#include "renderer/pose_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "spirv/skin_pose.comp.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kVertexBytes = 8;
constexpr std::uint64_t kMostBufferBytes = 64ull << 20;
constexpr std::initializer_list<vk::DescriptorType> kSkinBindings = {
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
    vk::DescriptorType::eUniformTexelBuffer, vk::DescriptorType::eCombinedImageSampler,
    vk::DescriptorType::eStorageBuffer};

struct Push {
  std::uint32_t first_group, group_count;
};

}  // namespace

PosePool::PosePool(gpu::Device& device, const CrowdAssets& assets, const KeyFrames& frames,
                   const gpu::Image& animation_texture, std::uint64_t budget_bytes,
                   std::uint64_t max_buffer_bytes)
    : device_(device),
      assets_(assets),
      frames_(frames),
      animation_texture_(animation_texture),
      limits_(limitsFor(assets, frames, budget_bytes, max_buffer_bytes)),
      cache_(limits_) {
  std::uint32_t poses = 0;
  for (const DrawMesh& mesh : assets.meshes()) {
    const std::uint32_t first = frames.firstOfWardrobe(mesh.wardrobe);
    first_pose_.push_back(poses - first);
    poses += frames.firstOfWardrobe(mesh.wardrobe + 1) - first;
  }
  table_ = gpu::Buffer(device, std::uint64_t{poses} * sizeof(std::uint32_t),
                       vk::BufferUsageFlagBits::eUniformTexelBuffer, gpu::Buffer::Kind::kUpload,
                       "the table of poses");
  table_view_ = table_.makeTexelView(device, vk::Format::eR32Uint);
  createPipeline();
}

/// Buffers no larger than all poses that there can be, nor than 64 MiB.
PoseCacheLimits PosePool::limitsFor(const CrowdAssets& assets, const KeyFrames& frames,
                                    std::uint64_t budget_bytes, std::uint64_t max_buffer_bytes) {
  std::uint64_t all = 1, largest = 1;
  for (const DrawMesh& mesh : assets.meshes()) {
    const std::uint64_t keys =
        frames.firstOfWardrobe(mesh.wardrobe + 1) - frames.firstOfWardrobe(mesh.wardrobe);
    all += keys * mesh.vertex_count;
    largest = std::max<std::uint64_t>(largest, mesh.vertex_count);
  }
  const std::uint64_t most = std::min(kMostBufferBytes, max_buffer_bytes) / kVertexBytes;
  return {.budget_vertices = budget_bytes / kVertexBytes,
          .buffer_vertices = static_cast<std::uint32_t>(std::max(std::min(all, most), largest))};
}

void PosePool::createPipeline() {
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device_.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device_, kSkinBindings, vk::ShaderStageFlagBits::eCompute);
  const vk::PushConstantRange push{
      .stageFlags = vk::ShaderStageFlagBits::eCompute, .offset = 0, .size = sizeof(Push)};
  layout_ = ENSEMBLE_VK(
      vk::raii::PipelineLayout(device_.handle(), vk::PipelineLayoutCreateInfo{.setLayoutCount = 1,
                                                                              .pSetLayouts = &*set_layout_,
                                                                              .pushConstantRangeCount = 1,
                                                                              .pPushConstantRanges = &push}));
  pipeline_ = gpu::makeComputePipeline(device_, layout_, kSkinPoseComp);
}

void PosePool::beginFrame() {
  cache_.beginFrame();
  skinned_vertices_ = 0;
}

PlanPose PosePool::require(std::uint32_t mesh, std::uint32_t key) {
  const DrawMesh& from = assets_.meshes()[mesh];
  const std::uint32_t pose = first_pose_[mesh] + key;
  const KeptPose kept = cache_.require(pose, from.vertex_count);
  if (kept.is_new) {
    const KeyFrame& frame = frames_.keys[key];
    const KeptBox& box = frames_.boxes[frame.clip];
    jobs_.push_back({.vertex_chunk = from.vertex_chunk,
                     .buffer = kept.buffer,
                     .gpu = {.box = vec4(box.low, 1.0f / box.step),
                             .first_vertex = from.first_vertex,
                             .vertex_count = from.vertex_count,
                             .pose = kept.first_vertex,
                             .first_matrix = frame.first_matrix}});
    group_count_ += (from.vertex_count + ENSEMBLE_SKIN_GROUP - 1) / ENSEMBLE_SKIN_GROUP;
    skinned_vertices_ += from.vertex_count;
    table_.mapped<std::uint32_t>()[pose] = kept.buffer << ENSEMBLE_POSE_OFFSET_BITS | kept.first_vertex;
  }
  return {kept.buffer, kept.first_vertex};
}

bool PosePool::prepare() {
  const std::size_t before = buffers_.size();
  makeRoomForJobs();
  while (buffers_.size() < cache_.bufferCount()) {
    PoseBuffer buffer;
    using Usage = vk::BufferUsageFlagBits;
    buffer.vertices = gpu::Buffer(device_, limits_.buffer_vertices * kVertexBytes,
                                  Usage::eStorageBuffer | Usage::eUniformTexelBuffer,
                                  gpu::Buffer::Kind::kDevice, "a buffer of skinned key frames");
    buffer.texels = buffer.vertices.makeTexelView(device_, vk::Format::eR32G32Uint);
    buffer.skin_sets = gpu::DescriptorSets(device_, set_layout_, kSkinBindings,
                                           static_cast<std::uint32_t>(assets_.vertexChunkCount()));
    for (std::uint32_t c = 0; c < assets_.vertexChunkCount(); ++c) {
      const vk::DescriptorSet set = buffer.skin_sets[c];
      gpu::writeTexelBuffer(device_, set, ENSEMBLE_BINDING_SKIN_VERTICES, assets_.vertexChunk(c).texels);
      gpu::writeImage(device_, set, ENSEMBLE_BINDING_SKIN_ANIMATION, animation_texture_, &sampler_,
                      vk::ImageLayout::eShaderReadOnlyOptimal);
      gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_SKIN_POSES, buffer.vertices);
      gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_SKIN_JOBS, gpu_jobs_);
      gpu::writeBuffer(device_, set, ENSEMBLE_BINDING_SKIN_GROUPS, gpu_groups_);
    }
    buffers_.push_back(std::move(buffer));
  }
  return buffers_.size() > before;
}

void PosePool::makeRoomForJobs() {
  const auto grow = [&](gpu::Buffer& buffer, std::uint64_t bytes, std::uint32_t binding, const char* what) {
    if (buffer && bytes <= buffer.size()) return;
    buffer = gpu::Buffer(device_, bytes + bytes / 2, vk::BufferUsageFlagBits::eStorageBuffer,
                         gpu::Buffer::Kind::kUpload, what);
    for (const PoseBuffer& own : buffers_) {
      for (std::size_t c = 0; c < own.skin_sets.size(); ++c)
        gpu::writeBuffer(device_, own.skin_sets[c], binding, buffer);
    }
  };
  grow(gpu_jobs_, jobs_.size() * sizeof(GpuSkinJob), ENSEMBLE_BINDING_SKIN_JOBS, "the poses to skin");
  grow(gpu_groups_, group_count_ * sizeof(GpuSkinGroup), ENSEMBLE_BINDING_SKIN_GROUPS, "the poses to skin");
}

void PosePool::record(const vk::raii::CommandBuffer& commands) {
  using Stage = vk::PipelineStageFlagBits2;
  if (jobs_.empty()) return;
  std::stable_sort(jobs_.begin(), jobs_.end(), [](const Job& a, const Job& b) {
    return std::tie(a.buffer, a.vertex_chunk) < std::tie(b.buffer, b.vertex_chunk);
  });
  gpu::recordBarrier(commands, Stage::eComputeShader, {}, Stage::eComputeShader, {});
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  const std::span<GpuSkinJob> jobs = gpu_jobs_.mapped<GpuSkinJob>();
  const std::span<GpuSkinGroup> groups = gpu_groups_.mapped<GpuSkinGroup>();
  std::uint32_t job = 0, group = 0;
  while (job < jobs_.size()) {
    const Job& first = jobs_[job];
    Push push{group, 0};
    for (; job < jobs_.size() && jobs_[job].buffer == first.buffer &&
           jobs_[job].vertex_chunk == first.vertex_chunk;
         ++job) {
      jobs[job] = jobs_[job].gpu;
      for (std::uint32_t v = 0; v < jobs_[job].gpu.vertex_count; v += ENSEMBLE_SKIN_GROUP)
        groups[group++] = {job, v};
    }
    push.group_count = group - push.first_group;
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0,
                                buffers_[first.buffer].skin_sets[first.vertex_chunk], nullptr);
    commands.pushConstants<Push>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
    gpu::recordDispatch(commands, push.group_count, ENSEMBLE_RASTER_GROUPS_X);
  }
  jobs_.clear();
  group_count_ = 0;
  gpu::recordBarrier(commands, Stage::eComputeShader, vk::AccessFlagBits2::eShaderStorageWrite,
                     Stage::eComputeShader, vk::AccessFlagBits2::eShaderSampledRead);
}

}  // namespace ensemble
