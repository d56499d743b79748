// Skinning matrices of every key of every clip of all wardrobes, on the host. No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/wardrobe.h"
#include "renderer/sphere.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// What the texture holds, before it is one. A wardrobe without clips has one: rest, a single key.
/// Each wardrobe has one joint more than its skeleton, the last, which never moves: vertices that
/// no joint moves hang on it.
struct Animation {
  std::vector<vec4> texels;    ///< 3 rows per matrix, see GpuClip
  std::vector<GpuClip> clips;  ///< of all wardrobes
  std::vector<float> seconds;  ///< per clip: length; 0 where there is one key
  std::vector<Sphere> bounds;  ///< per clip, model space: holds every vertex of every item at any time
  std::vector<std::uint32_t> first_clip;   ///< per wardrobe: its first clip
  std::vector<std::uint32_t> joint_count;  ///< per wardrobe: with the one that never moves
  std::vector<float> heights;              ///< per wardrobe: metres, of the body at rest
  std::vector<GpuLegs> legs;               ///< per wardrobe; zeros where no legs were found
  std::vector<std::uint32_t> leg_groups;   ///< of all wardrobes' joints, the unmoving ones too
};

/// Of a wardrobe's body at rest, metres.
float bodyHeight(const Wardrobe& wardrobe);

Animation buildAnimation(std::span<const Wardrobe> wardrobes);

/// The part of a clip that has run, 0 <= part < 1, for a person with `phase` at time 0 who plays it
/// `speed` times as fast. In double: after a day a float no longer tells one key from the next.
float phaseAt(double time_seconds, float clip_seconds, float phase, float speed);

}  // namespace ensemble
