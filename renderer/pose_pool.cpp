#include "renderer/pose_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "core/check.h"
#include "core/input_error.h"
#include "spirv/mix_poses.comp.h"
#include "spirv/skin_pose.comp.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kVertexBytes = 8;
constexpr std::uint64_t kMostBufferBytes = 64ull << 20;
/// Beside the flag of own poses so many bits are left for a buffer's number.
constexpr std::uint32_t kMostBuffers = 1u << (31 - ENSEMBLE_POSE_OFFSET_BITS);
/// In the order of ENSEMBLE_BINDING_SKIN_...
constexpr std::initializer_list<vk::DescriptorType> kSkinBindings = {
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
    vk::DescriptorType::eUniformTexelBuffer, vk::DescriptorType::eStorageBuffer};
constexpr std::initializer_list<vk::DescriptorType> kMatricesBindings = {
    vk::DescriptorType::eCombinedImageSampler, vk::DescriptorType::eUniformTexelBuffer};
constexpr std::initializer_list<vk::DescriptorType> kMixBindings = {vk::DescriptorType::eUniformTexelBuffer};

std::uint32_t groupsOf(std::uint32_t vertices) {
  return (vertices + ENSEMBLE_SKIN_RUN - 1) / ENSEMBLE_SKIN_RUN;
}

struct Push {
  std::uint32_t first_group, group_count;
};

}  // namespace

PosePool::PosePool(gpu::Device& device, const CrowdAssets& assets, const CrowdState& state,
                   std::uint64_t budget_bytes, std::uint64_t max_buffer_bytes)
    : device_(device),
      assets_(assets),
      state_(state),
      worn_(findWorn(assets)),
      buffer_vertices_(chooseBufferVertices(max_buffer_bytes)),
      cache_({.budget_vertices = budget_bytes / kVertexBytes, .buffer_vertices = buffer_vertices_}),
      own_(state.characterCount(), buffer_vertices_) {
  numberPoses();
  createPipelines();
}

std::vector<std::vector<PosePool::WornMesh>> PosePool::findWorn(const CrowdAssets& assets) {
  std::vector<std::vector<WornMesh>> worn;
  for (const std::vector<SubMeshId>& shown : assets.shown()) {
    std::vector<WornMesh>& own = worn.emplace_back();
    std::uint32_t vertices = 0;
    for (const SubMeshId id : shown) {
      const std::uint32_t mesh = assets.items()[id.value].mesh;
      const bool is_known =
          std::any_of(own.begin(), own.end(), [&](const WornMesh& w) { return w.mesh == mesh; });
      if (is_known || assets.items()[id.value].index_count == 0) continue;
      own.push_back({mesh, vertices});
      vertices += assets.meshes()[mesh].vertex_count;
    }
  }
  return worn;
}

std::uint32_t PosePool::ownVertexCount(std::uint32_t combination) const {
  const std::vector<WornMesh>& worn = worn_[combination];
  if (worn.empty()) return 0;
  return worn.back().first_vertex + assets_.meshes()[worn.back().mesh].vertex_count;
}

std::uint32_t PosePool::firstOwnVertex(std::uint32_t combination, std::uint32_t mesh) const {
  for (const WornMesh& worn : worn_[combination]) {
    if (worn.mesh == mesh) return worn.first_vertex;
  }
  ENSEMBLE_CHECK(false);
  return 0;
}

/// Buffers no larger than all poses that there can be at a time, nor than 64 MiB.
std::uint32_t PosePool::chooseBufferVertices(std::uint64_t max_buffer_bytes) const {
  const KeyFrames& frames = state_.keyFrames();
  std::uint64_t all = 1, largest = 1;
  for (const DrawMesh& mesh : assets_.meshes()) {
    const std::uint64_t keys =
        frames.firstOfWardrobe(mesh.wardrobe + 1) - frames.firstOfWardrobe(mesh.wardrobe);
    all += keys * mesh.vertex_count;
    largest = std::max<std::uint64_t>(largest, mesh.vertex_count);
  }
  for (const std::uint32_t combination : state_.combinations()) {
    const std::uint32_t own = ownVertexCount(combination);
    all += own;
    largest = std::max<std::uint64_t>(largest, own);
  }
  const std::uint64_t most = std::min(kMostBufferBytes, max_buffer_bytes) / kVertexBytes;
  return static_cast<std::uint32_t>(std::max(std::min(all, most), largest));
}

void PosePool::numberPoses() {
  const KeyFrames& frames = state_.keyFrames();
  std::uint32_t poses = 0;
  for (const DrawMesh& mesh : assets_.meshes()) {
    const std::uint32_t first = frames.firstOfWardrobe(mesh.wardrobe);
    first_pose_.push_back(poses - first);
    poses += frames.firstOfWardrobe(mesh.wardrobe + 1) - first;
  }
  table_ = gpu::Buffer(device_, std::uint64_t{poses} * sizeof(std::uint32_t),
                       vk::BufferUsageFlagBits::eUniformTexelBuffer, gpu::Buffer::Kind::kUpload,
                       "the table of poses");
  table_view_ = table_.makeTexelView(device_, vk::Format::eR32Uint);
}

void PosePool::createPipelines() {
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device_.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device_, kSkinBindings, vk::ShaderStageFlagBits::eCompute);
  matrices_layout_ = gpu::makeSetLayout(device_, kMatricesBindings, vk::ShaderStageFlagBits::eCompute);
  const std::vector<CrowdChunk>& chunks = state_.chunks();
  matrices_sets_ = gpu::DescriptorSets(device_, matrices_layout_, kMatricesBindings,
                                       static_cast<std::uint32_t>(chunks.size()));
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    gpu::writeImage(device_, matrices_sets_[i], ENSEMBLE_BINDING_SKIN_ANIMATION, state_.animationTexture(),
                    &sampler_, vk::ImageLayout::eShaderReadOnlyOptimal);
    gpu::writeTexelBuffer(device_, matrices_sets_[i], ENSEMBLE_BINDING_SKIN_PALETTE, chunks[i].palette_view);
  }
  mix_layout_ = gpu::makeSetLayout(device_, kMixBindings, vk::ShaderStageFlagBits::eCompute);
  layout_ = gpu::makePipelineLayout(device_, std::array{*set_layout_, *matrices_layout_}, sizeof(Push));
  mix_pipeline_layout_ =
      gpu::makePipelineLayout(device_, std::array{*set_layout_, *mix_layout_, *mix_layout_}, sizeof(Push));
  const auto make = [&](vk::Bool32 own_poses) {
    const vk::SpecializationMapEntry entry{ENSEMBLE_CONSTANT_OWN_POSES, 0, sizeof own_poses};
    const vk::SpecializationInfo info{
        .mapEntryCount = 1, .pMapEntries = &entry, .dataSize = sizeof own_poses, .pData = &own_poses};
    return gpu::makeComputePipeline(device_, layout_, kSkinPoseComp, &info);
  };
  key_pipeline_ = make(false);
  own_pipeline_ = make(true);
  mix_pipeline_ = gpu::makeComputePipeline(device_, mix_pipeline_layout_, kMixPosesComp);
}

void PosePool::beginFrame() {
  if (!jobs_.empty()) {  // the last frame ended in an error: what it asked for was never made
    jobs_.clear();
    group_count_ = 0;
    cache_.clear();
  }
  cache_.beginFrame();
  own_.beginFrame();
  skinned_vertices_ = 0;
}

std::uint32_t PosePool::numberOf(std::vector<std::uint32_t>& numbers, std::uint32_t own_number,
                                 std::uint32_t& count) {
  while (numbers.size() <= own_number) numbers.push_back(count++);
  return numbers[own_number];
}

void PosePool::addJob(const Job& job) {
  group_count_ += groupsOf(job.gpu.vertex_count);
  skinned_vertices_ += job.gpu.vertex_count;
  jobs_.push_back(job);
}

PlanPose PosePool::require(std::uint32_t mesh, std::uint32_t key) {
  const DrawMesh& from = assets_.meshes()[mesh];
  const std::uint32_t pose = first_pose_[mesh] + key;
  const KeptPose kept = cache_.require(pose, from.vertex_count);
  const std::uint32_t buffer = numberOf(numbers_of_kept_, kept.buffer, buffer_count_);
  if (kept.is_new) {
    const KeyFrame& frame = state_.keyFrames().keys[key];
    const KeptBox& box = state_.keyFrames().boxes[frame.clip];
    addJob({.kind = JobKind::kKey,
            .buffer = buffer,
            .from = from.vertex_chunk,
            .gpu = {.box = vec4(box.low, 1.0f / box.step),
                    .first_vertex = from.first_vertex,
                    .vertex_count = from.vertex_count,
                    .pose = kept.first_vertex,
                    .first_matrix = frame.first_matrix}});
    table_.mapped<std::uint32_t>()[pose] = buffer << ENSEMBLE_POSE_OFFSET_BITS | kept.first_vertex;
  }
  return {buffer, kept.first_vertex};
}

PlanPose PosePool::requireOwn(std::uint32_t person) {
  const std::uint32_t combination = state_.combinations()[person];
  const OwnPose own = own_.require(person, std::max(ownVertexCount(combination), 1u));
  const std::uint32_t buffer = numberOf(numbers_of_own_, own.buffer, buffer_count_);
  if (own.is_new) {
    const std::optional<BetweenKeys> keys = betweenKeys(state_.keyFrames(), state_.characters()[person]);
    for (const WornMesh& worn : worn_[combination]) {
      const std::uint32_t first_vertex = own.first_vertex + worn.first_vertex;
      if (keys) {
        mixOwn(*keys, worn.mesh, buffer, first_vertex);
      } else {
        skinOwn(person, worn.mesh, buffer, first_vertex);
      }
    }
  }
  return {buffer, own.first_vertex};
}

void PosePool::mixOwn(const BetweenKeys& keys, std::uint32_t mesh, std::uint32_t buffer,
                      std::uint32_t first_vertex) {
  const PlanPose before = require(mesh, keys.before), after = require(mesh, keys.after);
  addJob({.kind = JobKind::kMix,
          .buffer = buffer,
          .from = before.buffer,
          .and_from = after.buffer,
          .gpu = {.box = vec4(keys.part, 0.0f, 0.0f, 0.0f),
                  .first_vertex = before.first_vertex,
                  .vertex_count = assets_.meshes()[mesh].vertex_count,
                  .pose = first_vertex,
                  .first_matrix = after.first_vertex}});
}

void PosePool::skinOwn(std::uint32_t person, std::uint32_t mesh, std::uint32_t buffer,
                       std::uint32_t first_vertex) {
  const KeptBox box = ownPlace(person).box;
  const DrawMesh& from = assets_.meshes()[mesh];
  addJob({.kind = JobKind::kPalette,
          .buffer = buffer,
          .from = from.vertex_chunk,
          .and_from = state_.chunkOf(person),
          .gpu = {.box = vec4(box.low, 1.0f / box.step),
                  .first_vertex = from.first_vertex,
                  .vertex_count = from.vertex_count,
                  .pose = first_vertex,
                  .first_matrix = state_.characters()[person].first_joint}});
}

PosePool::OwnPlace PosePool::ownPlace(std::uint32_t person) const {
  const GpuCharacter& character = state_.characters()[person];
  if (needsPalette(state_, person))
    return {keptBoxAround(state_.bounds()[person]), {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const vec4(&rows)[3] = character.world_from_model;
  return {state_.keyFrames().boxes[character.clip], {rows[0], rows[1], rows[2]}};
}

bool PosePool::prepare() {
  if (buffer_count_ > kMostBuffers) {
    throw SystemError({.file = {},
                       .where = "Vulkan device " + device_.name(),
                       .what = fmt::format("the poses of all people need more than {} buffers of {}",
                                           kMostBuffers, gpu::describeBytes(buffer_vertices_ * kVertexBytes)),
                       .mend = "use fewer people, or set raster to pipeline"});
  }
  const std::size_t before = buffers_.size();
  makeRoomForJobs();
  while (buffers_.size() < buffer_count_) {
    PoseBuffer buffer;
    using Usage = vk::BufferUsageFlagBits;
    buffer.vertices = gpu::Buffer(device_, buffer_vertices_ * kVertexBytes,
                                  Usage::eStorageBuffer | Usage::eUniformTexelBuffer,
                                  gpu::Buffer::Kind::kDevice, "a buffer of skinned poses");
    buffer.texels = buffer.vertices.makeTexelView(device_, vk::Format::eR32G32Uint);
    buffer.skin_sets = gpu::DescriptorSets(device_, set_layout_, kSkinBindings,
                                           static_cast<std::uint32_t>(assets_.vertexChunkCount()));
    buffer.mix_set = gpu::DescriptorSets(device_, mix_layout_, kMixBindings, 1);
    gpu::writeTexelBuffer(device_, buffer.mix_set[0], ENSEMBLE_BINDING_MIX_POSES, buffer.texels);
    for (std::uint32_t c = 0; c < assets_.vertexChunkCount(); ++c) {
      const vk::DescriptorSet set = buffer.skin_sets[c];
      gpu::writeTexelBuffer(device_, set, ENSEMBLE_BINDING_SKIN_VERTICES, assets_.vertexChunk(c).texels);
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
  std::sort(jobs_.begin(), jobs_.end(), [](const Job& a, const Job& b) { return a.place() < b.place(); });
  gpu::recordBarrier(commands, Stage::eComputeShader, {}, Stage::eComputeShader, {});
  const auto finish = [&] {
    gpu::recordBarrier(commands, Stage::eComputeShader, vk::AccessFlagBits2::eShaderStorageWrite,
                       Stage::eComputeShader, vk::AccessFlagBits2::eShaderSampledRead);
  };
  std::uint32_t group = 0;
  for (std::size_t first = 0, end = 0; first < jobs_.size(); first = end) {
    if (first > 0 && jobs_[first - 1].kind == JobKind::kKey && jobs_[first].kind != JobKind::kKey) finish();
    while (end < jobs_.size() && jobs_[end].place() == jobs_[first].place()) ++end;
    recordJobs(commands, first, end, group);
  }
  jobs_.clear();
  group_count_ = 0;
  finish();
}

/// Jobs of one place, in one dispatch. @param group the next free; moves on
void PosePool::recordJobs(const vk::raii::CommandBuffer& commands, std::size_t first, std::size_t end,
                          std::uint32_t& group) {
  const std::span<GpuSkinJob> jobs = gpu_jobs_.mapped<GpuSkinJob>();
  const std::span<GpuSkinGroup> groups = gpu_groups_.mapped<GpuSkinGroup>();
  Push push{group, 0};
  for (std::size_t job = first; job < end; ++job) {
    jobs[job] = jobs_[job].gpu;
    for (std::uint32_t v = 0; v < jobs_[job].gpu.vertex_count; v += ENSEMBLE_SKIN_RUN)
      groups[group++] = {static_cast<std::uint32_t>(job), v};
  }
  push.group_count = group - push.first_group;
  const Job& any = jobs_[first];
  const PoseBuffer& buffer = buffers_[any.buffer];
  const bool mixes = any.kind == JobKind::kMix;
  const vk::raii::Pipeline& skin = any.kind == JobKind::kKey ? key_pipeline_ : own_pipeline_;
  const vk::PipelineLayout layout = mixes ? *mix_pipeline_layout_ : *layout_;
  const std::array<vk::DescriptorSet, 3> sets = {
      buffer.skin_sets[mixes ? 0 : any.from],
      mixes ? buffers_[any.from].mix_set[0] : matrices_sets_[any.and_from],
      mixes ? buffers_[any.and_from].mix_set[0] : vk::DescriptorSet()};
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, mixes ? *mix_pipeline_ : *skin);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, layout, 0,
                              vk::ArrayProxy<const vk::DescriptorSet>(mixes ? 3 : 2, sets.data()), nullptr);
  commands.pushConstants<Push>(layout, vk::ShaderStageFlagBits::eCompute, 0, push);
  gpu::recordDispatch(commands, push.group_count);
}

}  // namespace ensemble
