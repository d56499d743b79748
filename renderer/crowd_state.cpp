#include "renderer/crowd_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/input_error.h"
#include "renderer/vk/descriptors.h"
#include "spirv/pose.comp.h"

namespace ensemble {
namespace {

constexpr float kReachForPrints = 1.1f;  // of a figure's radius
constexpr std::uint64_t kJointBytes = 3 * sizeof(vec4);

constexpr std::initializer_list<vk::DescriptorType> kPoseBindings = {
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eCombinedImageSampler,
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer,
    vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer};

}  // namespace

CrowdState::CrowdState(gpu::Device& device, const Crowd& crowd, const Animation& animation,
                       std::uint64_t max_buffer_bytes)
    : crowd_(crowd),
      first_clip_(animation.first_clip),
      clip_seconds_(animation.seconds),
      clip_bounds_(animation.bounds),
      key_frames_(numberKeyFrames(animation)) {
  makeCharacters(animation);
  makeChunks(device, animation, max_buffer_bytes);
  texture_ = uploadAnimation(device, animation);
  const auto upload = [&](auto values, const char* what) {
    return gpu::uploadBuffer(device, std::as_bytes(values), vk::BufferUsageFlagBits::eStorageBuffer, what);
  };
  clips_ = upload(std::span(animation.clips), "the table of clips");
  legs_ = upload(std::span(animation.legs), "the table of legs");
  leg_groups_ = upload(std::span(animation.leg_groups), "the parts of legs");
  createPipeline(device);
  setTime(0.0);
  uploadCharacters();  // what never changes
}

void CrowdState::makeCharacters(const Animation& animation) {
  for (std::uint32_t i = 0; i < crowd_.characters.size(); ++i) {
    const Character& person = crowd_.characters[i];
    GpuCharacter character{};
    character.clip = animation.first_clip[person.wardrobe] + person.clip;
    ENSEMBLE_CHECK(character.clip < animation.clips.size());
    character.idle_clip = character.clip;
    character.combination = person.combination;
    character.tint_seed = person.tint_seed;
    character.number = i;
    setPlace(person.worldFromModel(), animation.bounds[character.clip], person.scale, character,
             bounds_.emplace_back());
    characters_.push_back(character);
    heights_.push_back(animation.heights[person.wardrobe] * person.scale);
    combinations_.push_back(person.combination);
  }
}

void CrowdState::setPlace(const Mat4& world_from_model, const Sphere& model_bounds, float scale,
                          GpuCharacter& character, Sphere& bounds) {
  for (int row = 0; row < 3; ++row) {
    character.world_from_model[row] = {world_from_model[0][row], world_from_model[1][row],
                                       world_from_model[2][row], world_from_model[3][row]};
  }
  bounds = {Vec3(world_from_model * Vec4(model_bounds.center, 1.0f)), model_bounds.radius * scale};
}

void CrowdState::makeChunks(gpu::Device& device, const Animation& animation, std::uint64_t max_buffer_bytes) {
  std::uint64_t joints = 0;
  for (GpuCharacter& character : characters_) {
    const std::uint64_t own_joints = animation.clips[character.clip].joint_count;
    const bool fits = (joints + own_joints) * kJointBytes <= max_buffer_bytes;
    if (chunks_.empty() || !fits || (chunks_.back().count + 1) * sizeof(GpuCharacter) > max_buffer_bytes) {
      chunks_.emplace_back();
      chunks_.back().first = character.number;
      joints = 0;
    }
    character.first_joint = static_cast<std::uint32_t>(joints);
    joints += own_joints;
    ++chunks_.back().count;
    chunk_of_.push_back(static_cast<std::uint32_t>(chunks_.size() - 1));
  }
  for (CrowdChunk& chunk : chunks_) {
    const GpuCharacter& last = characters_[chunk.first + chunk.count - 1];
    const std::uint64_t chunk_joints = last.first_joint + animation.clips[last.clip].joint_count;
    using Usage = vk::BufferUsageFlagBits;
    chunk.characters =
        gpu::Buffer(device, chunk.count * sizeof(GpuCharacter), Usage::eStorageBuffer,
                    gpu::Buffer::Kind::kUpload, fmt::format("a buffer of {} people", chunk.count));
    chunk.palette =
        gpu::Buffer(device, chunk_joints * kJointBytes, Usage::eStorageBuffer | Usage::eUniformTexelBuffer,
                    gpu::Buffer::Kind::kDevice, fmt::format("the poses of {} people", chunk.count));
    chunk.palette_view = chunk.palette.makeTexelView(device);
    chunk.pose_queue =
        gpu::Buffer(device, chunk.count * sizeof(GpuPoseJob), Usage::eStorageBuffer,
                    gpu::Buffer::Kind::kUpload, fmt::format("the pose queue of {} people", chunk.count));
    chunk.pose_head = gpu::Buffer(device, sizeof(GpuPoseHead), Usage::eStorageBuffer | Usage::eIndirectBuffer,
                                  gpu::Buffer::Kind::kUpload, "the head of a pose queue");
  }
}

void CrowdState::createPipeline(gpu::Device& device) {
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device, kPoseBindings, vk::ShaderStageFlagBits::eCompute);
  sets_ = gpu::DescriptorSets(device, set_layout_, kPoseBindings, static_cast<std::uint32_t>(chunks_.size()));
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_CHARACTERS, chunks_[i].characters);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_PALETTE, chunks_[i].palette);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_CLIPS, clips_);
    gpu::writeImage(device, sets_[i], ENSEMBLE_BINDING_POSE_ANIMATION, texture_, &sampler_,
                    vk::ImageLayout::eShaderReadOnlyOptimal);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_QUEUE, chunks_[i].pose_queue);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_LEGS, legs_);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_LEG_GROUPS, leg_groups_);
    gpu::writeBuffer(device, sets_[i], ENSEMBLE_BINDING_POSE_HEAD, chunks_[i].pose_head);
  }
  layout_ = gpu::makePipelineLayout(device, std::array{*set_layout_});
  pipeline_ = gpu::makeComputePipeline(device, layout_, kPoseComp);
}

void CrowdState::setWalker(const Character& person, GpuCharacter& character, Sphere& bounds) const {
  const CharacterPose pose = poseAt(crowd_, person, 0.0f, seconds_, FeetOf::kNobody);
  const std::uint32_t first_clip = first_clip_[person.wardrobe];
  const Sphere &walk = clip_bounds_[first_clip + pose.clip],
               &idle = clip_bounds_[first_clip + pose.idle_clip];
  // Both clips, and legs that reach for their prints.
  const float radius =
      kReachForPrints * (std::max(walk.radius, idle.radius) + glm::distance(walk.center, idle.center));
  setPlace(pose.world_from_model, {walk.center, radius}, person.scale, character, bounds);
  if (!pose.exists) bounds.radius = kTouchesNothing;
  character.phase = pose.phase;
  character.idle_clip = first_clip + pose.idle_clip;
  character.idle_phase = pose.idle_phase;
  character.idle_weight = pose.idle_weight;
  setFeet(pose, character);
}

void CrowdState::setFeet(const CharacterPose& pose, GpuCharacter& character) {
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const FootShift& shift = pose.feet[foot];
    character.feet[foot] = {shift.x, shift.yaw, shift.z, pose.holds_feet ? 1.0f : 0.0f};
  }
}

void CrowdState::holdFeet(std::uint32_t person) {
  const Character& who = crowd_.characters[person];
  if (who.walker) setFeet(poseAt(crowd_, who, 0.0f, seconds_), characters_[person]);
}

void CrowdState::setTime(double seconds) {
  seconds_ = seconds;
  for (std::uint32_t i = 0; i < characters_.size(); ++i) {
    const Character& person = crowd_.characters[i];
    GpuCharacter& character = characters_[i];
    if (person.walker) {
      setWalker(person, character, bounds_[i]);
    } else {
      character.phase = phaseAt(seconds, clip_seconds_[character.clip], person.phase, person.speed);
    }
  }
  forgetPoses();
  is_uploaded_ = false;
  for (CrowdChunk& chunk : chunks_) chunk.pose_queue_length = 0;
}

void CrowdState::uploadCharacters() {
  for (std::uint32_t i = 0; i < characters_.size(); ++i) holdFeet(i);
  for (const CrowdChunk& chunk : chunks_) {
    std::copy_n(characters_.begin() + chunk.first, chunk.count,
                chunk.characters.mapped<GpuCharacter>().begin());
  }
  is_uploaded_ = true;
}

bool CrowdState::letDeviceQueue() {
  if (!is_uploaded_) uploadCharacters();
  return !std::exchange(device_queues_, true);
}

void CrowdState::forgetPoses() {
  pose_of_.assign(characters_.size(), kNoPose);
  device_queues_ = false;
}

std::uint32_t CrowdState::queuePoses(std::span<const std::uint32_t> people, const ViewPeople& shown) {
  if (device_queues_) forgetPoses();  // The host did not see who was posed since.
  std::uint32_t queued = 0;
  for (const std::uint32_t person : people) {
    const std::uint32_t key = shown.key(person);
    const std::uint32_t wanted = key == ViewPeople::kExact ? 0 : 1 + key_frames_.keys[key].first_matrix;
    if (pose_of_[person] == wanted) continue;
    pose_of_[person] = wanted;
    CrowdChunk& chunk = chunks_[chunk_of_[person]];
    const std::uint32_t number = person - chunk.first;
    chunk.pose_queue.mapped<GpuPoseJob>()[chunk.pose_queue_length++] = {number, wanted};
    ++queued;
    if (is_uploaded_) continue;
    if (wanted == 0) holdFeet(person);
    chunk.characters.mapped<GpuCharacter>()[number] = characters_[person];
  }
  return queued;
}

void CrowdState::recordPoses(const vk::raii::CommandBuffer& commands) {
  using Stage = vk::PipelineStageFlagBits2;
  // The last frame's shaders may still be reading what is overwritten here.
  gpu::recordBarrier(commands, Stage::eVertexShader | Stage::eComputeShader, {}, Stage::eComputeShader, {});
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline_);
  for (std::size_t i = 0; i < chunks_.size(); ++i) {
    const std::uint32_t queued = std::exchange(chunks_[i].pose_queue_length, 0u);
    if (queued == 0 && !device_queues_) continue;
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, sets_[i], nullptr);
    if (device_queues_) {
      commands.dispatchIndirect(chunks_[i].pose_head.handle(), offsetof(GpuPoseHead, groups_x));
      continue;
    }
    chunks_[i].pose_head.mapped<GpuPoseHead>()[0].count = queued;
    gpu::recordDispatch(commands, queued);
  }
  gpu::recordBarrier(commands, Stage::eComputeShader, vk::AccessFlagBits2::eShaderStorageWrite,
                     Stage::eVertexShader | Stage::eComputeShader, vk::AccessFlagBits2::eShaderSampledRead);
}

}  // namespace ensemble
