// Base-colour textures in a few texture arrays.
//
// lavapipe has no descriptor indexing, so there is one array for each of four sizes and a
// descriptor set for each pair of array and wrap mode; a draw binds one.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image_file.h"
#include "core/raw_asset.h"
#include "renderer/vk/descriptors.h"
#include "renderer/vk/memory.h"

namespace ensemble {

/// Where an image went.
struct StoredTexture {
  std::uint32_t size_class = 0;  ///< which array
  std::uint32_t layer = 0;
  Vec3 mean{1.0f};  ///< mean colour, linear
};

class TextureStore {
 public:
  static constexpr std::array<std::uint32_t, 4> kSides = {256, 512, 1024, 2048};
  static constexpr std::uint32_t kWrapModes = 4;

  /// Images to store; the pointers live as long as the constructor runs. @param file names their origin
  struct Source {
    const RawImage* image = nullptr;
    std::string file;
  };

  /// Decodes and uploads. @throws InputError for a damaged image, SystemError if it does not fit or there
  /// are more of a size than an array has layers.
  TextureStore(gpu::Device& device, const std::vector<Source>& sources);

  const StoredTexture& texture(std::size_t source) const { return textures_[source]; }
  const vk::raii::DescriptorSetLayout& layout() const { return layout_; }
  /// Number of the descriptor set of an array and wrap modes.
  static std::uint32_t setIndex(std::uint32_t size_class, bool repeat_u, bool repeat_v) {
    return size_class * kWrapModes + (repeat_u ? 1u : 0u) + (repeat_v ? 2u : 0u);
  }
  vk::DescriptorSet set(std::uint32_t index) const { return sets_[index]; }

 private:
  void createSets(gpu::Device& device);

  std::vector<StoredTexture> textures_;
  std::array<gpu::Image, kSides.size()> arrays_;
  std::vector<vk::raii::Sampler> samplers_;
  vk::raii::DescriptorSetLayout layout_ = nullptr;
  gpu::DescriptorSets sets_;
};

}  // namespace ensemble
