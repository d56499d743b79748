#include "renderer/key_frames.h"

#include <algorithm>

#include "shaders/shared/culling.h"
#include "shaders/shared/raster_types.h"

namespace ensemble {

KeptBox keptBoxAround(const Sphere& bounds) {
  constexpr float kSteps = (1u << ENSEMBLE_POSE_POSITION_BITS) - 1u;
  const float radius = std::max(bounds.radius, 1e-3f);
  return {bounds.center - Vec3(radius), 2.0f * radius / kSteps};
}

std::uint32_t KeyFrames::firstOfWardrobe(std::uint32_t wardrobe) const {
  const std::uint32_t clip = clip_of_wardrobe[wardrobe];
  return clip < first_of_clip.size() ? first_of_clip[clip] : static_cast<std::uint32_t>(keys.size());
}

KeyFrames numberKeyFrames(const Animation& animation) {
  KeyFrames frames;
  frames.clips = animation.clips;
  frames.clip_of_wardrobe = animation.first_clip;
  frames.clip_of_wardrobe.push_back(static_cast<std::uint32_t>(animation.clips.size()));
  for (std::uint32_t c = 0; c < animation.clips.size(); ++c) {
    const GpuClip& clip = animation.clips[c];
    frames.first_of_clip.push_back(static_cast<std::uint32_t>(frames.keys.size()));
    for (std::uint32_t key = 0; key < clip.key_count; ++key)
      frames.keys.push_back({c, clip.first_matrix + key * clip.joint_count});
    frames.boxes.push_back(keptBoxAround(animation.bounds[c]));
  }
  return frames;
}

std::uint32_t nearestKey(const KeyFrames& frames, const GpuCharacter& character) {
  const bool is_idle = character.idle_weight >= 0.5f;
  const std::uint32_t clip = is_idle ? character.idle_clip : character.clip;
  const float phase = is_idle ? character.idle_phase : character.phase;
  const std::uint32_t last = frames.clips[clip].key_count - 1;
  return frames.first_of_clip[clip] + culling::nearestKeyAt(phase, last);
}

std::optional<BetweenKeys> betweenKeys(const KeyFrames& frames, const GpuCharacter& character) {
  const bool holds_feet = character.feet[0].w > 0.0f || character.feet[1].w > 0.0f;
  if (character.idle_weight > 0.0f || holds_feet) return std::nullopt;
  const std::uint32_t last = frames.clips[character.clip].key_count - 1;
  const float at = character.phase * static_cast<float>(last);
  const std::uint32_t key = std::min(static_cast<std::uint32_t>(at), std::max(last, 1u) - 1u);
  const std::uint32_t first = frames.first_of_clip[character.clip];
  return BetweenKeys{first + key, first + std::min(key + 1, last), at - static_cast<float>(key)};
}

}  // namespace ensemble
