// The crowd's state at one time, shared by all views: people and their poses (design 6).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/animation_texture.h"
#include "renderer/crowd.h"
#include "renderer/key_frames.h"
#include "renderer/view_people.h"
#include "renderer/vk/descriptors.h"
#include "renderer/vk/memory.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// Of somebody whose pose is not in the palette.
inline constexpr std::uint32_t kNoPose = 0xffffffffu;

/// People who share buffers, so that none grows beyond the limit.
struct CrowdChunk {
  std::uint32_t first = 0, count = 0;  ///< numbers in the crowd
  gpu::Buffer characters;              ///< GpuCharacter, mapped
  gpu::Buffer palette;                 ///< world_from_model * skinning matrix, three rows a joint
  vk::raii::BufferView palette_view = nullptr;
  gpu::Buffer pose_queue;  ///< GpuPoseJob of those whose poses are to be computed, mapped
  gpu::Buffer pose_head;   ///< GpuPoseHead of that queue, mapped
  std::uint32_t pose_queue_length = 0;
};

class CrowdState {
 public:
  /// The crowd must outlive the state.
  CrowdState(gpu::Device& device, const Crowd& crowd, const Animation& animation,
             std::uint64_t max_buffer_bytes);

  const std::vector<CrowdChunk>& chunks() const { return chunks_; }
  /// Per person: its combination.
  std::span<const std::uint32_t> combinations() const { return combinations_; }
  /// Holds a person whatever the clip's time, world space, at the time set; those who are not there at
  /// that time have a radius that touches nothing.
  const std::vector<Sphere>& bounds() const { return bounds_; }
  std::uint32_t characterCount() const { return static_cast<std::uint32_t>(characters_.size()); }
  /// At the time set, on the host; by number. Of feet that are held it is known who holds them; by how
  /// much they are moved, of those whose pose was queued, once the device was told.
  std::span<const GpuCharacter> characters() const { return characters_; }
  std::span<const float> heights() const { return heights_; }  ///< metres, standing, scale included
  /// The chunk that somebody is in.
  std::uint32_t chunkOf(std::uint32_t person) const { return chunk_of_[person]; }
  const KeyFrames& keyFrames() const { return key_frames_; }
  const gpu::Image& animationTexture() const { return texture_; }
  const gpu::Buffer& clips() const { return clips_; }  ///< GpuClip

  /// Brings phases to a time, at which nobody has a pose yet.
  void setTime(double seconds);
  /// Queues those of `people` (numbers in the crowd) who don't have their poses yet, and says how many they
  /// were; the device gets to know their phases and places. It must be done with the pose pass before. @param
  /// shown who is at a key frame
  std::uint32_t queuePoses(std::span<const std::uint32_t> people, const ViewPeople& shown);
  /// From now on shaders fill the queues, until setTime() or queuePoses(). The device must be done with the
  /// pose pass before.
  /// @return whether they did not since then: nobody has a pose yet that they would know of
  bool letDeviceQueue();
  /// Records the pose pass: fills the palettes of those queued, readable by vertex and compute shaders
  /// afterwards, and empties the queues of the host.
  void recordPoses(const vk::raii::CommandBuffer& commands);

 private:
  void makeCharacters(const Animation& animation);
  static void setPlace(const Mat4& world_from_model, const Sphere& model_bounds, float scale,
                       GpuCharacter& character, Sphere& bounds);
  void setWalker(const Character& person, GpuCharacter& character, Sphere& bounds) const;
  static void setFeet(const CharacterPose& pose, GpuCharacter& character);
  /// What setTime() leaves out of a walker.
  void holdFeet(std::uint32_t person);
  void makeChunks(gpu::Device& device, const Animation& animation, std::uint64_t max_buffer_bytes);
  void createPipeline(gpu::Device& device);
  void forgetPoses();
  /// Tells the device of everybody.
  void uploadCharacters();

  const Crowd& crowd_;
  std::vector<std::uint32_t> first_clip_;  // per wardrobe
  std::vector<float> clip_seconds_;
  std::vector<Sphere> clip_bounds_;  // model space
  std::vector<GpuCharacter> characters_;
  double seconds_ = 0.0;
  std::vector<std::uint32_t> combinations_;
  std::vector<Sphere> bounds_;
  std::vector<float> heights_;
  std::vector<std::uint32_t> pose_of_;  // per person, at this time: GpuPoseJob::key_matrix, or kNoPose
  bool device_queues_ = false;
  bool is_uploaded_ = false;  // all of characters_ is on the device as it is
  std::vector<CrowdChunk> chunks_;
  std::vector<std::uint32_t> chunk_of_;  // per person

  KeyFrames key_frames_;
  gpu::Image texture_;
  gpu::Buffer clips_, legs_, leg_groups_;
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  gpu::DescriptorSets sets_;  // per chunk
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace ensemble
