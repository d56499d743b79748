// Who is drawn in the second round of occlusion culling, and where its boxes come to lie. Pure functions.
#pragma once

#include <span>

#include "renderer/raster_people.h"

namespace ensemble {

/// Clips of a wardrobe.
struct ClipRange {
  std::uint32_t first = 0, count = 0;
};

/// @param rows of the target's pixels @param is_tested false: no boxes hold it
GpuOccludee makeOccludee(const ScreenRows& rows, const GpuCharacter& character, const ClipRange& clips,
                         bool is_tested);

/// The distance, along the view axis, from which on people are drawn in the second round. Infinite where
/// there are so few that one round is better. @param distances of all; their order changes
float secondRoundDistance(std::span<float> distances);

}  // namespace ensemble
