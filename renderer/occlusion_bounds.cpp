#include "renderer/occlusion_bounds.h"

#include <algorithm>
#include <limits>

namespace ensemble {
namespace {

// The nearest quarter hides most of what can be hidden. Fewer leave gaps, more are drawn for nothing.
constexpr std::size_t kRoundsOf = 4;
constexpr std::size_t kLeastPeople = 64;

}  // namespace

GpuOccludee makeOccludee(const ScreenRows& rows, const GpuCharacter& character, const ClipRange& clips,
                         bool is_tested) {
  constexpr double kPixels = 1.0 / (1 << ENSEMBLE_SUBPIXEL_BITS);
  glm::dvec4 world[3];
  for (int i = 0; i < 3; ++i) world[i] = glm::dvec4(character.world_from_model[i]);
  const bool is_blended = character.idle_weight > 0.0f;
  GpuOccludee occludee{};
  occludee.screen_from_model[0] = kPixels * times(rows.x, world);
  occludee.screen_from_model[1] = kPixels * times(rows.y, world);
  occludee.screen_from_model[2] = times(rows.z, world);
  occludee.clip = character.clip - clips.first;
  occludee.idle_clip = (is_blended ? character.idle_clip : character.clip) - clips.first;
  occludee.clip_count = clips.count;
  occludee.is_tested = is_tested ? 1u : 0u;
  return occludee;
}

float secondRoundDistance(std::span<float> distances) {
  if (distances.size() < kLeastPeople) return std::numeric_limits<float>::infinity();
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / kRoundsOf);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace ensemble
