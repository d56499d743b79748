// The key frames of all clips under one numbering, and the boxes in which vertices are kept at them. No
// Vulkan.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/animation.h"
#include "renderer/sphere.h"

namespace ensemble {

/// Poses hold positions as whole numbers in a cube.
struct KeptBox {
  Vec3 low{0.0f};
  float step = 1.0f;  ///< metres
};
KeptBox keptBoxAround(const Sphere& bounds);

/// A key frame of a clip.
struct KeyFrame {
  std::uint32_t clip = 0;          ///< of all wardrobes'
  std::uint32_t first_matrix = 0;  ///< in the animation texture
};

struct KeyFrames {
  std::vector<KeyFrame> keys;                   ///< those of a clip side by side
  std::vector<std::uint32_t> first_of_clip;     ///< per clip
  std::vector<GpuClip> clips;                   ///< likewise
  std::vector<KeptBox> boxes;                   ///< likewise
  std::vector<std::uint32_t> clip_of_wardrobe;  ///< per wardrobe its first clip, and one more at the end

  /// First key of a wardrobe; of the number of wardrobes: the number of all keys.
  std::uint32_t firstOfWardrobe(std::uint32_t wardrobe) const;
};

KeyFrames numberKeyFrames(const Animation& animation);

/// The key in which somebody is nearest to what is played: of the clip that weighs more.
std::uint32_t nearestKey(const KeyFrames& frames, const GpuCharacter& character);

/// Two keys of a clip, and how far somebody is from the one to the other.
struct BetweenKeys {
  std::uint32_t before = 0, after = 0;
  float part = 0.0f;  ///< 0 .. 1
};

/// The keys that somebody is between, where mixing the meshes at these two is all there is to its pose: one
/// clip plays, and no foot is held. As pose.comp mixes matrices; skinned vertices are linear in them.
std::optional<BetweenKeys> betweenKeys(const KeyFrames& frames, const GpuCharacter& character);

}  // namespace ensemble
