// The crowd's state at one time, shared by all views: people and their poses (design 6).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/animation_texture.h"
#include "renderer/crowd.h"
#include "renderer/vk/descriptors.h"
#include "renderer/vk/memory.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// People who share buffers, so that none grows beyond the limit.
struct CrowdChunk {
  std::uint32_t first = 0, count = 0;  ///< numbers in the crowd
  gpu::Buffer characters;              ///< GpuCharacter, mapped
  gpu::Buffer palette;                 ///< world_from_model * skinning matrix, three rows a joint
  vk::raii::BufferView palette_view = nullptr;
};

class CrowdState {
 public:
  CrowdState(gpu::Device& device, const Crowd& crowd, const Animation& animation,
             std::uint64_t max_buffer_bytes);

  const std::vector<CrowdChunk>& chunks() const { return chunks_; }
  /// Per person: its combination.
  std::span<const std::uint32_t> combinations() const { return combinations_; }
  /// Holds a person whatever the clip's time, world space.
  const std::vector<Sphere>& bounds() const { return bounds_; }
  std::uint32_t characterCount() const { return static_cast<std::uint32_t>(characters_.size()); }

  /// Brings phases to a time. The device must not be reading the characters.
  void setTime(double seconds);
  /// Records the pose pass: fills the palettes, readable by vertex shaders afterwards.
  void recordPoses(const vk::raii::CommandBuffer& commands) const;

 private:
  void makeCharacters(const Crowd& crowd, const Animation& animation);
  void makeChunks(gpu::Device& device, const Animation& animation, std::uint64_t max_buffer_bytes);
  void createPipeline(gpu::Device& device);

  std::vector<GpuCharacter> characters_;
  std::vector<std::uint32_t> combinations_;
  std::vector<Sphere> bounds_;
  struct Playing {
    float clip_seconds, phase, speed;
  };
  std::vector<Playing> playing_;
  std::vector<CrowdChunk> chunks_;

  gpu::Image texture_;
  gpu::Buffer clips_;
  vk::raii::Sampler sampler_ = nullptr;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  gpu::DescriptorSets sets_;  // per chunk
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace ensemble
